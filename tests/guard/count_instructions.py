"""Compares counted instructions with the recorded figures.

usage: count_instructions.py [--only WORK | --update] PROGRAM COMPILER

Runs PROGRAM (guarded_work) under callgrind. A count that differs by more than
5 % from instructions.csv fails: whoever changes it says so by recording it in
the same commit, with `cmake --build --preset release --target
update_instruction_counts`. Exits with 77 (skipped) where valgrind is missing or
no figure is recorded for COMPILER, as another compiler counts otherwise.
"""

import argparse
import csv
import pathlib
import re
import shutil
import subprocess
import sys

RECORD = pathlib.Path(__file__).with_name("instructions.csv")
WORKS = ["buckets", "sweep", "lattice", "verify"]
TOLERANCE = 0.05
SKIPPED = 77


def count(program, work):
    run = subprocess.run(
        ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
         "--toggle-collect=TerraGuardedWork", program, work],
        capture_output=True, text=True, check=False)
    collected = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or not collected or int(collected[1]) == 0:
        sys.exit(f"{work}: nothing counted\n{run.stdout}{run.stderr}")
    return int(collected[1])


def read_record():
    with RECORD.open(newline="") as file:
        return {(row["compiler"], row["work"]): int(row["instructions"])
                for row in csv.DictReader(file)}


def update(program, compiler):
    record = read_record() if RECORD.exists() else {}
    record |= {(compiler, work): count(program, work) for work in WORKS}
    with RECORD.open("w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["compiler", "work", "instructions"])
        out.writerows([*key, number] for key, number in sorted(record.items()))


def check(program, compiler, work):
    """Returns whether the count is near the recorded one."""
    recorded = read_record()[compiler, work]
    counted = count(program, work)
    change = counted / recorded - 1
    print(f"{work}: {counted:,} instructions, {change:+.2%} of the recorded "
          f"{recorded:,}")
    if abs(change) <= TOLERANCE:
        return True
    print(f"This is more than {TOLERANCE:.0%}. If it is meant, record it in the "
          "same commit and say why:\n"
          "  cmake --build --preset release --target update_instruction_counts")
    return False


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", choices=WORKS)
    parser.add_argument("--update", action="store_true")
    parser.add_argument("program")
    parser.add_argument("compiler")
    arguments = parser.parse_args()
    if not shutil.which("valgrind"):
        print("skipped: valgrind is not installed")
        return SKIPPED
    if arguments.update:
        update(arguments.program, arguments.compiler)
        return 0
    compilers = {compiler for compiler, _ in read_record()}
    if arguments.compiler not in compilers:
        print(f"skipped: recorded for {', '.join(sorted(compilers))}, not for "
              f"{arguments.compiler}")
        return SKIPPED
    works = [arguments.only] if arguments.only else WORKS
    good = [check(arguments.program, arguments.compiler, w) for w in works]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
