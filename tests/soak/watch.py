"""Asks for routes, drives, and judges what the gate deploys."""

import math
import random
import time

import field
import lcm_bus

EPSILON = 1e-6
ROUTE_WITHIN_S = 15.0  # of a request, whatever happens meanwhile
ASK_EVERY_S = 0.2
POSE_EVERY_S = 0.1
CELLS_PER_POSE = 2
BASELINE, CANDIDATE = 1, 2  # modes with a route


def _same_cost(own, said):
    """A route that cannot be driven costs no number on the bus."""
    return math.isnan(said) if math.isinf(own) else abs(own - said) <= EPSILON


class Request:
    def __init__(self, number, ends, now):
        self.number, self.ends, self.asked = number, ends, now
        self.routed = None  # when its route was heard
        # As their senders stamped them, microseconds: first BASELINE and first
        # DEPLOYED with a route.
        self.planned_us = self.routed_us = None
        self.seen = set()  # (message, status or mode) heard for it


class Watch:
    """The requester, the robot and the observer of a soak. One thread."""

    def __init__(self, peer, fields_by_id, journeys, seed):
        self._peer = peer
        self._fields = fields_by_id
        self._journeys = journeys
        self._random = random.Random(f"{seed} requests")
        self._types = {"TERRA_" + name.upper(): lcm_bus.message_type(name + "_t")
                       for name in ("baseline", "deployed", "status")}
        self._types["TERRA_VERDICT"] = lcm_bus.message_type("verdict_t")
        self._ask_at = self._pose_at = 0.0
        self._request = None
        self._next_request_at = 0.0
        self._baselines = {}  # digest: cells
        self._in_force = {}  # gate session: the DEPLOYED last judged
        self._driven = (None, [], 0)  # route, its cells, where the robot is
        self.states = {}  # process: state last heard
        self.requests = []
        self.unserved = []
        self.violations = []
        self.deployed_checked = 0
        self.candidates = 0
        self.unknown_baselines = 0
        self.verdicts = {}
        self.poses = 0

    # ---- What is said ----

    def advance(self, now):
        """Says what is due; returns when to be called again."""
        if now >= self._next_request_at:
            self._ask_anew(now)
        request = self._request
        if not request.routed and now - request.asked > ROUTE_WITHIN_S:
            self.unserved.append(self._story(request))
            self._ask_anew(now)
        if now >= self._ask_at:
            self._ask_at = now + ASK_EVERY_S
            self._ask()
        if now >= self._pose_at:
            self._pose_at = now + POSE_EVERY_S
            self._drive()
        return min(self._ask_at, self._pose_at)

    def _ask_anew(self, now):
        ends = self._random.choice(self._journeys)
        self._request = Request(self._random.getrandbits(62) | 1, ends, now)
        self.requests.append(self._request)
        self._next_request_at = now + ROUTE_WITHIN_S + self._random.uniform(0, 5)
        self._ask_at = now

    def _ask(self):
        # Repeated all the time: planner and gate may die together.
        message = lcm_bus.message_type("plan_request_t")()
        message.request_id, message.action = self._request.number, message.ACTION_GO
        (message.start_x, message.start_y), (message.goal_x, message.goal_y) = self._request.ends
        self._peer.say("TERRA_PLAN_REQUEST", message)

    def _drive(self):
        route, cells, at = self._driven
        if route is None:
            return
        at = min(at + CELLS_PER_POSE, len(cells) - 1)
        self._driven = (route, cells, at)
        message = lcm_bus.message_type("pose_t")()
        message.pose_x, message.pose_y = cells[at]
        message.deployed_session, message.deployed_route_seq = route
        self._peer.say("TERRA_POSE", message)
        self.poses += 1

    def _story(self, request):
        return {"request": request.number, "ends": request.ends, "asked": request.asked,
                "heard": sorted(request.seen), "states": dict(self.states)}

    # ---- What is heard ----

    def hear(self, now):
        for channel, data in self._peer.heard():
            kind = self._types.get(channel)
            if kind:
                getattr(self, "_hear_" + channel[6:].lower())(kind.decode(data), now)

    def _hear_status(self, message, _now):
        self.states[message.status_name] = message.state

    def _hear_verdict(self, message, _now):
        self.verdicts[message.code] = self.verdicts.get(message.code, 0) + 1

    def _hear_baseline(self, message, _now):
        request = self._request
        if message.request_id == request.number:
            request.seen.add(("BASELINE", message.status))
            if message.status == message.STATUS_OK:
                request.planned_us = request.planned_us or message.utime
        if message.status == message.STATUS_OK and message.baseline_digest not in self._baselines:
            self._baselines[message.baseline_digest] = field.raster(
                list(zip(message.waypoint_x, message.waypoint_y)))

    def _hear_deployed(self, message, now):
        request = self._request
        has_route = message.mode in (BASELINE, CANDIDATE)
        if message.request_id == request.number:
            request.seen.add(("DEPLOYED", message.mode))
            if has_route and not request.routed:
                request.routed, request.routed_us = now, message.utime
                self._next_request_at = now + self._random.uniform(2, 8)
        before = self._in_force.get(message.session)
        if before and before.decision == message.decision:
            return
        self._in_force[message.session] = message
        if has_route:
            self._judge(message, before)
            self._follow(message)

    def _follow(self, message):
        cells = self._cells(message)
        driven, old_cells, at = self._driven
        same_way = driven and cells[:at + 1] == old_cells[:at + 1]
        self._driven = ((message.session, message.route_seq), cells, at if same_way else 0)

    @staticmethod
    def _cells(message):
        return field.chain_cells((message.waypoint_x[0], message.waypoint_y[0]),
                                 message.num_steps, message.chain)

    # ---- The invariants (docs/gate.md, 2 to 4), by the watch's own sums ----

    def _judge(self, message, before):
        self.deployed_checked += 1
        self.candidates += message.mode == CANDIDATE
        wrong = self._wrong_with(message, before)
        if wrong:
            self.violations.append({"decision": message.decision, "session": message.session,
                                    "what": wrong, "unix_s": time.time()})

    def _wrong_with(self, message, before):
        known = self._fields.get(message.map_id)
        if known is None:
            return "an unknown map"
        cells = self._cells(message)
        if cells[0] != (message.start_x, message.start_y):
            return "does not begin at the start"
        if cells[-1] != (message.goal_x, message.goal_y):
            return "does not end at the goal"
        cost = known.route_cost(cells)
        if not abs(cost - message.deployed_cost) <= EPSILON:
            return f"costs {cost}, says {message.deployed_cost}"
        baseline = self._baselines.get(message.baseline_digest)
        if baseline is None:
            self.unknown_baselines += 1  # its message was lost, or is not here yet
        elif not _same_cost(known.route_cost(baseline), message.baseline_cost):
            # On the map in force, which may not be the one it was planned on.
            return f"the baseline costs {known.route_cost(baseline)}, says {message.baseline_cost}"
        if cost > message.baseline_cost + EPSILON:
            return f"costs {cost}, the baseline {message.baseline_cost}"
        same = before and (before.request_id, before.map_id) == (message.request_id, message.map_id)
        if same and before.mode in (BASELINE, CANDIDATE) and cost > before.deployed_cost + EPSILON:
            return f"the cost rose from {before.deployed_cost} to {cost}"
        return None
