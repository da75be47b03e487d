#!/usr/bin/env python3
"""Runs the whole set under random faults and judges what came of it.

usage: scripts/soak --minutes N --seed S [--keep DIR]
"""

import argparse
import json
import os
import pathlib
import platform
import random
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PORT = 7667  # in a network namespace of its own
SAMPLE_EVERY_S = 5.0
QUIET_S = 10.0  # without faults at the end, so that all is repeated


class Soak:
    def __init__(self, arguments, folder):
        self.seed = arguments.seed
        self.seconds = arguments.minutes * 60
        self.folder = folder
        self.bin = pathlib.Path(arguments.bin).resolve()
        self.port = arguments.port
        self.fields = field.two_fields(self.seed)
        self.peer = lcm_bus.Peer(self.port)
        self.usage = fleet.Usage()
        self.failures = []
        self.injected = {}
        self.exits = {}
        self.events = []  # what was done, for the story of a failure
        self._due = []  # (time, what, action): ends of faults
        self._map_now = 0
        self._processes = {}

    # ---- The set ----

    def _urls(self):
        url = "udpm://239.255.76.67:{}?ttl=0&recv_buf_size=2097152"
        return ["--lcm-url", url.format(self.port), "--advice-url", url.format(self.port + 1)]

    def _add(self, name, program, *options):
        command = [self.bin / program, *self._urls(), *options]
        self._processes[name] = fleet.Process(name, command, self.folder)

    def prepare(self):
        legend = self.folder / "legend.csv"
        field.write_legend(legend)
        paths = [self.folder / f"map-{i}.png" for i in range(2)]
        for one, path in zip(self.fields, paths):
            one.save(path)
        journeys = field.journeys(self.bin / "terra", paths, legend, self.seed, 30)
        served = self.folder / "map.png"
        self._add("map", "terra-map", "--map", served, "--legend", legend)
        self._add("planner", "terra-planner", "--stride", str(field.STRIDE))
        self._add("verifier", "terra-verifier")
        self._add("logger", "terra-logger", "--out", self.folder / "log", "--part-mb", "8")
        self._add("searcher", "terra-advisor", "--name", "searcher", "--backend", "search")
        self._add("cutter", "terra-advisor", "--name", "cutter", "--backend", "shortcut")
        self._add("chaos", "terra-chaos")
        by_id = {self._map_id_of(one, served): one for one in reversed(self.fields)}
        self.watch = watch.Watch(self.peer, by_id, journeys, self.seed)

    def _map_id_of(self, one, served):
        """Asks the map server itself: the id is its name for the map."""
        one.save(served)
        list(self.peer.heard())
        server = self._processes["map"]
        server.start()
        until = time.monotonic() + 20
        while time.monotonic() < until:
            select.select([self.peer], [], [], 0.1)
            for channel, data in self.peer.heard():
                if channel == "TERRA_MAP_HEADER":
                    server.terminate()
                    return lcm_bus.message_type("map_header_t").decode(data).map_id
        raise RuntimeError(f"no map header: {server.last_words()}")

    def start(self):
        generator = random.Random(f"{self.seed} first chaos")
        for name, process in self._processes.items():
            process.start(faults.chaos_options(generator) if name == "chaos" else ())
        self._chaos_options = ()

    # ---- The run ----

    def end_early(self, *_):
        """What was measured until now is judged."""
        self.seconds = time.monotonic() - self.begin

    def run(self):
        self.begin = time.monotonic()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self.end_early)
        plan = faults.planned(self.seed, self.seconds - QUIET_S)
        sample_at = self.begin
        while (now := time.monotonic()) < self.begin + self.seconds:
            while plan and plan[0].at <= now - self.begin:
                self._inject(plan.pop(0), now)
            for due in [due for due in self._due if due[0] <= now]:
                self._due.remove(due)
                due[1]()
            if now >= sample_at:
                sample_at = now + SAMPLE_EVERY_S
                self._look_after_all()
            next_at = self.watch.advance(now)
            select.select([self.peer], [], [], max(0.0, min(0.05, next_at - now)))
            self.watch.hear(time.monotonic())

    def _inject(self, fault, now):
        process = self._processes[fault.target]
        self._note(f"{fault.kind} {fault.target} {fault.seconds:.1f} s {' '.join(fault.options)}")
        kind = f"{fault.kind} {fault.target}" if fault.kind != fault.target else fault.kind
        self.injected[kind] = self.injected.get(kind, 0) + 1
        if fault.kind == "kill":
            process.kill()
            self._later(now + fault.seconds, process.start)
        elif fault.kind == "restart":
            self._take_exit(process, process.terminate())
            self._later(now + fault.seconds, process.start)
        elif fault.kind == "stop":
            process.stop()
            self._later(now + fault.seconds, process.resume)
        elif fault.kind == "chaos":
            self._take_exit(process, process.terminate())
            process.start(fault.options)
        elif fault.kind == "map":
            self._map_now = 1 - self._map_now
            self.fields[self._map_now].save(self.folder / "map.png")
        elif fault.kind == "full disk":
            process.limit_files(0)
            self._later(now + fault.seconds, lambda: process.limit_files(None))

    def _later(self, at, action):
        self._due.append((at, action))

    def _note(self, what):
        self.events.append((round(time.monotonic() - self.begin, 1), what))

    def _take_exit(self, process, code):
        key = f"{process.name} {code}"
        self.exits[key] = self.exits.get(key, 0) + 1
        if code != 0:
            self._note(f"{process.name} exited with {code}")
            self.failures.append(f"{process.name} exited with {code} when asked to end, "
                                 f"after {self.events[-6:]}: {process.last_words()}")

    def _look_after_all(self):
        pending = {action.__self__ for _, action in self._due if hasattr(action, "__self__")}
        for process in self._processes.values():
            if process.running():
                self.usage.sample(process)
            elif process not in pending:
                self._note(f"{process.name} died")
                self.failures.append(f"{process.name} ended by itself with "
                                     f"{process.exit_code()}: {process.last_words()}")
                process.start()

    def finish(self):
        for _, action in self._due:
            action()
        self._due = []
        for name in ("chaos", "searcher", "cutter", "verifier", "planner", "map", "logger"):
            self._take_exit(self._processes[name], self._processes[name].terminate())

    # ---- The judgement ----

    def judge(self):
        saw = self.watch
        rows, grown = judge.flatness(self.usage)
        audit, findings = judge.audit_logs(self.bin / "terra", self.folder / "log")
        self.failures += grown + findings
        self.failures += [f"DEPLOYED {one}" for one in saw.violations]
        self.failures += [f"no route within {watch.ROUTE_WITHIN_S:g} s: {self._told(one)}"
                          for one in saw.unserved]
        served = [one for one in saw.requests if one.routed]
        if not served or not saw.candidates:
            self.failures.append("nothing was served: the soak shows nothing")
        to_route = [one.routed - one.asked for one in served]
        # (A BASELINE may be heard late, or only its repetition.)
        from_baseline = [max(0, one.routed_us - one.planned_us) / 1e6
                         for one in served if one.planned_us]
        return {
            "seed": self.seed, "minutes": round(self.seconds / 60, 2), "machine": machine(),
            "requests": len(saw.requests), "served": len(served),
            "unserved": len(saw.unserved), "poses": saw.poses,
            "deployed_checked": saw.deployed_checked, "candidates": saw.candidates,
            "baselines_not_heard": saw.unknown_baselines,
            "verdicts_by_code": {str(k): v for k, v in sorted(saw.verdicts.items())},
            "violations": len(saw.violations), "faults": dict(sorted(self.injected.items())),
            "exits": dict(sorted(self.exits.items())), "usage": rows,
            "request_to_route_s": latencies(to_route),
            "baseline_to_route_s": latencies(from_baseline),
            "audit": audit, "failures": self.failures, "events": self.events}

    def _told(self, unserved):
        asked = unserved["asked"] - self.begin
        around = [event for event in self.events if asked - 10 <= event[0] <= asked + 15]
        return dict(unserved, asked=round(asked, 1), faults=around)


def latencies(seconds):
    return {key: None if not seconds else round(judge.percentile(seconds, share), 4)
            for key, share in (("median", 0.5), ("p95", 0.95), ("p99", 0.99), ("worst", 1.0))}


def machine():
    model = [line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="ascii")
             if line.startswith("model name")]
    return f"{len(os.sched_getaffinity(0))} cores of {model[0] if model else platform.machine()}"


def show(result):
    for key in ("seed", "minutes", "machine", "requests", "served", "unserved", "poses",
                "deployed_checked", "candidates", "violations"):
        print(f"{key:20} {result[key]}")
    print(f"{'faults':20} {sum(result['faults'].values())}: "
          + ", ".join(f"{times} {kind}" for kind, times in result["faults"].items()))
    for key in ("request_to_route_s", "baseline_to_route_s", "audit"):
        print(f"{key:20} " + ", ".join(f"{name} {value}" for name, value in result[key].items()))
    print(f"\n{'longest life of':16} {'s':>6} {'memory, kB':>26} {'fds':>12} {'threads':>12}"
          "   (first -> last; most)")
    for row in result["usage"]:
        print(f"{row['process']:16} {row['seconds']:6} "
              + " ".join(f"{row[key + '_first']:.0f} -> {row[key + '_last']:.0f}; "
                         f"{row[key + '_most']:.0f}".rjust(width)
                         for key, width in (("rss_kb", 26), ("fds", 12), ("threads", 12))))
    for failure in result["failures"]:
        print("FAILED:", failure)
    print("passed" if not result["failures"] else f"{len(result['failures'])} failures")


def in_own_network():
    """Goes on in a network namespace of its own, where that is allowed."""
    loopback = "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo"
    if subprocess.run(["unshare", "-n", "sh", "-c", loopback], check=False,
                      capture_output=True).returncode == 0:
        os.execvp("unshare", ["unshare", "-n", "sh", "-c", loopback + ' && exec "$@"', "soak",
                              sys.executable, *sys.argv, "--port", str(PORT)])


def parse():
    parser = argparse.ArgumentParser(description="Runs the whole set under random faults.")
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", help="folder for logs, output and soak.json")
    parser.add_argument("--bin", required=True, help="folder of the executables")
    parser.add_argument("--types", required=True, help="folder of the generated Python types")
    parser.add_argument("--port", type=int, help="of a network that is already the soak's own")
    return parser.parse_args()


def main():
    arguments = parse()
    if arguments.port is None:
        in_own_network()  # returns only where it is not allowed
        arguments.port = 20_000 + 3 * (os.getpid() % 3_300)
    folder = pathlib.Path(arguments.keep or tempfile.mkdtemp(prefix="terra-soak-")).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "log").mkdir()
    soak = Soak(arguments, folder)
    soak.prepare()
    soak.start()
    soak.run()
    soak.finish()
    result = soak.judge()
    (folder / "soak.json").write_text(json.dumps(result, indent=2) + "\n")
    show(result)
    if not arguments.keep and not result["failures"]:
        shutil.rmtree(folder)
    else:
        print(f"kept in {folder}")
    return 1 if result["failures"] else 0


if __name__ == "__main__":
    sys.path.insert(0, parse().types)
    import faults
    import field
    import fleet
    import judge
    import lcm_bus
    import watch
    sys.exit(main())
