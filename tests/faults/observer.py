#!/usr/bin/env python3
"""Checks the gate's invariants 1 to 5 (docs/gate.md) on every DEPLOYED.

Shares nothing with the gate: own decoder, own Bresenham, own sums, own clock
(the kernel's receive times). Listens until it is asked to end, then writes what
it found. It judges only what it heard itself: what it cannot judge for want of
a message is counted as such.

usage: observer.py --port P --fields FIELDS.json --out REPORT.json
"""
import argparse
import collections
import heapq
import itertools
import json
import select
import signal
import struct
import time

import bus
import exact
import field
import wire

NONE, BASELINE, CANDIDATE, HOLD = range(4)
ACCEPTED = 1
EPSILON = 1e-6
TOLD_S = 0.05  # latencies beyond it are told in full
QUEUED_ADVICE = 200_000


class Observer:
    """Messages in, violations out. No clock of its own."""

    def __init__(self, fields):
        self.fields = fields
        self.maps = {}  # map id: field
        self.baselines = {}  # digest: (message, Cost on its map or None)
        self.advice = collections.deque(maxlen=QUEUED_ADVICE)  # bytes
        self.accepted = set()  # (gate session, advisor, its session, attempt, candidate)
        self.decisions = set()  # (gate session, decision)
        self.in_force = {}  # gate session: (message, cells, Cost)
        self.routes = {}  # (gate session, route_seq): cells
        self.waiting = {}  # (request, map): ns of its first valid baseline
        self.served = set()  # (request, map)
        self.request = None
        self.map_in_force = None
        self.unproven = []  # candidates whose advice was not heard (yet)
        self.latencies = []
        self.recent = collections.deque(maxlen=60)  # (ns, channel, request)
        self.slow = []  # the story of the worst latency
        self.counts = collections.Counter()
        self.violations = []

    # ---- What is heard ----

    def hear_advice(self, messages):
        """Of the advice bus: whatever else is said there means nothing."""
        for heard in messages:
            if heard.channel == "TERRA_ADVICE":
                self.advice.append(heard.data)

    def hear(self, heard):
        """Of the deployed bus."""
        message = bus.decode(heard)
        if message is None:
            self.counts["malformed"] += 1
            return
        self.recent.append((heard.ns, heard.channel, message.get("request_id", "")))
        react = getattr(self, "_" + heard.channel[6:].lower(), None)
        if react:
            react(message, heard.ns)

    def _map_header(self, message, _ns):
        named = message["map_id"]
        if self.map_in_force != named:
            self.waiting.clear()  # of another map: the planner plans anew
        self.map_in_force = named
        if named not in self.maps:
            known = exact.field_named(message, self.fields)
            if known:
                self.maps[named] = known

    def _plan_request(self, message, _ns):
        self._ask(message["request_id"])

    def _ask(self, request_id):
        if self.request != request_id:
            self.request = request_id
            self.waiting.clear()

    def _baseline(self, message, ns):
        cells = list(zip(message["waypoint_x"], message["waypoint_y"]))
        digest = message["baseline_digest"]
        known = self.maps.get(message["map_id"])
        if (message["status"] != 1 or known is None or len(cells) < 2 or digest !=
                exact.baseline_digest(message["request_id"], message["map_id"], cells)):
            return
        if digest not in self.baselines:
            self.baselines[digest] = message, exact.route_cost(known, field.raster(cells))
        ends = (cells[0], cells[-1]) == ((message["start_x"], message["start_y"]),
                                         (message["goal_x"], message["goal_y"]))
        key = message["request_id"], message["map_id"]
        # Whoever has deployed something on a map holds it.
        holds = any(one["map_id"] == key[1] for one, _, _ in self.in_force.values())
        if (ends and self.baselines[digest][1] is not None and holds
                and key[0] == self.request and key[1] == self.map_in_force
                and key not in self.served):
            self.waiting.setdefault(key, ns)

    def _verdict(self, message, _ns):
        self.counts["verdicts"] += 1
        self.decisions.add((message["session"], message["decision"]))
        if message["code"] == ACCEPTED:
            self.counts["accepted"] += 1
            self.accepted.add((message["session"], message["advisor"],
                               message["advisor_session"], message["attempt"],
                               message["candidate"]))

    def _deployed(self, message, ns):
        self.counts["deployed"] += 1
        session = message["session"]
        self.decisions.add((session, message["decision"]))
        has_route = message["mode"] in (BASELINE, CANDIDATE)
        key = message["request_id"], message["map_id"]
        if has_route and key not in self.served:
            self.served.add(key)
            if key in self.waiting:
                latency = (ns - self.waiting.pop(key)) / 1e9
                if latency > max([TOLD_S, *self.latencies]):
                    self.slow = [f"{(ns - at) / -1e6:.1f} ms {channel} {request}"
                                 for at, channel, request in self.recent]
                self.latencies.append(latency)
        before = self.in_force.get(session)
        if before and before[0]["decision"] == message["decision"]:
            self._same_as_before(before[0], message)
            return
        cells, cost = [], None
        if has_route:
            try:
                cells, cost = self._judge(message, before)
            except Wrong as wrong:
                self._violation(message, str(wrong))
        elif message["mode"] not in (NONE, HOLD):
            self._violation(message, f"no such mode: {message['mode']}")
        self.in_force[session] = message, cells, cost
        self.routes[session, message["route_seq"]] = cells

    def _same_as_before(self, before, message):
        told = [{name: value for name, value in one.items() if name not in ("utime", "seq")}
                for one in (before, message)]
        # (not a number is not itself)
        if repr(told[0]) != repr(told[1]):
            self._violation(message, "one decision, two routes")

    # ---- The invariants ----

    def _judge(self, message, before):
        self.counts["judged"] += 1
        known = self.maps.get(message["map_id"])
        require(known is not None, "2: a map that nobody serves")
        waypoints = list(zip(message["waypoint_x"], message["waypoint_y"]))
        require(len(waypoints) >= 2, "2: no route")
        cells = field.chain_cells(waypoints[0], message["num_steps"], message["chain"])
        require(cells[0] == (message["start_x"], message["start_y"]), "2: not from the start")
        require(cells[-1] == (message["goal_x"], message["goal_y"]), "2: not to the goal")
        cost = exact.route_cost(known, cells)
        require(cost is not None, "2: not feasible")
        require(abs(cost.value() - message["deployed_cost"]) <= EPSILON,
                f"2: costs {cost}, says {message['deployed_cost']}")
        self._not_dearer_than_the_baseline(message, known, cost)
        self._not_dearer_than_before(message, before, cost)
        if message["mode"] == BASELINE:
            self._is_the_planners(message, waypoints, cells)
        else:
            self._is_an_advisors(message, before, cells)
        return cells, cost

    def _not_dearer_than_the_baseline(self, message, known, cost):
        baseline = self.baselines.get(message["baseline_digest"])
        if baseline is None:
            self.counts["baselines_not_heard"] += 1
            return
        planned = baseline[0]
        require(planned["request_id"] == message["request_id"], "5: another request's baseline")
        ends = [planned[name] for name in ("start_x", "start_y", "goal_x", "goal_y")]
        require(ends == [message[name] for name in ("start_x", "start_y", "goal_x", "goal_y")],
                "2: other ends than the baseline's")
        on_this_map = exact.route_cost(known, field.raster(
            list(zip(planned["waypoint_x"], planned["waypoint_y"]))))
        if on_this_map is None:
            # The baseline is blocked on a new map; only a candidate may stay.
            require(message["mode"] == CANDIDATE, "8: an infeasible baseline")
            return
        require(cost <= on_this_map, f"3: costs {cost}, the baseline {on_this_map}")
        if message["mode"] == CANDIDATE:
            require(cost < on_this_map, f"3: a candidate no cheaper than the baseline ({cost})")

    @staticmethod
    def _not_dearer_than_before(message, before, cost):
        if before is None or before[2] is None:
            return
        if all(before[0][name] == message[name] for name in ("request_id", "map_id")):
            require(cost <= before[2], f"4: the cost rose from {before[2]} to {cost}")

    def _is_the_planners(self, message, waypoints, cells):
        baseline = self.baselines.get(message["baseline_digest"])
        if baseline is None:
            return
        same = [one for one, _ in self.baselines.values()
                if one["request_id"] == message["request_id"]
                and list(zip(one["waypoint_x"], one["waypoint_y"])) == waypoints]
        require(bool(same), "5: says baseline, and no planner said it")
        require(field.raster(waypoints) == cells, "2: the chain is not the waypoints'")

    def _is_an_advisors(self, message, before, cells):
        self.counts["candidates"] += 1
        who = (message["session"], message["source"], message["source_session"],
               message["source_attempt"], message["source_candidate"])
        stays = before and before[1] == cells and before[0]["mode"] == CANDIDATE
        if not stays and who not in self.accepted:
            # Its verdict is the decision before, unless that one was lost.
            require((message["session"], message["decision"] - 1) not in self.decisions,
                    "5: no verdict accepted it")
            self.counts["verdicts_not_heard"] += 1
        if not stays and not self._said(message, cells):
            self.unproven.append((message, cells))

    def _said(self, message, cells):
        """Whether an advisor said this route for what was in force."""
        session = struct.pack(">q", message["source_session"])
        answer = struct.pack(">qi", message["source_attempt"], message["source_candidate"])
        for data in reversed(self.advice):
            if data[16:24] != session or answer not in data:  # (the same, but faster)
                continue
            try:
                advice = wire.decode("advice", data)
            except ValueError:
                continue
            if (advice["advisor"] == message["source"]
                    and all(advice[name] == message["source_" + name]
                            for name in ("session", "attempt", "candidate"))
                    and all(advice[name] == message[name] for name in
                            ("request_id", "map_id", "baseline_digest"))
                    and self._cells_of(advice) == cells):
                return True
        return False

    def _cells_of(self, advice):
        waypoints = list(zip(advice["waypoint_x"], advice["waypoint_y"]))
        if advice["kind"] != 2 or len(waypoints) < 2:
            return None
        driven = []
        if advice["anchor_index"]:
            whole = self.routes.get((advice["anchor_session"], advice["anchor_route_seq"]), [])
            driven = whole[:advice["anchor_index"]]
        return driven + field.raster(waypoints)

    def _violation(self, message, what):
        self.violations.append(f"invariant {what} (decision {message['decision']}, "
                               f"request {message['request_id']})")

    # ---- The end ----

    def finish(self, now_ns, overflown, limit_s):
        self.counts["advice_not_heard"] = sum(not self._said(*one) for one in self.unproven)
        for (request_id, _), ns in self.waiting.items():
            if (now_ns - ns) / 1e9 > limit_s:
                self.violations.append(f"invariant 1: a valid baseline of request {request_id}, "
                                       f"and no route after {(now_ns - ns) / 1e9:.1f} s")
        return {"counts": dict(self.counts), "latencies_s": self.latencies,
                "requests": len({request for request, _ in self.served}),
                "overflown": overflown,
                "slow": self.slow, "violations": self.violations}


class Wrong(Exception):
    pass


def require(holds, what):
    if not holds:
        raise Wrong(what)


class SendOrder:
    """Messages in the order in which they were sent.

    A sender's datagram reaches one socket after the other. When the machine
    takes the processor away in between, a process that has it already answers
    before the observer has it. The kernel's stamp is of the sending, so the
    observer waits a little and goes by the stamps.
    """

    WAIT_NS = 200_000_000

    def __init__(self):
        self._held = []  # (ns, number, message), a heap
        self._numbers = itertools.count()

    def add(self, heard):
        heapq.heappush(self._held, (heard.ns, next(self._numbers), heard))

    def until(self, ns):
        """Yields what was sent by then."""
        while self._held and self._held[0][0] <= ns:
            yield heapq.heappop(self._held)[2]


def listen(port, observer):
    """Until SIGTERM. Returns (now, what was lost for want of room)."""
    deployed, advice = bus.Tap(port), bus.Tap(port + 1)
    in_send_order = SendOrder()
    ended = []
    signal.signal(signal.SIGTERM, lambda *_: ended.append(True))
    print("listening", flush=True)
    last_ns = 0
    while not ended:
        select.select([deployed, advice], [], [], 0.05)
        for heard in deployed.heard():
            in_send_order.add(heard)
        for heard in in_send_order.until(time.time_ns() - SendOrder.WAIT_NS):
            last_ns = heard.ns
            observer.hear(heard)
        observer.hear_advice(advice.heard(200))
    observer.hear_advice(advice.heard(QUEUED_ADVICE))
    for heard in deployed.heard(QUEUED_ADVICE):
        in_send_order.add(heard)
    for heard in in_send_order.until(time.time_ns()):
        last_ns = heard.ns
        observer.hear(heard)
    return last_ns, deployed.overflown + advice.overflown


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--fields", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--limit", type=float, default=1.0)
    arguments = parser.parse_args()
    with open(arguments.fields, encoding="ascii") as rows:
        observer = Observer([field.Field(one) for one in json.load(rows)])
    now_ns, overflown = listen(arguments.port, observer)
    with open(arguments.out, "w", encoding="ascii") as report:
        json.dump(observer.finish(now_ns, overflown, arguments.limit), report)


if __name__ == "__main__":
    main()
