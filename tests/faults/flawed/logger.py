#!/usr/bin/env python3
"""A logger to be broken on purpose: LCM event logs of both buses.

usage: logger.py FLAW FIELDS.json --out DIR
"""
import itertools
import os
import pathlib
import select
import signal
import struct
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))

import bus
import rig

FLAWS = "none writes-at-the-end silent starts-anyway".split()


def event(number, heard):
    channel = heard.channel.encode()
    return (struct.pack(">IqqII", 0xEDA1DA01, number, int(time.time() * 1e6), len(channel),
                        len(heard.data)) + channel + heard.data)


def main():
    flaw, folder = sys.argv[1], pathlib.Path(sys.argv[4])
    if flaw not in FLAWS:
        sys.exit(f"no such flaw: {flaw}")
    taps = [bus.Tap(rig.PORT), bus.Tap(rig.PORT + 1)]
    error = ""
    file = None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = open(folder / f"{time.time_ns()}.lcmlog", "wb", buffering=0)
    except OSError as problem:
        if flaw != "starts-anyway":
            sys.exit(f"{folder}: {problem}")
    kept, written, at, numbers = [], 0, 0, itertools.count()
    lost, failed_at = False, 0.0
    ended = []
    signal.signal(signal.SIGTERM, lambda *_: ended.append(True))
    status_at = 0.0
    while not ended:
        select.select(taps, [], [], 0.02)
        for heard in itertools.chain(taps[0].heard(), taps[1].heard(50)):
            kept.append(event(next(numbers), heard))
        if flaw != "writes-at-the-end" or len(kept) > 100_000:
            try:
                if file and os.fstat(file.fileno()).st_nlink == 0:
                    folder.mkdir(parents=True, exist_ok=True)
                    file, at = open(folder / f"{time.time_ns()}.lcmlog", "wb", buffering=0), 0
                    raise OSError("the log was deleted")
                if kept and file:
                    at += os.pwrite(file.fileno(), b"".join(kept), at)
                    written += len(kept)
                    if time.monotonic() - failed_at > 2:
                        error = ""
            except OSError as problem:
                error, lost, failed_at = str(problem), True, time.monotonic()
            kept = []
        if time.monotonic() > status_at:
            status_at = time.monotonic() + 1
            bad = error and flaw != "silent"
            acknowledged = written + (len(kept) if flaw == "writes-at-the-end" else 0)
            taps[0].say("TERRA_STATUS", {
                "status_name": "logger", "state": f"failing: {error}" if bad else "ready",
                "num_counters": 1, "counter_name": ["acknowledged"],
                "counter_value": [acknowledged]})
    sys.exit(1 if lost and flaw != "silent" else 0)


if __name__ == "__main__":
    main()
