#!/usr/bin/env python3
"""One row, inside its sandbox: acts, lets the observer judge, writes row.json."""
import argparse
import importlib
import json
import pathlib
import signal
import traceback

import faults
import rig as rigs
import rows


def act(one, rig):
    result = {"failures": []}
    try:
        result["observed"] = one.act(rig)
    except rigs.Failed as failed:
        result["failures"].append(str(failed))
    except Exception:  # of the suite's own: shown, never a pass
        result["failures"].append(traceback.format_exc())
    saw = rig.finish()
    result["failures"] += saw["violations"]
    result["failures"] += [f"invariant 1: a baseline waited {latency:.3f} s for its route"
                           for latency in saw["latencies_s"] if latency > one.limit_s]
    for what in ("advice", "verdicts", "baselines"):
        unheard = saw["counts"].get(what + "_not_heard", 0)
        if unheard and not one.lossy:
            result["failures"].append(f"invariant 5: {unheard} deployments whose {what} nobody "
                                      "heard")
    if not result["failures"] and not saw["counts"].get("judged"):
        result["failures"].append("the observer saw no route: the row shows nothing")
    result["injected"] = rig.injected
    if saw["latencies_s"]:
        result["worst_ms"] = 1000 * max(saw["latencies_s"])
    return result | {name: saw[name] for name in
                     ("counts", "requests", "overflown", "slow")}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--row", required=True)
    parser.add_argument("--bin", required=True, type=pathlib.Path)
    parser.add_argument("--folder", required=True, type=pathlib.Path)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--flaw", default="")
    arguments = parser.parse_args()
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # (nohup passes it on as ignored)
    for module in faults.MODULES:
        importlib.import_module(module)
    one = next(one for one in rows.ROWS if one.name == arguments.row)
    rig = rigs.Rig(arguments.folder, arguments.bin.resolve(), arguments.seed, arguments.flaw)
    result = act(one, rig)
    (arguments.folder / "row.json").write_text(json.dumps(result))


if __name__ == "__main__":
    main()
