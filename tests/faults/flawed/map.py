#!/usr/bin/env python3
"""A map server to be broken on purpose.

usage: map.py FLAW FIELDS.json --map FILE --legend FILE
"""
import ctypes
import json
import math
import pathlib
import select
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))

import bus
import exact
import field
import rig

FLAWS = "none sends-no-tile ends-on-a-bad-file".split()
SIDE = 128  # of a tile
_ZSTD = ctypes.CDLL("libzstd.so.1")
_ZSTD.ZSTD_compress.restype = ctypes.c_size_t


def frame(data):
    out = ctypes.create_string_buffer(len(data) + 1_000)
    size = _ZSTD.ZSTD_compress(out, ctypes.c_size_t(len(out)), data,
                               ctypes.c_size_t(len(data)), 3)
    return out.raw[:size]


class Server:
    def __init__(self, flaw, fields, path):
        self.flaw, self.path = flaw, path
        folder = path.parent
        # The rows only ever serve these files.
        self.known = [((folder / f"map-{i}.png").read_bytes(), one)
                      for i, one in enumerate(fields)]
        self.out = bus.Tap(rig.PORT)
        self.field = None
        self.revision = 0
        self.sent_at = {}

    def load(self):
        try:
            data = self.path.read_bytes()
        except OSError:
            data = b""
        found = next((one for known, one in self.known if known == data), None)
        if found is None:
            if self.flaw == "ends-on-a-bad-file":
                sys.exit(f"{self.path}: no map")
            return
        if found is self.field:
            return
        self.field, self.revision = found, self.revision + 1
        digests = exact.tile_digests(found, SIDE)
        if self.flaw == "sends-no-tile" and self.revision > 1:
            self.sent_at = {i: math.inf for i in range(len(digests))}
        costs = field.COSTS
        self.header = {
            "map_revision": self.revision, "width": field.SIDE, "height": field.SIDE,
            "cell_size_m": 1.0, "num_terrains": len(costs), "terrain_id": list(range(len(costs))),
            "terrain_cost": costs, "terrain_rgb": list(range(len(costs))),
            "terrain_name": [f"t{i}" for i in range(len(costs))], "corner_cutting": 1,
            "clearance_cells": 0, "tile_side": SIDE, "num_tiles": len(digests),
            "tile_digest": digests}
        self.header["map_id"] = exact.map_id(self.header)

    def tile(self, index):
        if time.monotonic() - self.sent_at.get(index, -1) < 0.2:
            return
        self.sent_at[index] = time.monotonic()
        across = -(-field.SIDE // SIDE)
        x, y = index % across * SIDE, index // across * SIDE
        data = frame(b"".join(bytes(row[x:x + SIDE]) for row in self.field.rows[y:y + SIDE]))
        self.out.say("TERRA_MAP_TILE", {
            "num_tiles": 1, "tile_index": [index],
            "tile_digest": [self.header["tile_digest"][index]], "tile_size": [len(data)],
            "num_bytes": len(data), "tile_data": data})

    def run(self):
        header_at = status_at = 0.0
        while True:
            select.select([self.out], [], [], 0.02)
            for heard in self.out.heard():
                if heard.channel == "TERRA_MAP_REQUEST" and self.field:
                    for index in bus.decode(heard)["missing_tile"]:
                        self.tile(index)
            now = time.monotonic()
            if now >= header_at:
                header_at = now + 0.2
                self.load()
                if self.field:
                    self.out.say("TERRA_MAP_HEADER", self.header)
            if now >= status_at:
                status_at = now + 1.0
                self.out.say("TERRA_STATUS", {"status_name": "map", "state": "ready",
                                              "pid": rig.os.getpid()})


def main():
    flaw = sys.argv[1]
    if flaw not in FLAWS:
        sys.exit(f"no such flaw: {flaw}")
    with open(sys.argv[2], encoding="ascii") as rows:
        fields = [field.Field(one) for one in json.load(rows)]
    Server(flaw, fields, pathlib.Path(sys.argv[4])).run()


if __name__ == "__main__":
    main()
