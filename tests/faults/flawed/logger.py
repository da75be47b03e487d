#!/usr/bin/env python3
"""A logger to be broken on purpose: LCM event logs of both buses.

usage: logger.py FLAW FIELDS.json --out DIR
"""
import concurrent.futures
import itertools
import os
import pathlib
import select
import signal
import socket
import struct
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))

import bus
import process_rows
import rig

FLAWS = ("none writes-at-the-end silent starts-anyway waits-for-disk never-syncs "
         "forgets-losses waits-for-stderr drops-uncounted").split()
SLOW_S = 1.0


def event(number, heard):
    channel = heard.channel.encode()
    return (struct.pack(">IqqII", 0xEDA1DA01, number, int(time.time() * 1e6), len(channel),
                        len(heard.data)) + channel + heard.data)


class File:
    """Where events go, one batch after the other."""

    def __init__(self, folder, flaw):
        self.folder, self.flaw = folder, flaw
        self.written, self.failed_at, self.error, self.failed = 0, 0.0, "", False
        self._begin()

    def _begin(self):
        self.file = None
        self.folder.mkdir(parents=True, exist_ok=True)
        self.path, self.at = self.folder / f"{time.time_ns()}.lcmlog", 0
        self.file = open(self.path, "wb", buffering=0)
        folder = os.open(self.folder, os.O_RDONLY)
        os.fsync(folder)
        os.close(folder)

    def _check(self):
        there = os.fstat(self.file.fileno())
        if (there.st_nlink == 0 or there.st_size < self.at or not self.path.exists()
                or not os.path.samestat(there, self.path.stat())):
            self._begin()
            raise OSError("the log was taken away")

    def write(self, batch):
        try:
            self._check()
            if batch:
                self.at += os.pwrite(self.file.fileno(), b"".join(batch), self.at)
                if self.flaw != "never-syncs":
                    os.fdatasync(self.file.fileno())
                self.written += len(batch)
                if time.monotonic() - self.failed_at > 2:
                    self.error = ""
        except OSError as problem:
            self.error, self.failed, self.failed_at = str(problem), True, time.monotonic()


class LastPose:
    """What is missing since the recording before."""

    def __init__(self, folder):
        self.lost = self._seq = 0
        self._session = None
        for log in folder.glob("*.lcmlog"):
            for channel, data in process_rows.events_of(log):
                if channel == "TERRA_POSE":
                    pose = bus.decode(bus.Heard(0, channel, data))
                    self._seq, self._session = max(self._seq, pose["seq"]), pose["session"]

    def hear(self, heard):
        if heard.channel != "TERRA_POSE" or self._session is None:
            return
        pose = bus.decode(heard)
        if pose["session"] == self._session:
            self.lost += pose["seq"] - self._seq - 1
        self._session = None


def watchdog():
    """Tells the service manager that the loop runs."""
    if "NOTIFY_SOCKET" in os.environ:
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
            manager.sendto(b"WATCHDOG=1", os.environ["NOTIFY_SOCKET"])


def main():
    flaw, folder = sys.argv[1], pathlib.Path(sys.argv[4])
    if flaw not in FLAWS:
        sys.exit(f"no such flaw: {flaw}")
    taps = [bus.Tap(rig.PORT), bus.Tap(rig.PORT + 1)]
    before = LastPose(folder)
    file = None
    try:
        file = File(folder, flaw)
    except OSError as problem:
        if flaw != "starts-anyway":
            sys.exit(f"{folder}: {problem}")
    kept, numbers = [], itertools.count()
    ended = []
    signal.signal(signal.SIGTERM, lambda *_: ended.append(True))
    disk = concurrent.futures.ThreadPoolExecutor(1)
    turn, turn_begun = None, 0.0
    status_at = 0.0
    while not ended:
        select.select(taps, [], [], 0.02)
        for heard in itertools.chain(taps[0].heard(), taps[1].heard(50)):
            before.hear(heard)
            if flaw != "drops-uncounted" or len(kept) < 100:
                kept.append(event(next(numbers), heard))
        if file and (flaw != "writes-at-the-end" or len(kept) > 100_000):
            if flaw == "waits-for-disk":
                file.write(kept)
                kept = []
            elif turn is None or turn.done():
                turn, turn_begun = disk.submit(file.write, kept), time.monotonic()
                kept = []
        if time.monotonic() > status_at:
            status_at = time.monotonic() + 1
            error = file.error if file else ""
            if turn and not turn.done() and time.monotonic() - turn_begun > SLOW_S:
                error = "the disk takes nothing"
            bad = error and flaw != "silent"
            acknowledged = file.written if file else 0
            if flaw == "writes-at-the-end":
                acknowledged += len(kept)
            watchdog()
            if flaw == "waits-for-stderr":
                os.write(2, b"a heartbeat\n")
            taps[0].say("TERRA_STATUS", {
                "status_name": "logger", "state": f"failing: {error}" if bad else "ready",
                "num_counters": 2, "counter_name": ["acknowledged", "lost"],
                "counter_value": [acknowledged,
                                  0 if flaw == "forgets-losses" else before.lost]})
    disk.shutdown()
    if file:
        file.write(kept)
    sys.exit(1 if file and file.failed and flaw != "silent" else 0)


if __name__ == "__main__":
    main()
