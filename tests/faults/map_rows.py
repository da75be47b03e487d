"""Maps that change, block, lie, and come in broken tiles."""
import math

import exact
from rig import require
from rows import row

BLOCKING = 2  # index of the map without any way through


@row("map changes again and again", "GATE 13", ["verifier:no-recheck"], limit_s=4.0, short=True)
def map_changes(rig):
    rig.set_up("searcher", "cutter")
    for i in range(10):
        before = rig.map_id
        rig.show_map((i + 1) % 2)
        rig.injected += 1
        if i % 3 == 2:
            rig.ask()  # while planner, gate and advisors learn of it one by one
        rig.await_(lambda: rig.map_id != before, 3, "the map server does not see its file")
        rig.await_(lambda: rig.has_route() and rig.deployed["map_id"] == rig.map_id, 3,
                   "no route in force on the new map")
    rig.serve(3)
    rig.await_candidate()
    return "every deployment is feasible and costs what it says on the map it names"


@row("map blocks baseline, candidate, both", "GATE 14", ["verifier:no-recheck"], limit_s=4.0)
def map_blocks(rig):
    rig.set_up("searcher")
    causes = set()
    for ends in rig.journeys[:5]:
        rig.serve(3, ends)
        rig.await_candidate()
        rig.show_map(BLOCKING)
        rig.injected += 1
        rig.await_(lambda: not rig.has_route(), 4, "a route on a map without a way")
        causes.add(rig.deployed["cause"])
        rig.show_map(1)
        rig.injected += 1
        rig.await_(rig.has_route, 4, "no route when there is a way again")
        causes.add(rig.deployed["cause"])
        rig.show_map(0)
        rig.await_(lambda: rig.has_route((2,)) and rig.deployed["map_id"] == rig.baseline["map_id"],
                   5, "no candidate on the first map again")
    # revert_blocked, baseline_invalid, no_route; then map_update, new_baseline, upgrade.
    require(causes & {5, 7, 9}, f"the causes say nothing of it: {causes}")
    return "no route while there is no way (hold, none), a route again when there is"


@row("map tiles: wrong bytes, wrong size, bombs, of no map", "GATE 12; LCM lies",
     ["map:sends-no-tile"])
def hostile_tiles(rig):
    rig.set_up("searcher")
    before = rig.map_id
    rig.show_map(1)
    for number in range(200):
        data = rig.random.randbytes(rig.random.randrange(1, 20_000))
        rig.deployed_bus.say("TERRA_MAP_TILE", {
            "num_tiles": 1, "tile_index": [rig.random.choice([0, 1, 24, -1, 1 << 30])],
            "tile_digest": [rig.random.getrandbits(62)], "tile_size": [len(data)],
            "num_bytes": len(data), "data": data, "tile_data": data})
        rig.injected += 1
        if number % 10 == 0:
            rig.hear(0.02)
    rig.await_(lambda: rig.deployed["map_id"] == rig.baseline["map_id"] != before, 4,
               "the true map does not come through")
    rig.serve(3)
    rig.alive("map", "planner", "verifier", "searcher")
    return "refused; the true map comes through"


@row("map headers: NaN, 0, negative costs, absurd sizes, a false id", "GATE 12",
     ["verifier:names-any-map"])
def hostile_headers(rig):
    rig.set_up("searcher")
    header = {"map_revision": 1, "width": 320, "height": 320, "cell_size_m": 1.0,
              "num_terrains": 2, "terrain_id": [0, 1], "terrain_rgb": [0, 1],
              "terrain_name": ["a", "b"], "terrain_cost": [1.0, 2.0], "corner_cutting": 1,
              "clearance_cells": 0,
              "tile_side": 128, "num_tiles": 9, "tile_digest": list(range(9))}
    for change in ({"terrain_cost": [math.nan, 1.0]}, {"terrain_cost": [0.0, 1.0]},
                   {"terrain_cost": [-1.0, 1.0]}, {"terrain_cost": [1e308, 1.0]}, {"width": 0},
                   {"width": -5}, {"width": 1 << 30, "height": 1 << 30}, {"tile_side": 0},
                   {"num_tiles": 1, "tile_digest": [7]}, {"terrain_id": [0, 0]},
                   {"terrain_id": [-1, 300]}, {"clearance_cells": -1}, {"cell_size_m": math.nan},
                   {}):
        lie = header | change
        named = 7 if not change else exact.map_id(lie)
        rig.deployed_bus.say("TERRA_MAP_HEADER", lie | {"map_id": named})
        rig.injected += 1
        rig.hear(0.3)
        require(rig.deployed["map_id"] == rig.baseline["map_id"], "another map is in force")
    rig.alive("map", "planner", "verifier", "searcher")
    # A header may have come from a new map server; the old one is heard again
    # when it is restarted, as a supervisor does.
    rig["map"].kill()
    rig.start("map")
    rig.serve(4)
    return "the map in force stays in force"


@row("map server killed (-9) in mid-transfer", "GATE 12; DESIGN 2 (restart)",
     ["nobody restarts"], limit_s=4.0)
def map_server_killed(rig):
    rig.set_up("searcher")
    for i in range(8):
        rig.show_map((i + 1) % 2)
        rig.hear(0.05 * i)
        rig["map"].kill()
        rig.injected += 1
        rig.serve(3)
        rig.revive("map")
        rig.await_(lambda: rig.baseline["map_id"] == rig.deployed["map_id"] and rig.has_route(),
                   4, "planner and gate do not agree on a map")
        rig.await_(lambda: "map" in rig.status and rig.status["map"]["pid"] == rig["map"].pid,
                   4, "the map server is not back")
        rig.alive("map")
    rig.serve(3)
    return "served on the map in force; the new map comes with the new server"


@row("map file: torn, empty, gone, not readable", "DESIGN 2", ["map:ends-on-a-bad-file"])
def map_file_broken(rig):
    rig.set_up("searcher")
    whole = rig.map.read_bytes()
    for damage in (whole[:len(whole) // 2], b"", b"not a picture", None, whole[:-1]):
        if damage is None:
            rig.map.unlink()
        else:
            rig.map.write_bytes(damage)
        rig.injected += 1
        rig.hear(1.5)
        rig.alive("map")
        rig.serve()
    rig.show_map(1)
    before = rig.deployed["map_id"]
    rig.await_(lambda: rig.has_route() and rig.deployed["map_id"] != before, 5,
               "the next good file is not taken")
    return "the map in force stays; the next good file is taken"
