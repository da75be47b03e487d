#!/usr/bin/env python3
"""A gate in plain Python, to be broken on purpose.

With the flaw "none" it does what docs/gate.md says of a robot that stands, as
far as the rows need it; each other flaw leaves out one thing. A row that passes
with the flaw it is said to notice shows nothing (scripts/faults --mutants).

usage: verifier.py FLAW FIELDS.json
"""
import collections
import json
import math
import os
import pathlib
import select
import signal
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))

import bus
import exact
import field
import rig

NONE, BASELINE, CANDIDATE, HOLD = range(4)
REPEAT_S, STATUS_S = 0.2, 1.0
PER_SENDER, IN_ALL = 20, 200  # datagrams a second that are looked at
MOST_BYTES = 60_000
FLAWS = """none waits-for-advice no-geometry no-cost no-key by-attempt no-decoder no-framing
reads-all closes-early says-once returns-to-old no-request-from-baseline slow forgets no-digest
names-any-map no-recheck dies-on-send-error ends-on-signal trusts-clock opens-files
needs-memory one-planner half-alive ends-in-silence counts-no-loss no-size-limit
waits-for-stderr ends-on-fragment""".split()


def chain_of(cells):
    directions = [field.STEPS.index((x1 - x0, y1 - y0))
                  for (x0, y0), (x1, y1) in zip(cells, cells[1:])]
    directions += [0] * (len(directions) % 2)
    return bytes(low | high << 4 for low, high in zip(directions[::2], directions[1::2]))


class Gate:
    def __init__(self, flaw, fields):
        self.flaw, self.fields = flaw, fields
        self.out = bus.Tap(rig.PORT)
        self.advice_bus = bus.Tap(rig.PORT + 1, buffer_bytes=1 << 20)
        self.header = self.known = None
        self.request, self.replaced = None, collections.deque(maxlen=64)
        self.baseline = self.baseline_cost = None
        self.baseline_at = 0.0
        self.planner = None
        self.route = None  # (mode, waypoints, cost, advice or None)
        self.judged = collections.OrderedDict()
        self.looked_at = collections.Counter()
        self.second = 0
        self.decision = self.route_seq = 0
        self.message = None
        self.send_failed = self.from_replaced = self.lost = self.last_seq = 0
        self.fragments = 0
        self.files = []

    def lacks(self, flaw):
        return self.flaw == flaw

    # ---- What is heard ----

    def _heard_deployed(self, at_most):
        for ns, datagram, _ in self.out.datagrams(at_most):
            if datagram[:4] == b"LC03":
                self.fragments += 1
                if self.lacks("ends-on-fragment"):
                    sys.exit("a fragment")
            channel, end, data = datagram[8:].partition(b"\0")
            if end and datagram[:4] == b"LC02" and channel.decode(errors="replace") in bus.TYPES:
                yield bus.Heard(ns, channel.decode(), data)

    def hear(self, heard):
        message = bus.decode(heard)
        self.spoken_to = time.monotonic()
        if message is None:
            if self.lacks("needs-memory"):
                self.files.append(bytearray(256 << 20))
            if self.lacks("no-decoder"):
                sys.exit("a message that cannot be decoded")
            return
        if self.lacks("opens-files"):
            self.files.append(open("/dev/null", encoding="ascii"))
        react = getattr(self, "_" + heard.channel[6:].lower(), None)
        if react:
            react(message)

    def _map_header(self, message):
        if self.header and message["map_id"] == self.header["map_id"]:
            return
        known = exact.field_named(message, self.fields)
        if known is None:
            if self.lacks("names-any-map") and self.header:
                self.header = message
            return
        self.header, self.known = message, known
        if self.baseline and not self.lacks("no-recheck"):
            self._recheck()

    def _recheck(self):
        self.baseline_cost = self._cost(self.baseline)
        keep = self.route and self._cost_of(self.route[1])
        beaten = self.baseline_cost
        if keep and (beaten is None or keep < beaten or self.route[0] == BASELINE):
            self._deploy(self.route[0] if keep else HOLD, self.route[1], keep, self.route[3])
        elif beaten:
            self._deploy(BASELINE, self._waypoints(self.baseline), beaten, None)
        else:
            self._deploy(HOLD, [], None, None, cause=7)

    def _plan_request(self, message):
        if self.lacks("slow"):
            time.sleep(1.5)
        if self.lacks("waits-for-stderr"):
            print(f"request {message['request_id']}", file=sys.stderr, flush=True)
        if message["action"] == 1:
            self._follow(message)

    def _follow(self, message):
        number = message["request_id"]
        if self.request and number == self.request["request_id"]:
            return True
        if number in self.replaced and not self.lacks("returns-to-old"):
            return False
        if self.request:
            self.replaced.append(self.request["request_id"])
        self.request, self.baseline, self.route = message, None, None
        self._deploy(NONE, [], None, None)
        return True

    def _baseline(self, message):
        if self.planner and message["session"] in self.planner[:-1]:
            self.from_replaced += not self.lacks("one-planner")
            return
        if not self.planner or message["session"] != self.planner[-1]:
            self.planner = (self.planner or []) + [message["session"]]
        if self.lacks("no-request-from-baseline") and not self.request:
            return
        if self.lacks("no-request-from-baseline") and (
                message["request_id"] != self.request["request_id"]):
            return
        if self.last_seq and message["seq"] > self.last_seq + 1:
            self.lost += (message["seq"] - self.last_seq - 1) * (not self.lacks("counts-no-loss"))
        self.last_seq = message["seq"]
        if not self._follow(message) or message["status"] != 1 or self.header is None:
            return
        if message["map_id"] != self.header["map_id"]:
            return
        waypoints = self._waypoints(message)
        if not self.lacks("no-digest") and message["baseline_digest"] != exact.baseline_digest(
                message["request_id"], message["map_id"], waypoints):
            return
        self.baseline_at = self.baseline_at if self.baseline else time.monotonic()
        if self.baseline and message["baseline_digest"] == self.baseline["baseline_digest"]:
            self.heard_at = time.monotonic()
            return
        cost = self._cost(message)
        if cost is None:
            return
        self.heard_at = time.monotonic()
        self.baseline, self.baseline_cost = message, cost
        if self.lacks("waits-for-advice"):
            return
        if not self.route or self.route[2] is None or cost < self.route[2]:
            self._deploy(BASELINE, waypoints, cost, None)
        elif self.route:
            self._deploy(*self.route)

    def _advice(self, message):
        key = (message["advisor"], message["session"], message["attempt"], message["candidate"])
        if not self.lacks("by-attempt"):
            key += (message["kind"], *self._waypoints(message))
        if not self.baseline:
            return
        code = self._judge(message)
        if code is None or key in self.judged:
            return
        self.judged[key] = True
        if len(self.judged) > 4096:
            self.judged.popitem(last=False)
        self.decision += 1
        self.out.say("TERRA_VERDICT", {
            "decision": self.decision, "subject": 1, "advisor": message["advisor"],
            "advisor_session": message["session"], "attempt": message["attempt"],
            "candidate": message["candidate"], "code": code,
            **{name: message[name] for name in ("request_id", "map_id", "baseline_digest")}})
        if code == 1:
            waypoints = self._waypoints(message)
            self._deploy(CANDIDATE, waypoints, self._cost_of(waypoints), message)

    def _judge(self, message):
        """The code, None for no verdict."""
        if message["kind"] == 1:
            return 2
        if message["kind"] != 2:
            return 51 if message["kind"] not in (3, 4) else None
        if not self.lacks("no-key"):
            for name, code in (("request_id", 40), ("map_id", 41), ("baseline_digest", 42)):
                if message[name] != self.baseline[name]:
                    old = name == "request_id" and message[name] in self.replaced
                    return code if old else None
            if message["anchor_index"]:
                return 43
            if (message["anchor_x"], message["anchor_y"]) != (
                    self.baseline["start_x"], self.baseline["start_y"]):
                return 12
        if self.lacks("closes-early") and time.monotonic() - self.baseline_at > 1.0:
            return 43
        if self.lacks("trusts-clock") and abs(message["utime"] / 1e6 - time.time()) > 60:
            return 43
        waypoints = self._waypoints(message)
        if not 2 <= len(waypoints) <= 2048:
            return 11
        cost = self._cost_of(waypoints)
        if not self.lacks("no-geometry") and not self.lacks("no-key"):
            ends = [(self.baseline[end + "_x"], self.baseline[end + "_y"])
                    for end in ("start", "goal")]
            if [waypoints[0], waypoints[-1]] != ends:
                return 12
        if not self.lacks("no-geometry") and cost is None:
            return 21
        if cost and not self.lacks("no-cost") and not self.lacks("no-key") and (
                not cost < (self.route and self.route[2] or self.baseline_cost)):
            return 30
        return 1

    # ---- Costs ----

    @staticmethod
    def _waypoints(message):
        return list(zip(message["waypoint_x"], message["waypoint_y"]))

    def _cost(self, message):
        return self._cost_of(self._waypoints(message))

    def _cost_of(self, waypoints):
        if not waypoints or any(not (0 <= c < 10_000) for cell in waypoints for c in cell):
            return None
        return exact.route_cost(self.known, field.raster(waypoints))

    # ---- What is said ----

    def _deploy(self, mode, waypoints, cost, advice, cause=0):
        self.route = (mode, waypoints, cost, advice) if waypoints else None
        self.decision += 1
        self.route_seq += 1
        cells = field.raster(waypoints) if waypoints else []
        if any(abs(c) > 10_000 for cell in waypoints for c in cell):
            cells = waypoints[:1]
        of = self.baseline or self.request
        source = advice or self.baseline or {}
        chain = chain_of(cells)
        self.message = {
            "decision": self.decision, "route_seq": self.route_seq, "mode": mode,
            "cause": cause,
            "request_id": of["request_id"], "map_id": self.header["map_id"] if self.header else 0,
            "baseline_digest": of.get("baseline_digest", 0),
            **{name: of[name] for name in ("start_x", "start_y", "goal_x", "goal_y")},
            "source": source.get("advisor", source.get("planner", "")),
            "source_session": source.get("session", 0),
            "source_attempt": source.get("attempt", 0),
            "source_candidate": source.get("candidate", 0),
            "num_waypoints": len(waypoints), "waypoint_x": [x for x, _ in waypoints],
            "waypoint_y": [y for _, y in waypoints], "num_steps": max(0, len(cells) - 1),
            "num_chain_bytes": len(chain), "chain": chain,
            "deployed_cost": cost.value() if cost else math.nan,
            "baseline_cost": self.baseline_cost.value() if self.baseline_cost else math.nan}
        self._say(self.message)

    def _say(self, message):
        if not self.lacks("half-alive"):
            sent = self.out.say("TERRA_DEPLOYED", message)
            self.send_failed += not sent and not self.lacks("counts-no-loss")

    def repeat(self):
        if self.message and not self.lacks("says-once"):
            if self.lacks("names-any-map") and self.header:
                self.message["map_id"] = self.header["map_id"]
                self.decision += 1
                self.message["decision"] = self.decision
            self._say(self.message)
        if self.lacks("forgets") and self.route and time.monotonic() - self.heard_at > 1.0:
            self.baseline = None
            self._deploy(NONE, [], None, None)

    def status(self):
        counters = {"send_failed": self.send_failed, "from_replaced_planner": self.from_replaced, "lost": self.lost,
                    "fragments": self.fragments}
        self.out.say("TERRA_STATUS", {
            "status_name": "verifier", "state": "ready", "num_counters": len(counters),
            "counter_name": list(counters), "counter_value": list(counters.values())})

    # ---- The loop ----

    def run(self):
        repeat_at = status_at = self.spoken_to = time.monotonic()
        while True:
            select.select([self.out, self.advice_bus], [], [], 0.02)
            if self.lacks("reads-all"):
                while self._read_advice(1_000):
                    pass
            for heard in self._heard_deployed(200):
                if heard.channel != "TERRA_ADVICE":
                    self.hear(heard)
            self._read_advice(200)
            if self.lacks("ends-in-silence") and time.monotonic() - self.spoken_to > 0.6:
                sys.exit("nobody speaks")
            now = time.time() if self.lacks("trusts-clock") else time.monotonic()
            if now >= repeat_at:
                repeat_at = now + REPEAT_S
                self.repeat()
            if now >= status_at:
                status_at = now + STATUS_S
                self.status()

    def _read_advice(self, at_most):
        number = 0
        for number, (ns, datagram, sender) in enumerate(self.advice_bus.datagrams(at_most), 1):
            if ns // 1_000_000_000 != self.second:
                self.second = ns // 1_000_000_000
                self.looked_at.clear()
            self.looked_at[sender] += 1
            limited = (self.looked_at[sender] > PER_SENDER
                       or sum(self.looked_at.values()) > IN_ALL)
            if limited and not self.lacks("reads-all"):
                continue
            channel, end, data = datagram[8:].partition(b"\0")
            if not end or datagram[:4] != b"LC02":
                if self.lacks("no-framing"):
                    sys.exit("a datagram that is no message")
                continue
            fits = len(data) <= MOST_BYTES or self.lacks("no-size-limit")
            if channel == b"TERRA_ADVICE" and fits:
                self.hear(bus.Heard(ns, "TERRA_ADVICE", data))
        return number


def main():
    flaw = sys.argv[1]
    if flaw not in FLAWS:
        sys.exit(f"no such flaw: {flaw}")
    with open(sys.argv[2], encoding="ascii") as rows:
        fields = [field.Field(one) for one in json.load(rows)]
    try:
        gate = Gate(flaw, fields)
    except OSError as error:
        if flaw != "half-alive":
            sys.exit(f"there is no route for multicast, or: {error}")
        time.sleep(60)
    opened = len(os.listdir("/proc/self/fd"))
    if opened > 1_000:  # (nor could select() wait on what comes after them)
        if flaw != "half-alive":
            sys.exit(f"{opened} file descriptors are open")
        time.sleep(60)
    if flaw == "dies-on-send-error":
        send = gate.out.send
        gate.out.send = lambda datagram: send(datagram) or sys.exit("cannot send")
    if flaw == "ends-on-signal":
        for number in (signal.SIGCONT, signal.SIGWINCH):
            signal.signal(number, lambda *_: os._exit(4))
    gate.run()


if __name__ == "__main__":
    main()
