#!/usr/bin/env python3
"""Compares terra plan, oracle and verify with a second implementation.

The second implementation is this file: plain Python, written from the cost
rule alone, with nothing shared with the C++ sources. Exits 1 at the first
difference, with the map kept for a look.

usage: independent_check.py TERRA [--maps N] [--seed S]
"""

import argparse
import csv
import heapq
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import zlib

COSTS = [1, 1.5, 2, 2.5, 3, 4, 5, 6, 7.5, 9, 12, math.inf]
COLORS = ["#%02x%02x%02x" % (20 * i, 255 - 20 * i, (70 * i) % 256) for i in range(12)]
SQRT2 = math.sqrt(2)


def write_png(path, rows):
    """Writes rows of ids as an 8-bit grey PNG."""

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    pixels = b"".join(b"\0" + bytes(row) for row in rows)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b""))


def segment(a, b):
    """Cells from a to b, both included, in travel direction."""
    (x, y), (x1, y1) = a, b
    dx, dy = abs(x1 - x), -abs(y1 - y)
    sx, sy = (1 if x < x1 else -1), (1 if y < y1 else -1)
    e = dx + dy
    cells = [(x, y)]
    while (x, y) != (x1, y1):
        e2 = 2 * e
        if e2 >= dy:
            e += dy
            x += sx
        if e2 <= dx:
            e += dx
            y += sy
        cells.append((x, y))
    return cells


class Map:
    def __init__(self, rows, corner_cutting, clearance):
        self.rows = rows
        self.height, self.width = len(rows), len(rows[0])
        self.corner_cutting = corner_cutting
        self.cost = [[COSTS[i] for i in row] for row in rows]
        if clearance:
            walls = [(x, y) for y, row in enumerate(rows) for x, i in enumerate(row)
                     if COSTS[i] == math.inf]
            for x, y in walls:
                for yy in range(max(0, y - clearance), min(self.height, y + clearance + 1)):
                    for xx in range(max(0, x - clearance), min(self.width, x + clearance + 1)):
                        if (xx - x) ** 2 + (yy - y) ** 2 <= clearance ** 2:
                            self.cost[yy][xx] = math.inf

    def at(self, cell):
        x, y = cell
        if 0 <= x < self.width and 0 <= y < self.height:
            return self.cost[y][x]
        return math.inf

    def step(self, a, b):
        """Cost of the step from a to its neighbour b."""
        if self.at(b) == math.inf:
            return math.inf
        if a[0] == b[0] or a[1] == b[1]:
            return self.at(b)
        if not self.corner_cutting and math.inf in (self.at((a[0], b[1])), self.at((b[0], a[1]))):
            return math.inf
        return SQRT2 * self.at(b)

    def route(self, points):
        """Cost of a route; inf where it is not feasible."""
        if len(points) < 2 or self.at(points[0]) == math.inf:
            return math.inf
        total, here = 0.0, points[0]
        for a, b in zip(points, points[1:]):
            for cell in segment(a, b):
                if cell != here:
                    total += self.step(here, cell)
                    here = cell
        return total


def dijkstra(start, goal, neighbours):
    best, queue = {start: 0.0}, [(0.0, start)]
    while queue:
        cost, node = heapq.heappop(queue)
        if cost > best[node]:
            continue
        if node == goal:
            return cost
        for other, step in neighbours(node):
            if cost + step < best.get(other, math.inf):
                best[other] = cost + step
                heapq.heappush(queue, (cost + step, other))
    return math.inf


def oracle(m, start, goal):
    def neighbours(cell):
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                other = (cell[0] + dx, cell[1] + dy)
                if other != cell and m.step(cell, other) < math.inf:
                    yield other, m.step(cell, other)

    return dijkstra(start, goal, neighbours)


def lattice(m, start, goal, stride):
    nodes = [(x, y) for x in range(0, m.width, stride) for y in range(0, m.height, stride)]

    def near(a, b):
        return max(abs(a[0] - b[0]), abs(a[1] - b[1]))

    # The start and the goal are nodes of their own, even on a lattice node.
    def neighbours(node):
        kind, cell = node
        if kind == "goal":
            return
        for other in nodes:
            joint = near(cell, other) <= 2 * stride
            edge = near(cell, other) == stride and {abs(cell[0] - other[0]),
                                                    abs(cell[1] - other[1])} <= {0, stride}
            if (kind == "start" and joint) or (kind == "lattice" and edge):
                yield ("lattice", other), m.route([cell, other])
        if near(cell, goal) <= 2 * stride:
            yield ("goal", goal), m.route([cell, goal])

    return dijkstra(("start", start), ("goal", goal), neighbours)


def random_rows(rng):
    width, height = rng.randint(1, 48), rng.randint(1, 40)
    kind = rng.randrange(3)
    if kind == 0:  # single-cell noise
        return [[rng.randrange(12) for _ in range(width)] for _ in range(height)]
    rows = [[rng.randrange(3)] * width for _ in range(height)]
    for _ in range(rng.randint(1, 14)):  # rectangles, some of them walls
        terrain = rng.choice([11, rng.randrange(11)])
        x, y = rng.randrange(width), rng.randrange(height)
        for yy in range(y, min(height, y + rng.randint(1, 14))):
            for xx in range(x, min(width, x + rng.randint(1, 14))):
                rows[yy][xx] = terrain
    if kind == 2:
        for row in rows:
            for x in range(width):
                if rng.random() < 0.15:
                    row[x] = 11
    return rows


def random_route(rng, m, start, goal):
    points = [start]
    for _ in range(rng.randint(0, 4)):
        points.append((rng.randint(-1, m.width), rng.randint(-1, m.height)))
    points.append(goal)
    if rng.random() < 0.1:
        points.pop(rng.randrange(len(points)))
    return points


def text(points):
    return "[" + ", ".join("(%d, %d)" % p for p in points) + "]"


def same(a, b):
    return a == b or math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-9)


class Checker:
    def __init__(self, terra, folder):
        self.terra, self.folder = terra, folder
        self.legend = folder / "legend.csv"
        with open(self.legend, "w", encoding="utf-8") as f:
            f.write("id,name,cost,color\n")
            for i, cost in enumerate(COSTS):
                f.write("%d,terrain %d,%s,%s\n" % (i, i, cost, COLORS[i]))
        self.map_path = folder / "map.png"

    def run(self, command, *options):
        done = subprocess.run([self.terra, command, *map(str, options)],
                              capture_output=True, text=True, timeout=60, check=False)
        if done.returncode not in (0, 1) or not done.stdout:
            raise SystemExit("terra %s ended with %d: %s" % (command, done.returncode, done.stderr))
        return json.loads(done.stdout)

    def expect(self, what, ours, theirs):
        theirs = math.inf if theirs is None else theirs
        if not same(ours, theirs):
            raise SystemExit("%s: this file says %r, terra says %r; map %s"
                             % (what, ours, theirs, self.map_path))

    def check_map(self, rng):
        """Returns the number of comparisons, 0 when a map has no free cell."""
        corner_cutting, clearance = rng.random() < 0.7, rng.choice([0, 0, 0, 1, 2])
        m = Map(random_rows(rng), corner_cutting, clearance)
        free = [(x, y) for y in range(m.height) for x in range(m.width) if m.cost[y][x] < math.inf]
        if not free:
            return 0
        write_png(self.map_path, m.rows)
        start, goal = rng.choice(free), rng.choice(free)
        problem = ["--map", self.map_path, "--legend", self.legend,
                   "--corner-cutting", "on" if corner_cutting else "off",
                   "--clearance", clearance, "--json",
                   "--start", "%d,%d" % start, "--goal", "%d,%d" % goal]
        found = self.run("oracle", *problem)
        self.expect("oracle", oracle(m, start, goal), found["cost"])
        if found["waypoints"]:
            self.expect("oracle's route", m.route([tuple(p) for p in found["waypoints"]]),
                        found["cost"])
        stride = rng.randint(1, 20)
        planned = self.run("plan", *problem, "--stride", stride)
        self.expect("plan, stride %d" % stride, lattice(m, start, goal, stride), planned["cost"])
        baseline = [tuple(p) for p in planned["waypoints"]] or [start, goal]
        self.expect("plan's route", m.route(baseline),
                    planned["cost"] if planned["waypoints"] else m.route(baseline))
        for _ in range(3):
            self.check_verdict(m, problem, baseline, random_route(rng, m, start, goal), start, goal)
        return 7

    def check_verdict(self, m, problem, baseline, candidate, start, goal):
        verdict = self.run("verify", *problem, "--baseline", text(baseline),
                           "--candidate", text(candidate))
        ends = (len(candidate) >= 2 and candidate[0] == start and candidate[-1] == goal)
        cost = m.route(candidate) if ends else math.inf
        self.expect("verify's candidate " + text(candidate), cost, verdict["candidate_cost"])
        self.expect("verify's baseline " + text(baseline), m.route(baseline),
                    verdict["baseline_cost"])
        accepted = cost < m.route(baseline) - 1e-6 and m.route(baseline) < math.inf
        if (verdict["code"] == "accepted") != accepted:
            raise SystemExit("verify says %s for %s against %s on %s" % (
                verdict["code"], text(candidate), text(baseline), self.map_path))

    def check_dataset(self, rng, cases):
        """The dataset form of verify, on many maps at once."""
        (self.folder / "maps").mkdir(exist_ok=True)
        expected = {}
        with open(self.folder / "cases.csv", "w", newline="", encoding="utf-8") as c, \
                open(self.folder / "routes.csv", "w", newline="", encoding="utf-8") as r:
            case_rows, route_rows = csv.writer(c), csv.writer(r)
            case_rows.writerow("case_id map start_x start_y goal_x goal_y".split())
            route_rows.writerow("case_id k route".split())
            for i in range(cases):
                m = Map(random_rows(rng), True, 0)
                start, goal = [(rng.randrange(m.width), rng.randrange(m.height)) for _ in "ab"]
                write_png(self.folder / "maps" / ("%d.png" % i), m.rows)
                case_rows.writerow(["c%d" % i, "maps/%d.png" % i, *start, *goal])
                for k in (1, 2):
                    route = random_route(rng, m, start, goal)
                    ends = len(route) >= 2 and route[0] == start and route[-1] == goal
                    expected["c%d" % i, str(k)] = m.route(route) if ends else math.inf
                    route_rows.writerow(["c%d" % i, k, text(route)])
        out = self.folder / "verdicts.csv"
        subprocess.run([self.terra, "verify", "--dataset", self.folder, "--routes",
                        self.folder / "routes.csv", "--out", out], check=True, timeout=120,
                       stdout=subprocess.DEVNULL)
        with open(out, newline="", encoding="utf-8") as f:
            got = {(row["case_id"], row["k"]): row for row in csv.DictReader(f)}
        if set(got) != set(expected):
            raise SystemExit("verify --dataset answered other cases than it was asked")
        for key, cost in expected.items():
            self.expect("verify --dataset, %s" % (key,), cost, float(got[key]["cost"]))
            if (got[key]["code"] == "feasible") != (cost < math.inf):
                raise SystemExit("verify --dataset: code %s with cost %r" % (got[key]["code"], cost))
        return len(expected)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("terra")
    parser.add_argument("--maps", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    rng = random.Random(arguments.seed)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="terra-check-"))
    checker = Checker(arguments.terra, folder)
    compared = sum(checker.check_map(rng) for _ in range(arguments.maps))
    compared += checker.check_dataset(rng, arguments.maps)
    if compared < arguments.maps:
        raise SystemExit("only %d comparisons on %d maps" % (compared, arguments.maps))
    subprocess.run(["rm", "-r", str(folder)], check=True)
    print("%d comparisons on %d maps, no difference" % (compared, 2 * arguments.maps))


if __name__ == "__main__":
    sys.exit(main())
