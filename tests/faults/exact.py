"""Routes and costs as the observer counts them: in integers.

A route costs a + b sqrt 2, a and b in half units of terrain cost. Nothing is
rounded, so "cheaper" has no tolerance.
"""
import ctypes
import functools
import math
import struct

import field

SQRT2 = math.sqrt(2)
HALVES = [None if math.isinf(cost) else int(2 * cost) for cost in field.COSTS]
_XXHASH = ctypes.CDLL("libxxhash.so.0")
_XXHASH.XXH3_64bits.restype = ctypes.c_int64
_XXHASH.XXH3_64bits.argtypes = [ctypes.c_char_p, ctypes.c_size_t]


def xxh3(data):
    """Signed, as LCM's int64_t carries it."""
    return _XXHASH.XXH3_64bits(data, len(data))


@functools.total_ordering
class Cost:
    """Of a feasible route."""

    def __init__(self, straight=0, diagonal=0):
        self.straight, self.diagonal = straight, diagonal

    def value(self):
        return (self.straight + self.diagonal * SQRT2) / 2

    def __eq__(self, other):
        return (self.straight, self.diagonal) == (other.straight, other.diagonal)

    def __lt__(self, other):
        # Is a + b sqrt 2 < 0?
        a, b = self.straight - other.straight, self.diagonal - other.diagonal
        if a <= 0 and b <= 0:
            return a < 0 or b < 0
        if a >= 0 and b >= 0:
            return False
        return a * a > 2 * b * b if a < 0 else a * a < 2 * b * b

    def __repr__(self):
        return f"{self.value():.6f}"


def route_cost(known, cells):
    """Cost of successive cells on a field, None when they are not feasible."""
    width, height = len(known.rows[0]), len(known.rows)
    sums = [0, 0]
    before = None
    for x, y in cells:
        if not (0 <= x < width and 0 <= y < height):
            return None
        entering = HALVES[known.rows[y][x]]
        if entering is None:
            return None
        if before is not None:
            dx, dy = abs(x - before[0]), abs(y - before[1])
            if max(dx, dy) != 1:
                return None
            sums[dx & dy] += entering
        before = (x, y)
    return Cost(*sums)


def baseline_digest(request_id, map_id, waypoints):
    data = struct.pack("<qq", request_id, map_id)
    return xxh3(data + b"".join(struct.pack("<ii", *cell) for cell in waypoints))


def tile_digests(known, side):
    width, height = len(known.rows[0]), len(known.rows)
    return [xxh3(b"".join(bytes(row[x:x + side]) for row in known.rows[y:y + side]))
            for y in range(0, height, side) for x in range(0, width, side)]


def map_id(header):
    """What a MAP_HEADER must name itself, from its other fields."""
    data = struct.pack("<iiii", header["width"], header["height"], header["tile_side"],
                       header["num_terrains"])
    for number, cost in zip(header["terrain_id"], header["terrain_cost"]):
        data += struct.pack("<id", number, cost)
    data += struct.pack("<ii", header["corner_cutting"], header["clearance_cells"])
    data += struct.pack(f"<{header['num_tiles']}q", *header["tile_digest"])
    return xxh3(data) or 1


def field_named(header, fields):
    """Which of the fields a MAP_HEADER names, if it is one of them and true."""
    if map_id(header) != header["map_id"] or header["terrain_cost"] != field.COSTS:
        return None
    return next((known for known in fields if header["tile_side"] > 0 and
                 header["tile_digest"] == tile_digests(known, header["tile_side"])), None)
