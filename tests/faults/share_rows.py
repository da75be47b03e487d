"""Who is judged, and how long a baseline waits, while others do all they may."""
import contextlib
import multiprocessing
import random
import select
import socket
import struct
import time

import bus
import exact
import field
import lcm_bus
import wire
from rig import PORT, require
from rows import row

PATIENCE_S = 3.0  # an honest proposal is judged within so long
FLOOD_PER_S = 1_000
LARGE_PORT = PORT + 20
LARGE_SIDE = 8_192
P99_MS, WORST_MS = 5.0, 15.0


# ---- Fair shares ----

def zigzag(start, goal, side, steps):
    """Waypoints of a route of so many steps, to and fro across the map."""
    (x, y), route = start, [start]
    far = 0
    while steps > far + 2 * side:
        next_x = side - 1 if x < side // 2 else 0
        route.append((next_x, y))
        far += abs(next_x - x)
        x = next_x
    return [*route, goal]


class Speaker:
    """Sends advice from a port of its own, and does not listen: hundreds of
    listeners would cost the machine more than what is measured."""

    def __init__(self, port):
        self._address = (lcm_bus.GROUP, port)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self._sent = 0

    def say(self, advice):
        self._sent += 1
        self._socket.sendto(struct.pack(">II", lcm_bus.SHORT, self._sent)
                            + b"TERRA_ADVICE\0" + advice, self._address)


def flood(speakers, template, marker, first, ended):
    """New advice, dear to judge, from all these ports in turn, until it ends."""
    begin, sent = time.monotonic(), 0
    while not ended.is_set():
        while sent < FLOOD_PER_S * (time.monotonic() - begin):
            attempt = first + sent
            speakers[sent % len(speakers)].say(template.replace(marker, attempt.to_bytes(8, "big")))
            sent += 1
        time.sleep(0.005)


def judged_in_a_flood(rig, speakers, attempt):
    """The seconds until the verdict on an honest proposal, said at 1 Hz."""
    rig.serve()
    route = rig.optimum(rig.ends)
    hostile = zigzag(*rig.ends, field.SIDE, 75_000)
    marker = 0x7E57_0000_7E57
    template = wire.encode("advice", rig.advice_for(
        rig.baseline, hostile, marker, advisor="hostile", session=99))
    ended = multiprocessing.Event()
    flooder = multiprocessing.Process(
        target=flood, args=(
            speakers, template, marker.to_bytes(8, "big"), attempt << 40, ended), daemon=True)
    flooder.start()
    try:
        rig.hear(3.0)  # all queues are full
        begin = time.monotonic()
        for _ in range(int(PATIENCE_S)):
            rig.advise(rig.baseline, route, attempt)
            until = time.monotonic() + 1
            while time.monotonic() < until:
                rig.hear(0.02)
                if any((one["advisor"], one["attempt"]) == ("row", attempt)
                       for one in rig.verdicts):
                    return time.monotonic() - begin
        return None
    finally:
        ended.set()
        flooder.join()
        rig.injected += FLOOD_PER_S * 3


def starver(ports):
    @row(f"an honest advisor among {ports} hostile ports, 1,000 datagrams a second",
         "GATE 8; LCM floods", [], lossy=True)
    def starve(rig):
        rig.set_up()
        speakers = [Speaker(PORT + 1) for _ in range(ports)]
        waits = [judged_in_a_flood(rig, speakers, attempt) for attempt in (1, 2, 3)]
        served = sum(wait is not None for wait in waits)
        rig.hear(1.1)
        counts = {name: value for name, value in rig.status["verifier"]["counters"].items()
                  if "advice" in name or name == "judged"}
        require(served == len(waits), f"{served} of {len(waits)} honest proposals are judged "
                                      f"within {PATIENCE_S:g} s ({counts})")
        return f"{served} of {len(waits)} judged, the last after {max(waits):.2f} s"


starver(20)
starver(200)
starver(256)


@row("a copied attempt number: one `retain` before each proposal", "GATE 10; LCM lies",
     ["verifier:by-attempt"])
def copied_attempt(rig):
    rig.set_up()
    copier = Speaker(PORT + 1)
    for attempt in range(1, 6):
        rig.serve()
        advice = rig.advice_for(rig.baseline, rig.optimum(rig.ends), attempt)
        retain = dict(advice, kind=1, num_waypoints=0, waypoint_x=[], waypoint_y=[],
                      session=rig.advice_bus.session)
        copier.say(wire.encode("advice", retain))
        rig.await_(lambda: (2, attempt) in codes(rig), 2, "the copy has no verdict")
        rig.advise(rig.baseline, rig.optimum(rig.ends), attempt)
        rig.await_(lambda: (1, attempt) in codes(rig), 2, "the proposal has no verdict")
        rig.await_candidate()
    return "5 of 5 proposals are judged and deployed all the same"


def codes(rig):
    return {(one["code"], one["attempt"]) for one in rig.verdicts}


# ---- The deployed path ----

class Large:
    """A gate on a map of the largest size; the row is its planner."""

    def __init__(self, rig):
        self._rig, self._random = rig, random.Random(1)
        path = rig.folder / "large.png"
        field.Field([bytes([1]) * LARGE_SIDE] * LARGE_SIDE).save(path)
        rig.define("large-map", "terra-map", "--map", path, "--legend", rig.legend,
                   port=LARGE_PORT)
        rig.define("large-gate", "terra-verifier", "--name", "large-gate", port=LARGE_PORT)
        self._tap = bus.Tap(LARGE_PORT)
        self._advisors = [Speaker(LARGE_PORT + 1) for _ in range(10)]
        self.ends = ((3, 5), (LARGE_SIDE - 3, LARGE_SIDE - 9))
        self.map_id, self.request_id, self._attempt = 0, 0, 0
        self._digest = 0
        self._said_ns = None
        self._answered = False
        self.latencies_ms, self.judging_ms = [], []
        rig.start("large-map", "large-gate")
        until = time.monotonic() + 60
        while not self._answered:
            require(time.monotonic() < until, "the large map is not served within 60 s")
            self.plan()
            self.hear(0.3)
        self.latencies_ms.clear()

    def plan(self):
        """A new request and its baseline."""
        ((x, y), (goal_x, goal_y)) = self.ends
        self.request_id = self._random.getrandbits(62) | 1
        self._digest = exact.baseline_digest(self.request_id, self.map_id, list(self.ends))
        self._said_ns, self._answered = None, False
        ends = {"request_id": self.request_id, "start_x": x, "start_y": y, "goal_x": goal_x,
                "goal_y": goal_y}
        self._tap.say("TERRA_PLAN_REQUEST", dict(ends, action=1))
        self._tap.say("TERRA_BASELINE", dict(
            ends, map_id=self.map_id, planner="row", status=1, baseline_digest=self._digest,
            num_waypoints=2, waypoint_x=[x, goal_x], waypoint_y=[y, goal_y]))

    def hear(self, seconds):
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            select.select([self._tap], [], [], left)
            for heard in self._tap.heard():
                self._take(heard)

    def _take(self, heard):
        if heard.channel not in ("TERRA_MAP_HEADER", "TERRA_BASELINE", "TERRA_DEPLOYED",
                                 "TERRA_VERDICT"):
            return
        message = bus.decode(heard)
        if heard.channel == "TERRA_VERDICT":
            self.judging_ms.append(message["t_det_us"] / 1e3)
        elif heard.channel == "TERRA_MAP_HEADER":
            self.map_id = message["map_id"]
        elif message["request_id"] == self.request_id:
            if heard.channel == "TERRA_BASELINE":
                self._said_ns = heard.ns
            elif message["mode"] == 1 and self._said_ns and not self._answered:
                self._answered = True
                self.latencies_ms.append((heard.ns - self._said_ns) / 1e6)

    def burst(self, count):
        """The dearest advice that is legal, on what is in force."""
        (x, y), _ = self.ends
        route = zigzag(*self.ends, LARGE_SIDE, 75_000)
        for number in range(count):
            self._attempt += 1
            self._advisors[number % len(self._advisors)].say(wire.encode("advice", {
                "request_id": self.request_id, "map_id": self.map_id,
                "baseline_digest": self._digest, "anchor_x": x, "anchor_y": y,
                "advisor": "dear", "attempt": self._attempt, "candidate": 1, "kind": 2,
                "form": 1, "num_waypoints": len(route), "waypoint_x": [x for x, _ in route],
                "session": 1 + number % len(self._advisors),
                "waypoint_y": [y for _, y in route]}))

    @contextlib.contextmanager
    def _busy(self, size):
        """A broken gate looks at nothing else for a moment after a burst."""
        broken = size > 0 and self._rig.flaw == "gate:judges-it-all-first"
        if broken:
            self._rig["large-gate"].stop()
        yield
        if broken:
            time.sleep(0.03)
            self._rig["large-gate"].resume()

    def phase(self, bursts, size):
        """Four bursts a second, and into each a new baseline. Sorted latencies."""
        self.latencies_ms.clear()
        for _ in range(bursts):
            begin = time.monotonic()
            self.burst(size)
            self.hear(self._random.uniform(0, 0.004))
            with self._busy(size):
                self.plan()
            self.hear(begin + 0.25 - time.monotonic())
        require(len(self.latencies_ms) == bursts,
                f"{len(self.latencies_ms)} of {bursts} baselines are deployed")
        return sorted(self.latencies_ms)


def in_words(latencies):
    p99 = latencies[int(0.99 * (len(latencies) - 1))]
    return p99, f"p50 {latencies[len(latencies) // 2]:.1f}, p99 {p99:.1f}, max {latencies[-1]:.1f} ms"


@row("the dearest legal advice: 200 a second of 75,000 steps, 8192 x 8192 cells, in bursts",
     "GATE 8; LCM floods", ["gate:judges-it-all-first"], lossy=True)
def dearest_advice(rig):
    rig.set_up()
    rig.serve()  # (for the observer, which knows the small maps)
    for name in ("map", "planner", "verifier"):
        rig[name].kill()
    large = Large(rig)
    _, quiet = in_words(large.phase(60, 0))
    latencies = large.phase(120, 50)
    rig.injected += 120 * 50
    p99, dear = in_words(latencies)
    rig.alive("large-map", "large-gate")
    judging = sorted(large.judging_ms)
    require(len(judging) > 1_000, f"{len(judging)} proposals are judged")
    words = f"baseline to deployed {dear}; quiet {quiet}; one judgement {in_words(judging)[1]}"
    require(p99 <= P99_MS and latencies[-1] <= WORST_MS,
            f"{words}; allowed p99 {P99_MS:g}, max {WORST_MS:g} ms")
    return words
