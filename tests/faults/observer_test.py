"""The observer finds each violation that it is there for, and no other."""

import decimal
import random
import unittest

import faults  # (finds the modules of tests/soak)
import bus
import exact
import field
import observer
import wire

assert faults.PATHS

ROWS = [[0, 0, 0, 0], [0, 6, 6, 0], [0, 5, 5, 0], [0, 0, 0, 0]]
START, GOAL = (0, 2), (3, 2)
DEAR = [START, GOAL]  # 8 + 8 + 1
CHEAP = [START, (1, 3), (2, 3), GOAL]  # sqrt 2 + 1 + sqrt 2


def header():
    message = {"map_revision": 1, "width": 4, "height": 4, "num_terrains": len(field.COSTS),
               "terrain_id": list(range(len(field.COSTS))), "terrain_cost": field.COSTS,
               "terrain_rgb": [0] * len(field.COSTS), "terrain_name": ["x"] * len(field.COSTS),
               "corner_cutting": 1, "clearance_cells": 0, "tile_side": 4, "num_tiles": 1}
    message["tile_digest"] = exact.tile_digests(field.Field(ROWS), 4)
    return message | {"map_id": exact.map_id(message)}


MAP = header()["map_id"]
ENDS = {"start_x": START[0], "start_y": START[1], "goal_x": GOAL[0], "goal_y": GOAL[1]}


def points(waypoints):
    return {"num_waypoints": len(waypoints), "waypoint_x": [x for x, _ in waypoints],
            "waypoint_y": [y for _, y in waypoints]}


def baseline(waypoints=DEAR, request=1):
    return ENDS | points(waypoints) | {
        "request_id": request, "map_id": MAP, "status": 1,
        "baseline_digest": exact.baseline_digest(request, MAP, waypoints)}


def deployed(decision, waypoints, mode, **changes):
    cells = field.raster(waypoints)
    steps = [field.STEPS.index((x1 - x0, y1 - y0))
             for (x0, y0), (x1, y1) in zip(cells, cells[1:])] + [0]
    cost = exact.route_cost(field.Field(ROWS), cells)
    return ENDS | points(waypoints) | {
        "session": 9, "decision": decision, "route_seq": decision, "request_id": 1, "map_id": MAP,
        "mode": mode, "baseline_digest": baseline()["baseline_digest"], "source": "a",
        "source_session": 5, "source_attempt": 3, "source_candidate": 1,
        "num_steps": len(cells) - 1, "num_chain_bytes": len(cells) // 2,
        "chain": bytes(steps[i] | steps[i + 1] << 4 for i in range(0, len(cells) // 2 * 2, 2)),
        "deployed_cost": cost.value() if cost else 0.0} | changes


def advice(waypoints=CHEAP):
    return points(waypoints) | {
        "session": 5, "request_id": 1, "map_id": MAP, "advisor": "a", "attempt": 3, "candidate": 1,
        "baseline_digest": baseline()["baseline_digest"], "kind": 2}


ACCEPTS = {"session": 9, "decision": 2, "code": 1, "advisor": "a", "advisor_session": 5,
           "attempt": 3, "candidate": 1}


def seen(*messages, overflown=0):
    """What the observer says of (channel, message), 10 ms apart."""
    one = observer.Observer([field.Field(ROWS)])
    ns = 0
    for ns, (name, message) in enumerate([("map_header", header()), *messages], 1):
        heard = bus.Heard(ns * 10_000_000, "TERRA_" + name.upper(), wire.encode(name, message))
        if name == "advice":
            one.hear_advice([heard])
        else:
            one.hear(heard)
    return one.finish(ns * 10_000_000, overflown, 0.05)


GOOD = [("baseline", baseline()), ("deployed", deployed(1, DEAR, 1)), ("advice", advice()),
        ("verdict", ACCEPTS), ("deployed", deployed(3, CHEAP, 2))]


class Observer(unittest.TestCase):
    def violation(self, *messages):
        found = seen(*messages)["violations"]
        self.assertEqual(len(found), 1, found)
        return found[0]

    def test_a_good_run_has_no_violation(self):
        report = seen(*GOOD, GOOD[-1])
        self.assertEqual(report["violations"], [])
        self.assertEqual(report["counts"]["judged"], 2)
        self.assertEqual(report["counts"]["candidates"], 1)

    def test_1_a_baseline_without_a_route(self):
        asked = {"request_id": 2, "action": 1}
        again = baseline(request=2)
        later = [("map_header", header())] * 10
        self.assertIn("invariant 1", self.violation(*GOOD, ("plan_request", asked),
                                                    ("baseline", again), *later))

    def test_2_infeasible_routes(self):
        for changes, said in (({"map_id": 4}, "nobody serves"), ({"start_x": 1}, "the start"),
                              ({"goal_y": 0}, "the goal"), ({"deployed_cost": 1.0}, "says 1.0")):
            with self.subTest(said):
                self.assertIn(said, self.violation(GOOD[0], ("deployed",
                                                             deployed(1, DEAR, 1, **changes))))
        blocked = [START, (1, 1), (2, 1), GOAL]
        self.assertIn("not feasible", self.violation(GOOD[0], ("deployed",
                                                               deployed(1, blocked, 1))))

    def test_3_a_candidate_no_cheaper_than_the_baseline(self):
        self.assertIn("invariant 3", self.violation(
            ("baseline", baseline()), ("advice", advice(DEAR)), ("verdict", ACCEPTS),
            ("deployed", deployed(3, DEAR, 2))))

    def test_4_a_cost_that_rises(self):
        self.assertIn("invariant 4", self.violation(*GOOD, ("deployed", deployed(4, DEAR, 1))))

    def test_5_a_route_that_no_planner_said(self):
        self.assertIn("no planner said it", self.violation(
            GOOD[0], ("deployed", deployed(1, CHEAP, 1))))

    def test_5_a_candidate_that_no_verdict_accepted(self):
        first = ("deployed", deployed(2, DEAR, 1))
        self.assertIn("no verdict", self.violation(
            GOOD[0], first, GOOD[2], ("deployed", deployed(3, CHEAP, 2))))

    def test_5_a_candidate_that_no_advisor_said_is_counted(self):
        for other in (None, advice([START, (1, 3), (3, 3), GOAL]), advice() | {"request_id": 7}):
            said = [("advice", other)] if other else []
            report = seen(*GOOD[:2], *said, *GOOD[3:])
            self.assertEqual(report["counts"]["advice_not_heard"], 1)

    def test_one_decision_is_one_route(self):
        changed = deployed(3, CHEAP, 2) | {"source_attempt": 4}
        self.assertIn("two routes", self.violation(*GOOD, ("deployed", changed)))

    def test_messages_are_judged_in_the_order_of_their_sending(self):
        in_send_order = observer.SendOrder()
        heard = [bus.Heard(ns, name, b"") for ns, name in
                 ((30, "deployed"), (20, "baseline"), (20, "again"), (90, "later"))]
        for one in heard:
            in_send_order.add(one)
        self.assertEqual([one.channel for one in in_send_order.until(89)],
                         ["baseline", "again", "deployed"])
        self.assertEqual([one.channel for one in in_send_order.until(90)], ["later"])


class ExactCost(unittest.TestCase):
    def test_order_is_that_of_the_numbers(self):
        decimal.getcontext().prec = 60
        generator = random.Random(1)
        for _ in range(2_000):
            one, two = [exact.Cost(generator.randrange(200_000), generator.randrange(200_000))
                        for _ in range(2)]
            values = [cost.straight + cost.diagonal * decimal.Decimal(2).sqrt()
                      for cost in (one, two)]
            self.assertEqual(one < two, values[0] < values[1])

    def test_nearly_equal_costs(self):
        # 8119 / 5741 is a convergent of sqrt 2, from below; 3363 / 2378 from above.
        self.assertTrue(exact.Cost(8119, 0) < exact.Cost(0, 5741))
        self.assertFalse(exact.Cost(3363, 0) < exact.Cost(0, 2378))


if __name__ == "__main__":
    unittest.main()
