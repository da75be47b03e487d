"""Datasets, the cost rule and the two planners once more, in plain Python.

Written from the definitions alone; nothing is shared with the C++ sources.
"""

import collections
import csv
import heapq
import math
import struct
import zlib

INF = math.inf
SQRT2 = math.sqrt(2)
# The palette of the paper's Table "Terrain IDs".
PAPER_COSTS = dict(enumerate([1, 3, 3.5, 4, 4.5, 5, 5, 6, 6.5, 7, 8, INF]))
GOAL = (-1, -1)  # Not a cell: the end of a search on the lattice.


# ---- files


def read_png(path):
    """Rows of an 8-bit grey PNG without interlacing."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert (depth, colour, interlaced) == (8, 0, 0), path
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    raw, rows, above = zlib.decompress(packed), [], bytes(width)
    for y in range(height):
        line = bytearray(raw[y * (width + 1) + 1:(y + 1) * (width + 1)])
        unfilter(raw[y * (width + 1)], line, above)
        rows.append(bytes(line))
        above = line
    return rows


def unfilter(kind, line, above):
    """Undoes a PNG row filter in place."""
    for x in range(len(line)):
        left = line[x - 1] if x else 0
        up, corner = above[x], above[x - 1] if x else 0
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = up
        elif kind == 3:
            guess = (left + up) // 2
        elif kind == 4:
            base = left + up - corner
            guess = min((abs(base - left), 0, left), (abs(base - up), 1, up),
                        (abs(base - corner), 2, corner))[2]
        else:
            return
        line[x] = (line[x] + guess) % 256


def write_png(path, rows):
    def chunk(kind, body):
        return (struct.pack(">I", len(body)) + kind + body
                + struct.pack(">I", zlib.crc32(kind + body)))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    pixels = b"".join(b"\0" + bytes(row) for row in rows)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b""))


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as f:
        return list(csv.DictReader(f))


Case = collections.namedtuple("Case", "group map start goal")


def read_cases(folder, corner_cutting=True, clearance=0):
    """The cases of a dataset by their ids, in its order."""
    legend = PAPER_COSTS
    if (folder / "legend.csv").exists():
        legend = {int(row["id"]): float(row["cost"]) for row in read_csv(folder / "legend.csv")}
    return {row["case_id"]: Case(row["group"],
                                 Map(read_png(folder / row["map"]), legend, corner_cutting,
                                     clearance),
                                 (int(row["start_x"]), int(row["start_y"])),
                                 (int(row["goal_x"]), int(row["goal_y"])))
            for row in read_csv(folder / "cases.csv")}


# ---- the cost rule


def segment(a, b):
    """Cells from a to b, both included: Bresenham in travel direction."""
    (x, y), (x1, y1) = a, b
    dx, dy = abs(x1 - x), -abs(y1 - y)
    sx, sy = (1 if x < x1 else -1), (1 if y < y1 else -1)
    e = dx + dy
    yield x, y
    while (x, y) != (x1, y1):
        e2 = 2 * e
        if e2 >= dy:
            e += dy
            x += sx
        if e2 <= dx:
            e += dx
            y += sy
        yield x, y


class Map:
    """Costs of cells in one list with a blocked frame, so that steps need no
    test of the edge."""

    def __init__(self, rows, legend, corner_cutting, clearance):
        self.height, self.width = len(rows), len(rows[0])
        self.pitch = self.width + 2
        wall = [INF] * self.pitch
        self.cost = wall + [c for row in rows for c in (INF, *(legend[i] for i in row), INF)] + wall
        self.corner_cutting = corner_cutting
        self.known = {}
        walls = [(x, y) for y, row in enumerate(rows) for x, i in enumerate(row)
                 if clearance and legend[i] == INF]
        for x, y in walls:
            self.block_around(x, y, clearance)

    def block_around(self, x, y, radius):
        for dy in range(-radius, radius + 1):
            for dx in range(-radius, radius + 1):
                if dx * dx + dy * dy <= radius * radius and self.inside((x + dx, y + dy)):
                    self.cost[self.place((x + dx, y + dy))] = INF

    def place(self, cell):
        return (cell[1] + 1) * self.pitch + cell[0] + 1

    def inside(self, cell):
        return 0 <= cell[0] < self.width and 0 <= cell[1] < self.height

    def passable(self, cell):
        return self.inside(cell) and self.cost[self.place(cell)] < INF

    def segment_cost(self, a, b):
        """Of a segment whose ends are inside; inf where it is blocked."""
        if (a, b) not in self.known:
            self.known[a, b] = self.walk(a, b)
        return self.known[a, b]

    def walk(self, a, b):
        if not self.passable(a):
            return INF
        total, here = 0.0, a
        for cell in segment(a, b):
            if cell == here:
                continue
            step = self.cost[self.place(cell)]
            if cell[0] != here[0] and cell[1] != here[1]:
                step *= SQRT2
                if not self.corner_cutting and not (self.passable((here[0], cell[1]))
                                                    and self.passable((cell[0], here[1]))):
                    return INF
            total += step
            here = cell
        return total

    def route_cost(self, route, start, goal):
        """Of a route between these ends; inf where it is not feasible."""
        if len(route) < 2 or route[0] != start or route[-1] != goal:
            return INF
        if not all(map(self.inside, route)):
            return INF
        return sum(self.segment_cost(a, b) for a, b in zip(route, route[1:]))


# ---- the two planners


def optimum(m, start, goal):
    """Dijkstra over all cells."""
    if not m.passable(start) or not m.passable(goal):
        return INF
    cost, pitch = m.cost, m.pitch
    source, target = m.place(start), m.place(goal)
    straight = (1, -1, pitch, -pitch)
    diagonal = [(d + e, d, e) for d in (1, -1) for e in (pitch, -pitch)]
    best = [INF] * len(cost)
    best[source] = 0.0
    queue = [(0.0, source)]
    while queue:
        here, cell = heapq.heappop(queue)
        if cell == target:
            return here
        if here > best[cell]:
            continue
        for d in straight:
            other = cell + d
            total = here + cost[other]
            if total < best[other]:
                best[other] = total
                heapq.heappush(queue, (total, other))
        for d, e, f in diagonal:
            other = cell + d
            total = here + SQRT2 * cost[other]
            if total < best[other] and (m.corner_cutting or (cost[cell + e] < INF
                                                             and cost[cell + f] < INF)):
                best[other] = total
                heapq.heappush(queue, (total, other))
    return INF


def joins(end, node, stride, joints):
    """May a segment lead from or to this end at this lattice node?"""
    if joints == "visible":
        return True
    if joints == "2r":
        return max(abs(end[0] - node[0]), abs(end[1] - node[1])) <= 2 * stride
    # A corner of a closed lattice cell that holds the end.
    return all(abs(e - n) <= (stride if e % stride == 0 else stride - 1)
               for e, n in zip(end, node))


def lattice_cost(m, start, goal, stride, joints):
    """Dijkstra over the lattice; start and goal are nodes of their own."""
    if not m.inside(start) or not m.inside(goal):
        return INF
    nodes = [(x, y) for y in range(0, m.height, stride) for x in range(0, m.width, stride)]
    to_goal = {n: m.segment_cost(n, goal) for n in nodes if joins(goal, n, stride, joints)}
    best, queue = {}, []

    def reach(node, total):
        if total < best.get(node, INF):
            best[node] = total
            heapq.heappush(queue, (total, node))

    if max(abs(start[0] - goal[0]), abs(start[1] - goal[1])) <= 2 * stride:
        reach(GOAL, m.segment_cost(start, goal))
    for node in nodes:
        if joins(start, node, stride, joints):
            reach(node, m.segment_cost(start, node))
    while queue:
        total, node = heapq.heappop(queue)
        if node == GOAL:
            return total
        if total > best[node]:
            continue
        reach(GOAL, total + to_goal.get(node, INF))
        for dx in (-stride, 0, stride):
            for dy in (-stride, 0, stride):
                other = node[0] + dx, node[1] + dy
                if m.inside(other):
                    reach(other, total + m.segment_cost(node, other))
    return INF
