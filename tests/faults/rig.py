"""What each row stands on: the set as real processes, a requester, an observer.

A row runs in a sandbox of its own (network, mounts and process ids), so the
port is always the same and all of it ends with the row.
"""
import contextlib
import functools
import json
import multiprocessing
import os
import pathlib
import random
import select
import signal
import subprocess
import sys
import time

import bus
import field
import fleet

PORT = 7667
ASK_EVERY_S = 0.2
STAND_INS = {"second": "verifier", "small": "verifier"}  # whose part they play
SET = ("map", "planner", "verifier")
HERE = pathlib.Path(__file__).resolve().parent


class Failed(Exception):
    """The row saw what must not be."""


def require(holds, what):
    if not holds:
        raise Failed(what)


def url(port):
    return f"udpm://239.255.76.67:{port}?ttl=0&recv_buf_size=2097152"


class Rig:
    """The set, the requester, the robot. One thread."""

    def __init__(self, folder, bin_folder, seed=1, flaw=""):
        self.folder, self.bin, self.flaw = folder, bin_folder, flaw
        self.random = random.Random(f"{seed} row")
        one, other = field.two_fields(seed)
        self.fields = [one, _dearer(other), _walled(one)]
        self.legend, self.map = folder / "legend.csv", folder / "map.png"
        field.write_legend(self.legend)
        self.paths = [folder / f"map-{i}.png" for i in range(len(self.fields))]
        for one, path in zip(self.fields, self.paths):
            one.save(path)
        self.journeys = field.journeys(self.bin / "terra", self.paths[:2], self.legend, seed, 8)
        self.show_map(0)
        self.log = folder / "log"
        self.processes = {}
        self._define()
        self.deployed_bus, self.advice_bus = bus.Tap(PORT), bus.Tap(PORT + 1)
        self.status = {}  # name: STATUS last heard
        self.baseline = self.deployed = None  # last heard
        self.verdicts, self.advice = [], []
        self.raw = {}  # channel: the last bytes on it
        self.map_id = 0  # of the last header
        self.ends = None
        self.request_id = 0
        self._journey = 0
        self.injected = 0
        self._observe()

    # ---- Processes ----

    def _define(self):
        self.define("map", "terra-map", "--map", self.map, "--legend", self.legend)
        self.define("planner", "terra-planner", "--stride", field.STRIDE)
        self.define("verifier", "terra-verifier")
        self.define("logger", "terra-logger", "--out", self.log)
        self.define("searcher", "terra-advisor", "--name", "searcher")
        self.define("cutter", "terra-advisor", "--name", "cutter", "--backend", "shortcut")

    def define(self, name, program, *options, port=PORT, before=()):
        """How a process is started; `before` goes in front of its command."""
        command = [*before, self.bin / program, "--lcm-url", url(port),
                   "--advice-url", url(port + 1), *options]
        if self.flaw.startswith(name + ":"):
            command = [*before, *self._broken(name, self.flaw.partition(":")[2], options)]
        self.processes[name] = fleet.Process(name, command, self.folder)

    def _broken(self, name, flaw, options):
        script = STAND_INS.get(name, name) + ".py"
        return [sys.executable, HERE / "flawed" / script, flaw,
                self.folder / "fields.json", *options, "--terra", self.bin / "terra"]

    def __getitem__(self, name):
        return self.processes[name]

    def start(self, *names):
        for name in names:
            self[name].start()

    def set_up(self, *more):
        """Starts the set and serves a first route."""
        self.start(*SET, *more)
        self.serve(within=10)
        for name in (*SET, *more):
            self.await_(lambda: name in self.status, 5, f"no heartbeat of {name}")

    def revive(self, *names):
        """What a supervisor does (systemd: Restart=always)."""
        if self.flaw != "nobody restarts":
            self.start(*names)

    def run(self, *command, **options):
        return subprocess.run([str(part) for part in command], capture_output=True, check=False,
                              text=True, timeout=60, **options)

    def show_map(self, number):
        self.fields[number].save(self.map)

    # ---- The bus ----

    def hear(self, seconds=0.0):
        until = time.monotonic() + seconds
        while True:
            left = until - time.monotonic()
            select.select([self.deployed_bus, self.advice_bus], [], [], max(0.0, min(left, 0.05)))
            for heard in self.deployed_bus.heard():
                message = bus.decode(heard)
                if message is not None:
                    self.raw[heard.channel] = heard.data
                self._take(heard.channel, message)
            for heard in self.advice_bus.heard(100):
                if heard.channel in ("TERRA_ADVICE", "TERRA_STATUS"):
                    self._take(heard.channel, bus.decode(heard))
            if left <= 0:
                return

    def _take(self, channel, message):
        if message is None:
            return
        if channel == "TERRA_STATUS":
            message["counters"] = dict(zip(message["counter_name"], message["counter_value"]))
            self.status[message["status_name"]] = message
        elif channel == "TERRA_MAP_HEADER":
            self.map_id = message["map_id"]
        elif channel == "TERRA_BASELINE":
            self.baseline = message
        elif channel == "TERRA_DEPLOYED":
            self.deployed = message
        elif channel == "TERRA_VERDICT":
            self.verdicts.append(message)
        elif channel == "TERRA_ADVICE":
            self.advice = self.advice[-500:] + [message]

    def await_(self, holds, within, what):
        until = time.monotonic() + within
        while not holds():
            if time.monotonic() > until:
                raise Failed(f"{what}: not within {within:g} s{self._dead()}")
            self.hear(0.005)

    def _dead(self):
        return "".join(f"; {name} ended with {one.exit_code()}: {one.last_words()[-200:]}"
                       for name, one in self.processes.items()
                       if one.lives and not one.running())

    def counter(self, process, name):
        message = self.status.get(process)
        return message["counters"].get(name, 0) if message else 0

    def alive(self, *names):
        for name in names:
            require(self[name].running(), f"{name} ended{self._dead()}")

    # ---- The requester ----

    def ask(self, ends=None):
        """A new request, said once."""
        self.ends = ends or self.journeys[self._journey % len(self.journeys)]
        self._journey += 1
        self.request_id = self.random.getrandbits(62) | 1
        self.repeat_request()

    def repeat_request(self):
        (start_x, start_y), (goal_x, goal_y) = self.ends
        self.deployed_bus.say("TERRA_PLAN_REQUEST", {
            "request_id": self.request_id, "action": 1, "start_x": start_x,
            "start_y": start_y, "goal_x": goal_x, "goal_y": goal_y})

    def has_route(self, modes=(1, 2)):
        return (self.deployed is not None and self.deployed["request_id"] == self.request_id
                and self.deployed["mode"] in modes)

    def has_baseline(self):
        return self.baseline is not None and self.baseline["request_id"] == self.request_id

    def serve(self, within=2.0, ends=None):
        """Asks as a requester does, until baseline and route are heard."""
        self.ask(ends)
        self.await_served(within)

    def await_served(self, within=2.0):
        until, again = time.monotonic() + within, time.monotonic() + ASK_EVERY_S
        while not (self.has_route() and self.has_baseline()):
            now = time.monotonic()
            require(now < until, f"request {self.request_id} has no route after {within:g} s"
                                 f"{self._dead()}")
            if now >= again:
                self.repeat_request()
                again = now + ASK_EVERY_S
            self.hear(0.002)

    def await_candidate(self, within=4.0, what="no advisor's route came into force"):
        self.await_(lambda: self.has_route((2,)), within, what)

    # ---- An advisor of the row's own ----

    @functools.lru_cache(maxsize=None)
    def optimum(self, ends, number=0):
        (start, goal) = ends
        done = self.run(self.bin / "terra", "oracle", "--map", self.paths[number], "--legend",
                        self.legend, "--start", "{},{}".format(*start), "--goal",
                        "{},{}".format(*goal), "--json")
        return [tuple(cell) for cell in json.loads(done.stdout)["waypoints"]]

    def advice_for(self, baseline, waypoints, attempt, **changes):
        (x, y) = waypoints[0]
        return {"request_id": baseline["request_id"], "map_id": baseline["map_id"],
                "baseline_digest": baseline["baseline_digest"], "anchor_x": x, "anchor_y": y,
                "advisor": "row", "attempt": attempt, "candidate": 1, "kind": 2, "form": 1,
                "num_waypoints": len(waypoints), "waypoint_x": [x for x, _ in waypoints],
                "waypoint_y": [y for _, y in waypoints]} | changes

    def advise(self, baseline, waypoints, attempt, **changes):
        self.advice_bus.say("TERRA_ADVICE",
                            self.advice_for(baseline, waypoints, attempt, **changes))
        self.injected += 1

    def verdict_on(self, attempt, advisor="row", within=2.0):
        def found():
            return [one for one in self.verdicts
                    if (one["advisor"], one["attempt"]) == (advisor, attempt)]
        self.await_(found, within, f"no verdict on attempt {attempt} of {advisor}")
        return found()[-1]["code"]

    # ---- Others ----

    @contextlib.contextmanager
    def relay(self, port, **misfortunes):
        """Between the buses at PORT and those at port, as processes. Only advice
        is corrupted: the deployed bus is trusted, and UDP has checksums."""
        ended = multiprocessing.Event()
        counts = multiprocessing.Manager().dict()

        def carry(base, key):
            chances = dict(misfortunes)
            if base == PORT:
                chances.pop("corrupt", None)
            relay = bus.Relay((base, base + port - PORT), seed=base, **chances)
            relay.run(ended.is_set)
            counts[key] = dict(relay.done)

        def told(one):
            return sum(n for what, n in one.items() if what != "carried" and " " not in what)

        ways = [multiprocessing.Process(target=carry, args=(base, base))
                for base in (PORT, PORT + 1)]
        for way in ways:
            way.start()
        try:
            yield counts
        finally:
            ended.set()
            for way in ways:
                way.join()
        self.injected += sum(told(one) for one in counts.values())

    def _observe(self):
        rows = [one.rows for one in self.fields]
        (self.folder / "fields.json").write_text(json.dumps(rows))
        self._observer = subprocess.Popen(
            [sys.executable, HERE / "observer.py", "--port", str(PORT), "--fields",
             self.folder / "fields.json", "--out", self.folder / "observed.json"],
            stdout=subprocess.PIPE, text=True)
        require(self._observer.stdout.readline() == "listening\n", "the observer does not start")

    def finish(self):
        """Ends all; what the observer saw."""
        for one in self.processes.values():
            if one.running():
                with contextlib.suppress(OSError):
                    os.kill(one.pid, signal.SIGCONT)
                one.kill()
        self._observer.terminate()
        self._observer.wait(60)
        return json.loads((self.folder / "observed.json").read_text())


def _dearer(known):
    """The same map with more to pay for its commonest terrain: no route costs
    there what it costs here."""
    return field.Field([[4 if terrain == 3 else terrain for terrain in row]
                        for row in known.rows])


def _walled(known):
    """The same map with a wall from top to bottom and one from left to right."""
    rows = [list(row) for row in known.rows]
    for row in rows:
        for x in (field.SIDE // 3, field.SIDE // 2, 2 * field.SIDE // 3):
            row[x:x + 2] = [field.BLOCKED] * 2
    for y in (field.SIDE // 3, field.SIDE // 2, 2 * field.SIDE // 3):
        for row in rows[y:y + 2]:
            row[:] = [field.BLOCKED] * len(row)
    return field.Field(rows)
