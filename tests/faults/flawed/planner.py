#!/usr/bin/env python3
"""A planner to be broken on purpose; it plans by `terra plan`.

usage: planner.py FLAW FIELDS.json --stride N --terra FILE
"""
import json
import pathlib
import select
import subprocess
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))

import bus
import exact
import field
import rig

FLAWS = "none one-gate".split()


class Planner:
    def __init__(self, flaw, fields, stride, terra, folder):
        self.flaw, self.fields = flaw, fields
        self.stride, self.terra, self.folder = stride, terra, folder
        self.out = bus.Tap(rig.PORT)
        self.map = None  # (id, index)
        self.message = None
        self.gates, self.from_replaced = [], 0

    def hear(self, heard):
        message = bus.decode(heard)
        if message is None:
            return
        if heard.channel == "TERRA_MAP_HEADER":
            known = exact.field_named(message, self.fields)
            if known and (self.map is None or self.map[0] != message["map_id"]):
                self.map = message["map_id"], self.fields.index(known)
                if self.message:
                    self.plan(self.message)
        elif heard.channel == "TERRA_PLAN_REQUEST" and message["action"] == 1 and self.map:
            if not self.message or self.message["request_id"] != message["request_id"]:
                self.plan(message)
        elif heard.channel == "TERRA_DEPLOYED":
            if message["session"] in self.gates[:-1]:
                self.from_replaced += self.flaw != "one-gate"
            elif message["session"] not in self.gates:
                self.gates.append(message["session"])

    def plan(self, request):
        ends = {name: request[name] for name in ("start_x", "start_y", "goal_x", "goal_y")}
        done = subprocess.run(
            [self.terra, "plan", "--map", self.folder / f"map-{self.map[1]}.png", "--legend",
             self.folder / "legend.csv", "--stride", self.stride, "--start",
             "{start_x},{start_y}".format(**ends), "--goal", "{goal_x},{goal_y}".format(**ends),
             "--json"], capture_output=True, check=False)
        waypoints = json.loads(done.stdout)["waypoints"] if done.returncode == 0 else []
        self.message = dict(
            ends, request_id=request["request_id"], map_id=self.map[0], planner="planner",
            status=1 if waypoints else 2, num_waypoints=len(waypoints),
            waypoint_x=[x for x, _ in waypoints], waypoint_y=[y for _, y in waypoints],
            baseline_digest=exact.baseline_digest(request["request_id"], self.map[0], waypoints))
        self.out.say("TERRA_BASELINE", self.message)

    def run(self):
        repeat_at = status_at = 0.0
        while True:
            select.select([self.out], [], [], 0.02)
            for heard in self.out.heard():
                self.hear(heard)
            now = time.monotonic()
            if now >= repeat_at and self.message:
                repeat_at = now + 0.2
                self.out.say("TERRA_BASELINE", self.message)
            if now >= status_at:
                status_at = now + 1.0
                self.out.say("TERRA_STATUS", {
                    "status_name": "planner", "state": "ready", "num_counters": 1,
                    "counter_name": ["from_replaced_gate"],
                    "counter_value": [self.from_replaced]})


def main():
    flaw, fields_path = sys.argv[1], pathlib.Path(sys.argv[2])
    if flaw not in FLAWS:
        sys.exit(f"no such flaw: {flaw}")
    fields = [field.Field(one) for one in json.loads(fields_path.read_text())]
    Planner(flaw, fields, sys.argv[4], sys.argv[6], fields_path.parent).run()


if __name__ == "__main__":
    main()
