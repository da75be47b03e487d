"""Processes that die, hang, or run twice."""
import contextlib
import os
import signal
import time
import urllib.error
import urllib.request

import field
from rig import SET, require
from rows import row

# A restarted process: back in service within 2 s and the map's transfer.
BACK_S = 3.0


@row("gate killed (-9) at any moment, restarted", "GATE 15",
     ["nobody restarts", "verifier:no-request-from-baseline"], short=True, limit_s=BACK_S)
def gate_killed(rig):
    rig.set_up("searcher")
    for i in range(12):
        rig.ask()
        rig.hear(0.0005 * i)
        rig["verifier"].kill()
        rig.injected += 1
        rig.revive("verifier")
        session = rig.deployed["session"]
        if i % 2 == 0:
            rig.await_served(BACK_S)
        # Else the requester is gone as well: its request lives on in BASELINE.
        rig.await_(lambda: rig.has_route() and rig.deployed["session"] != session, BACK_S,
                   "the restarted gate deploys nothing")
    return f"each new gate deploys a route within {BACK_S:g} s, also when the requester is gone"


@row("gate stopped (50 ms to 2 s), requests pile up", "LCM receiver stall",
     ["verifier:slow"], limit_s=4.0)
def gate_stalled(rig):
    rig.set_up("searcher")
    for stall in (0.05, 0.2, 0.5, 1, 2):
        rig["verifier"].stop()
        rig.injected += 1
        for _ in range(5):
            rig.ask()
            rig.hear(stall / 5)
        rig["verifier"].resume()
        rig.await_served(1.0)
    return "on waking it deploys for the newest request within 1 s"


def planner_away(rig, go, come_back, within):
    """Three times for 2 s; the route in force stays."""
    rig.set_up("searcher")
    for _ in range(3):
        rig.await_candidate()
        route = rig.deployed["route_seq"]
        go()
        rig.injected += 1
        rig.hear(2)
        require(rig.deployed["route_seq"] == route, "the route in force changed")
        come_back()
        rig.serve(within)


@row("planner killed (-9) and gone for 2 s", "GATE 16", ["verifier:forgets", "nobody restarts"])
def planner_killed(rig):
    planner_away(rig, rig["planner"].kill, lambda: rig.revive("planner"), BACK_S)
    return "the last verified route stays in force; the restarted planner serves"


@row("planner hangs (SIGSTOP) for 2 s", "GATE 16", ["verifier:forgets"])
def planner_hangs(rig):
    planner_away(rig, rig["planner"].stop, rig["planner"].resume, 2.0)
    return "the last verified route stays in force"


@row("everything killed (-9), started in any order", "DESIGN 2 (restart)", ["nobody restarts"],
     limit_s=BACK_S)
def all_killed(rig):
    rig.set_up("searcher", "logger")
    for _ in range(4):
        names = [*SET, "searcher", "logger"]
        for name in names:
            rig[name].kill()
        rig.injected += len(names)
        rig.random.shuffle(names)
        rig.revive(*names)
        rig.serve(BACK_S)
    rig.await_candidate()
    return "served again, whatever the order"


@row("two gates", "GATE 22; LCM two gates", ["planner:one-gate"])
def two_gates(rig):
    rig.set_up("searcher")
    rig.define("second", "terra-verifier", "--name", "second")
    rig.start("second")
    rig.injected = 1
    for _ in range(10):
        rig.serve()
    rig.await_(lambda: rig.counter("planner", "from_replaced_gate") > 0, 3,
               "the planner does not report the second gate")
    return "both keep every invariant; the one that was replaced is reported"


@row("two planners", "LCM two planners", ["verifier:one-planner"])
def two_planners(rig):
    rig.set_up("searcher")
    rig.define("other", "terra-planner", "--stride", 2 * field.STRIDE, "--name", "other")
    rig.start("other")
    rig.injected = 1
    for _ in range(10):
        rig.serve()
    rig.await_(lambda: rig.counter("verifier", "from_replaced_planner") > 0, 3,
               "the gate does not report the second planner")
    return "the new one is followed, the replaced one reported; the cost only falls"


@row("signals: 1,000 a second, and stop and continue", "LCM signals 1 kHz",
     ["verifier:ends-on-signal"])
def signals(rig):
    rig.set_up("searcher", "logger")
    until = time.monotonic() + 3
    ask_at = 0
    while time.monotonic() < until:
        for name in (*SET, "logger", "searcher"):
            os.kill(rig[name].pid, signal.SIGWINCH)
            os.kill(rig[name].pid, signal.SIGSTOP)
            os.kill(rig[name].pid, signal.SIGCONT)
            rig.injected += 1
        if time.monotonic() > ask_at:
            ask_at = time.monotonic() + 0.3
            rig.serve()
        time.sleep(0.005)
    rig.alive(*SET, "logger", "searcher")
    rig.serve()
    rig.await_candidate()
    return "no wait is cut short, no process ends"


def unread_pipe(folder):
    """A full pipe: the descriptor that keeps it open, and its path."""
    path = folder / "unread"
    os.mkfifo(path)
    pipe = os.open(path, os.O_RDWR | os.O_NONBLOCK)
    with contextlib.suppress(BlockingIOError):
        while True:
            os.write(pipe, b".")
    return pipe, path


@row("nobody reads what the processes log (a full pipe)", "-",
     ["verifier:waits-for-stderr", "logger:waits-for-stderr", "model:waits-for-stderr"])
def stderr_unread(rig):
    pipe, path = unread_pipe(rig.folder)
    before = ("sh", "-c", f"exec \"$@\" 2>>'{path}'", "sh")
    rig.define("map", "terra-map", "--map", rig.map, "--legend", rig.legend, before=before)
    rig.define("planner", "terra-planner", "--stride", field.STRIDE, before=before)
    rig.define("verifier", "terra-verifier", before=before)
    rig.define("logger", "terra-logger", "--out", rig.log, before=before)
    rig.define("searcher", "terra-advisor", "--name", "searcher", before=before)
    rig.define("cutter", "terra-advisor", "--name", "cutter", "--backend", "shortcut",
               before=before)
    rig.define("chaos", "terra-chaos", "--all", "--rate", 20, before=before)
    more = ("searcher", "cutter", "logger")
    rig.set_up(*more, "chaos")
    model = start_model(rig, before)
    for _ in range(50):
        rig.serve()
        # A word of the gate's for its log, and one of the model's.
        rig.advice_bus.say_raw("TERRA_ADVICE", b"no advice")
        rig.injected += 1
        require(refuses_nonsense(model), "the model does not answer")
    rig.await_candidate()
    rig.status.clear()
    for name in (*SET, *more, "chaos"):
        rig.await_(lambda: name in rig.status, 5, f"no heartbeat of {name}")
    for name in (*SET, *more, "chaos", "model"):
        code = rig[name].terminate()
        require(code in (0, -signal.SIGTERM), f"{name} ended with {code}")
    os.close(pipe)
    return "all requests served; each process ends when it is asked to"


def start_model(rig, before):
    """Starts a terra-llm-sim; its URL."""
    port_file = rig.folder / "model-port"
    rig.define("model", "terra-llm-sim", before=before)
    rig["model"].command = [*before, rig.bin / "terra-llm-sim", "--latency", 0, "--port-file",
                            port_file]
    if rig.flaw == "model:waits-for-stderr":
        rig["model"].command = [*before, "sh", "-c", f"echo it begins >&2; echo 1 >'{port_file}'"]
    rig.start("model")
    rig.await_(lambda: port_file.exists() and port_file.read_text().strip(), 5,
               "the model does not start")
    return f"http://127.0.0.1:{port_file.read_text().strip()}"


def refuses_nonsense(model):
    """The model answers a question of no known form."""
    try:
        urllib.request.urlopen(model + "/v1/chat/completions", b"{}", timeout=2)
    except urllib.error.HTTPError as answer:
        return answer.code == 400
    except OSError:
        return False
    return False


@row("advisor restarted 5 times a second", "LCM flapping", ["verifier:waits-for-advice"])
def advisor_flaps(rig):
    rig.set_up()
    for _ in range(20):
        rig.start("cutter")
        rig.serve()
        rig.hear(0.2)
        rig["cutter"].kill()
        rig.injected += 1
    return "every request is served"


@row("logger killed (-9, SIGHUP), stopped, gone", "GATE 17; LCM logger kill -9, SIGHUP",
     ["logger:writes-at-the-end"])
def logger_killed(rig):
    rig.log.mkdir(exist_ok=True)
    rig.set_up("searcher", "logger")
    for i in range(6):
        rig.status.pop("logger", None)
        rig.serve()
        rig.await_(lambda: rig.counter("logger", "acknowledged") > 0, 4,
                   "the logger acknowledges nothing")
        acknowledged = rig.counter("logger", "acknowledged")
        os.kill(rig["logger"].pid, signal.SIGHUP if i % 2 else signal.SIGKILL)
        rig.await_(lambda: not rig["logger"].running(), 2, "the logger does not end")
        rig.injected += 1
        written = events_in(rig, newest_log(rig))
        require(written >= acknowledged, f"{acknowledged} events acknowledged, {written} on disk")
        rig.serve()
        rig.revive("logger")
    rig["logger"].stop()
    for _ in range(10):
        rig.serve()
    rig["logger"].resume()
    return "requests served without it; every acknowledged event is on the disk"


def newest_log(rig):
    return max(rig.log.glob("*.lcmlog"), key=lambda path: path.stat().st_mtime_ns)


def events_of(log):
    """Whole events in a row, by the suite's own reader: (channel, data)."""
    data, at = log.read_bytes(), 0
    while data[at:at + 4] == b"\xed\xa1\xda\x01" and at + 28 <= len(data):
        name = at + 28 + int.from_bytes(data[at + 20:at + 24], "big")
        end = name + int.from_bytes(data[at + 24:at + 28], "big")
        if end <= len(data):
            yield data[at + 28:name].decode(), data[name:end]
        at = end


def events_in(rig, log):
    return sum(1 for _ in events_of(log))
