#!/usr/bin/env python3
"""Runs the fault suite and prints its table. See scripts/faults --help."""
import argparse
import importlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
PATHS = [str(HERE), str(HERE.parent / "soak")]
sys.path[:0] = PATHS
os.environ["PYTHONPATH"] = ":".join(PATHS)
os.environ["PYTHONDONTWRITEBYTECODE"] = "1"

import fleet  # noqa: E402 (both need the path above)
import rows  # noqa: E402

MODULES = ["advisor_rows", "share_rows", "process_rows", "network_rows", "map_rows", "disk_rows",
           "recorder_rows", "machine_rows"]
SANDBOX = ["unshare", "--net", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc",
           "sh", "-c", "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo"
           # (libfaketime leaves its shared memory behind)
           ' && mount -t tmpfs tmpfs /dev/shm && exec "$@"', "row"]
RESULTS = HERE.parents[1] / "docs" / "results"
PAGES = {
    "rows": ("faults.md", "The fault suite: every row", "scripts/faults --write-docs",
             "[../faults.md](../faults.md) says how a row is run and judged."),
    "mutants": ("fault-mutants.md", "The fault suite: every row can fail",
                "scripts/faults --mutants --write-docs",
                "Each row ran with something broken that it must notice, and with a stand-in "
                "that lacks nothing (`none`), which must pass."),
}
ROW_TIMEOUT_S = 180
SKIPPED = 77  # as CTest is told


def run_row(one, arguments, flaw=""):
    """In a sandbox. A dict: injected, observed, worst_ms, failures, ..."""
    with tempfile.TemporaryDirectory(prefix="terra-faults-") as folder:
        out = pathlib.Path(folder) / "row.json"
        command = [*SANDBOX, sys.executable, str(HERE / "act.py"), "--row", one.name, "--bin",
                   str(arguments.bin), "--folder", folder, "--seed", str(arguments.seed),
                   "--flaw", flaw]
        begin = time.monotonic()
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False,
                                  timeout=ROW_TIMEOUT_S, preexec_fn=fleet.die_with_parent)
            words = done.stderr[-2000:]
        except subprocess.TimeoutExpired:
            words = f"not done after {ROW_TIMEOUT_S} s"
        result = json.loads(out.read_text()) if out.exists() else {"failures": [words]}
        return result | {"seconds": round(time.monotonic() - begin, 1)}


def sandbox_is_allowed():
    return subprocess.run([*SANDBOX, "true"], capture_output=True, check=False).returncode == 0


def cells(one, result):
    """One line of the table."""
    worst = result.get("worst_ms")
    return [one.name, one.covers, str(result.get("injected", "-")),
            result.get("observed", "-") if not result["failures"] else result["failures"][0],
            f"{worst:.1f}" if worst is not None else "-",
            str(result.get("counts", {}).get("judged", 0)),
            "pass" if not result["failures"] else "FAIL"]


HEAD = ["fault", "of", "injected", "observed", "worst, ms", "checked", ""]


def markdown(head, lines):
    rows_of = [head, ["---"] * len(head)] + [[" ".join(cell.replace("|", "/").split())
                                              for cell in line] for line in lines]
    return "".join("| " + " | ".join(line) + " |\n" for line in rows_of)


def machine():
    """When and on what the figures were made."""
    names = [line.partition(": ")[2] for line in pathlib.Path("/proc/cpuinfo").read_text().split("\n")
             if line.startswith("model name")]
    return (f"{time.strftime('%Y-%m-%d')}, build `release`, {os.cpu_count()} cores "
            f"({names[0] if names else 'unknown'}), {os.uname().sysname}.")


def show_table(name, head, lines, arguments):
    """Prints it, or writes its page of docs/results."""
    table = markdown(head, lines)
    if not arguments.write_docs:
        print(table, end="")
        return
    file, title, command, text = PAGES[name]
    (RESULTS / file).write_text(
        f"# {title}\n\nWritten by `{command}`. {text}\n\n{machine()}\n\n{table}")


def run_all(chosen, arguments):
    lines, failed = [], []
    for one in chosen:
        result = run_row(one, arguments)
        lines.append(cells(one, result))
        if not arguments.markdown:
            print(f"{lines[-1][-1]}  {one.name}: {lines[-1][2]} injected, {lines[-1][3]}; worst "
                  f"{lines[-1][4]} ms; {lines[-1][5]} deployments checked; "
                  f"{result['seconds']} s", flush=True)
            for failure in result["failures"][1:]:
                print("      ", failure, flush=True)
        if arguments.tell:
            print(result.get("counts"), result.get("overflown"))
            print("\n".join(result.get("slow", [])))
        if result["failures"]:
            failed.append(one.name)
    if arguments.markdown or arguments.write_docs:
        show_table("rows", HEAD, lines, arguments)
    print(f"{len(chosen) - len(failed)} of {len(chosen)} rows pass"
          + "".join(f"\nfailed: {name}" for name in failed), file=sys.stderr)
    return 1 if failed else 0


def run_mutants(chosen, arguments):
    """Each row with each of its flaws, and each stand-in without a flaw."""
    wrong, lines = 0, []
    for one in chosen:
        controls = sorted({flaw.partition(":")[0] + ":none" for flaw in one.flaws
                           if ":" in flaw and not arguments.flaw})
        for flaw in [*controls, *one.flaws]:
            failures = run_row(one, arguments, flaw)["failures"]
            as_meant = (bool(failures) == (flaw not in controls)
                        and not "".join(failures).startswith("Traceback"))
            wrong += not as_meant
            said = re.split(r"; \w+ ended with",
                            " ".join((failures or ["passes"])[0].split()))[0]
            said = said.replace(f"{HERE}/", "")  # no paths of this machine
            lines.append([one.name, flaw, said[:120] + ("" if as_meant else
                                                        "  <-- NOT AS MEANT")])
            print("  ".join(lines[-1]), file=sys.stderr, flush=True)
    if arguments.markdown or arguments.write_docs:
        show_table("mutants", ["row", "broken", "noticed by"], lines, arguments)
    print(f"{wrong} not as meant", file=sys.stderr)
    return 1 if wrong else 0


def parse():
    parser = argparse.ArgumentParser(prog="scripts/faults")
    parser.add_argument("--bin", required=True, type=pathlib.Path)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--row", action="append", default=[])
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--markdown", action="store_true")
    parser.add_argument("--write-docs", action="store_true")
    parser.add_argument("--mutants", action="store_true")
    parser.add_argument("--flaw", default="")
    parser.add_argument("--tell", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def main():
    arguments = parse()
    for module in MODULES:
        importlib.import_module(module)
    chosen = [one for one in rows.ROWS if (one.short or not arguments.short)
              and (not arguments.row or any(part in one.name for part in arguments.row))]
    if arguments.list:
        for one in rows.ROWS:
            print(f"{one.name}  [{one.covers}]" + ("  (short)" if one.short else ""))
        return 0
    if not chosen:
        sys.exit("scripts/faults: no such row; --list names them")
    if not sandbox_is_allowed():
        print("skipped: needs root, to make network, mount and process namespaces")
        return SKIPPED
    if arguments.flaw:
        chosen = [one._replace(flaws=[arguments.flaw]) for one in chosen]
        arguments.mutants = True
    return (run_mutants if arguments.mutants else run_all)(chosen, arguments)


if __name__ == "__main__":
    sys.exit(main())
