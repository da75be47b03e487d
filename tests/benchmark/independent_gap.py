#!/usr/bin/env python3
"""Compares terra bench gap, run and table with a second implementation.

independent_planner.py reads the datasets' files, rasterises, plans on the
lattice and searches all cells; this file works out gap rate, mean gap, MOGR and
the other figures, and compares them all. Exits 1 at the first difference.

usage: independent_gap.py TERRA [--count N] [--small N] [--seed S]
"""

import argparse
import ast
import collections
import csv
import io
import math
import pathlib
import random
import subprocess
import tempfile

from independent_planner import (INF, lattice_cost, optimum, read_cases, read_csv,
                                 write_png)

EPSILON = 1e-6


# ---- the figures


def mean(values):
    return sum(values) / len(values) if values else math.nan


def gap_row(costs):
    """[comparable, gaps, gap rate, mean gap] of (baseline, optimum) pairs."""
    comparable = [(b, o) for b, o in costs if b < INF and o < INF]
    gaps = [(b - o) / b for b, o in comparable if o < b - EPSILON]
    return [len(comparable), len(gaps), mean([b - o > EPSILON for b, o in comparable]),
            mean(gaps)]


def final_row(finals):
    """A row's figures from (baseline, optimum, final cost) of its cases."""
    lower = [(b - c) / b for b, _, c in finals if c < b - EPSILON]
    _, _, gap_rate, mean_gap = gap_row([(b, o) for b, o, c in finals if c < INF])
    return {"FIR %": len(lower) / len(finals),
            "NDR %": mean([c <= b + EPSILON for b, _, c in finals]),
            "Final validity %": mean([c < INF for _, _, c in finals]),
            "ACR_lower %": mean(lower),
            "Gap rate %": gap_rate,
            "Mean gap %": mean_gap,
            "MOGR %": mean([(b - c) / (b - o) for b, o, c in finals
                            if c < INF and o < b - EPSILON])}


# ---- terra's answers


class Checker:
    def __init__(self, terra, folder):
        self.terra, self.folder, self.compared = terra, folder, 0

    def bench(self, *arguments):
        done = subprocess.run([self.terra, "bench", *map(str, arguments)], text=True,
                              stdout=subprocess.PIPE, timeout=120, check=True)
        return done.stdout

    def expect(self, what, ours, theirs, tolerance=1e-9):
        self.compared += 1
        if ours != theirs and not (math.isnan(ours) and math.isnan(theirs)) and not math.isclose(
                ours, theirs, rel_tol=1e-9, abs_tol=tolerance):
            raise SystemExit("%s: this file says %r, terra says %r" % (what, ours, theirs))

    def check_gap(self, data, strides, joints="2r", corner_cutting=True, clearance=0):
        """Every cost of terra bench gap and the table that it prints. Returns the optima."""
        out = self.folder / "gap.csv"
        printed = self.bench(
            "gap", "--dataset", data, "--strides", ",".join(map(str, strides)), "--out", out,
            "--joints", joints, "--corner-cutting", "on" if corner_cutting else "off",
            "--clearance", clearance)
        cases = read_cases(data, corner_cutting, clearance)
        theirs = {(row["case_id"], int(row["stride"])): row for row in read_csv(out)}
        if set(theirs) != {(name, stride) for name in cases for stride in strides}:
            raise SystemExit("terra bench gap answered other cases than it was asked")
        rows, optima = collections.defaultdict(list), {}
        for name, case in cases.items():
            best = optima[name] = optimum(case.map, case.start, case.goal)
            for stride in strides:
                what = "%s, %s, stride %d, joints %s" % (data.name, name, stride, joints)
                cost = lattice_cost(case.map, case.start, case.goal, stride, joints)
                self.expect(what, cost, float(theirs[name, stride]["baseline_cost"]))
                self.expect(what + ", optimum", best, float(theirs[name, stride]["oracle_cost"]))
                rows[case.group, stride].append((cost, best))
        self.check_printed(printed, rows)
        return optima

    def check_printed(self, printed, rows):
        lines = [line.split() for line in printed.splitlines()[1:]]
        if {(line[0], int(line[1])) for line in lines} != set(rows):
            raise SystemExit("terra bench gap prints other rows: " + printed)
        for group, stride, paths, *figures in lines:
            costs = rows[group, int(stride)]
            self.expect("cases of " + group, len(costs), int(paths))
            ours = gap_row(costs)
            for what, factor, a, b in zip(("comparable", "gaps", "mean gap"), (1, 100, 100),
                                          (ours[0], ours[2], ours[3]), map(float, figures)):
                # Where there is no gap the printed table has zeros.
                self.expect("%s of %s, stride %s" % (what, group, stride),
                            0 if math.isnan(a) else factor * a, b, 0.00501)

    def check_run(self, data, optima, *method):
        """What a method's routes really cost, and its row in two tables."""
        group = data.name
        out = self.folder / "-".join(("run", group, *method)).replace("--", "")
        self.bench("run", "--dataset", data, "--method", *method, "--out", out)
        cases, finals = read_cases(data), []
        for row in read_csv(out / "results.csv"):
            m, start, goal = cases[row["case_id"]][1:]
            cost = m.route_cost(read_route(row["final_route"]), start, goal)
            self.expect("final route of %s by %s" % (row["case_id"], method), cost,
                        float(row["final_cost"]))
            finals.append((lattice_cost(m, start, goal, 50, "2r"), optima[row["case_id"]], cost))
        self.expect("cases of the run", len(cases), len(finals))
        row = {}
        for table in ("comparison-", "proposals-"):
            text = self.bench("table", table + group, "--runs", out, "--format", "csv")
            row.update(next(csv.DictReader(io.StringIO(text))))
        for what, value in final_row(finals).items():
            if what == "MOGR %" and method[0] != "advisor":
                value = math.nan  # Without fallback there is none.
            self.expect("%s of %s" % (what, method), 100 * value,
                        math.nan if row[what] == "-" else float(row[what]), 0.00501)


def read_route(text):
    return ast.literal_eval(text) if text else []


# ---- small maps with everything that large ones rarely have


def small_rows(rng):
    width, height = rng.randint(1, 60), rng.randint(1, 45)
    if rng.random() < 0.2:
        return [[rng.randrange(12) for _ in range(width)] for _ in range(height)]
    rows = [[rng.randrange(3)] * width for _ in range(height)]
    for _ in range(rng.randint(1, 12)):
        terrain = rng.choice([11, rng.randrange(11)])
        x, y = rng.randrange(width), rng.randrange(height)
        right, low = x + rng.randint(1, 15), y + rng.randint(1, 15)
        for row in rows[y:low]:
            row[x:right] = [terrain] * (min(right, width) - x)
    return rows


def write_small(folder, rng, count):
    """A dataset of the default legend; ends may be blocked or the same."""
    (folder / "maps").mkdir(parents=True)
    with open(folder / "cases.csv", "w", newline="", encoding="utf-8") as f:
        out = csv.writer(f)
        out.writerow("case_id map start_x start_y goal_x goal_y group".split())
        for i in range(count):
            rows = small_rows(rng)
            write_png(folder / "maps" / ("%d.png" % i), rows)
            ends = [z for _ in "ab" for z in (rng.randrange(len(rows[0])),
                                              rng.randrange(len(rows)))]
            out.writerow([i, "maps/%d.png" % i, *ends, "odd" if i % 2 else "even"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("terra")
    parser.add_argument("--count", type=int, default=2, help="maps of each subset")
    parser.add_argument("--small", type=int, default=40, help="small random maps")
    parser.add_argument("--seed", type=int, default=5)
    arguments = parser.parse_args()
    rng = random.Random(arguments.seed)
    with tempfile.TemporaryDirectory(prefix="terra-gap-") as name:
        folder = pathlib.Path(name)
        checker = Checker(arguments.terra, folder)
        small = folder / "small"
        write_small(small, rng, arguments.small)
        for joints, corner_cutting, clearance in (("2r", True, 0), ("cell", True, 0),
                                                  ("visible", False, 0), ("2r", True, 2)):
            checker.check_gap(small, [1, 3, 7, 20], joints, corner_cutting, clearance)
        for subset in ("easy", "hard"):
            data = folder / subset
            checker.bench("generate", "--subset", subset, "--count", arguments.count,
                          "--seed", rng.randint(1000, 10**6), "--out", data)
            optima = checker.check_gap(data, [10, 20, 50, 100])
            checker.check_run(data, optima, "advisor", "--backend", "shortcut")
            checker.check_run(data, optima, "straight-line")
        print("%d comparisons, no difference" % checker.compared)


if __name__ == "__main__":
    main()
