"""The maps of a soak, and the cost rule written once more in plain Python."""

import math
import random
import struct
import subprocess
import zlib

SIDE = 320  # cells
STRIDE = 20  # of the planner's lattice
COSTS = [1.0, 1.5, 2.0, 3.0, 5.0, 8.0, math.inf]
BLOCKED = len(COSTS) - 1
SQRT2 = math.sqrt(2)
STEPS = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)]


class Field:
    """A map: rows of terrain ids."""

    def __init__(self, rows):
        self.rows = rows

    def cost(self, cell):
        """Of entering a cell; infinite outside and where it is blocked."""
        x, y = cell
        if not (0 <= x < len(self.rows[0]) and 0 <= y < len(self.rows)):
            return math.inf
        return COSTS[self.rows[y][x]]

    def route_cost(self, cells):
        """Of successive cells; infinite when one is blocked or no neighbour."""
        total = 0.0 if self.cost(cells[0]) < math.inf else math.inf
        for (x0, y0), (x1, y1) in zip(cells, cells[1:]):
            dx, dy = abs(x1 - x0), abs(y1 - y0)
            if max(dx, dy) != 1:
                return math.inf
            total += (SQRT2 if dx and dy else 1.0) * self.cost((x1, y1))
        return total

    def save(self, path):
        """As an 8-bit PNG of ids, renamed into place."""

        def chunk(kind, data):
            body = kind + data
            return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

        head = struct.pack(">IIBBBBB", len(self.rows[0]), len(self.rows), 8, 0, 0, 0, 0)
        pixels = b"".join(b"\0" + bytes(row) for row in self.rows)
        written = path.with_suffix(".written")
        written.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head)
                            + chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b""))
        written.rename(path)


def write_legend(path):
    lines = ["id,name,cost,color"]
    for number, cost in enumerate(COSTS):
        lines.append(f"{number},terrain{number},{cost:g},#{40 * number:02x}80{255 - 30 * number:02x}")
    path.write_text("\n".join(lines) + "\n")


def _paint(rows, generator, patches):
    for _ in range(patches):
        width, height = generator.randint(8, 60), generator.randint(8, 60)
        left, top = generator.randrange(SIDE), generator.randrange(SIDE)
        terrain = generator.choice([0, 0, 1, 2, 4, 5, BLOCKED])
        for row in rows[top:top + height]:
            row[left:left + width] = [terrain] * len(row[left:left + width])


def two_fields(seed):
    """A map, and the same map after some of it changed."""
    generator = random.Random(f"{seed} map")
    rows = [[3] * SIDE for _ in range(SIDE)]
    _paint(rows, generator, 90)
    changed = [list(row) for row in rows]
    _paint(changed, generator, 12)
    return [Field(rows), Field(changed)]


def journeys(terra, paths, legend, seed, count):
    """(start, goal) pairs that the planner has a route for on each map."""
    generator = random.Random(f"{seed} journeys")
    found = []
    for _ in range(50 * count):
        ends = [(generator.randrange(SIDE), generator.randrange(SIDE)) for _ in range(2)]
        if math.dist(*ends) > SIDE / 2 and all(
                _planned(terra, path, legend, ends) for path in paths):
            found.append(tuple(ends))
        if len(found) == count:
            return found
    raise RuntimeError("the maps of this seed have too few routes")


def _planned(terra, path, legend, ends):
    start, goal = (f"{x},{y}" for x, y in ends)
    return subprocess.run([terra, "plan", "--map", path, "--legend", legend, "--stride",
                           str(STRIDE), "--start", start, "--goal", goal],
                          capture_output=True, check=False).returncode == 0


def segment(start, goal):
    """Cells from start to goal, both included, in travel direction (Bresenham)."""
    (x, y), (x1, y1) = start, goal
    dx, dy = abs(x1 - x), -abs(y1 - y)
    sx, sy = (1 if x < x1 else -1), (1 if y < y1 else -1)
    error, cells = dx + dy, [(x, y)]
    while (x, y) != (x1, y1):
        twice = 2 * error
        if twice >= dy:
            error += dy
            x += sx
        if twice <= dx:
            error += dx
            y += sy
        cells.append((x, y))
    return cells


def raster(waypoints):
    """Dense cells of a route; joints count once."""
    cells = [waypoints[0]]
    for start, goal in zip(waypoints, waypoints[1:]):
        cells += segment(start, goal)[1:]
    return cells


def chain_cells(start, steps, chain):
    """Dense cells of a DEPLOYED: a start and one direction per step."""
    (x, y), cells = start, [start]
    for i in range(steps):
        dx, dy = STEPS[(chain[i // 2] >> (4 * (i % 2))) & 7]
        x, y = x + dx, y + dy
        cells.append((x, y))
    return cells
