"""Advisors that are absent, dead, frozen, slow, lying, flooding."""
import pathlib
import re
import time

import bus
from rig import require
from rows import row

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIES = {
    "geometry": ["through-obstacles", "jumps", "duplicated-points", "huge-routes",
                 "too-few-points", "wrong-start", "wrong-goal"],
    "costs": ["dearer-routes", "ties", "cost-lies"],
    "keys": ["wrong-request", "wrong-map", "wrong-baseline", "wrong-anchor", "late-advice"],
    "who says it": ["stale-seq", "same-attempt", "replay", "impersonate", "clock-lies",
                    "unknown-kind", "forged-deployed"],
    "bytes": ["garbage", "truncated", "bit-flips", "hostile-counts", "hostile-strings",
              "version-skew"],
    "datagrams": ["no-channel-end", "oversize", "half-fragments", "offset-wrap", "slow-drip"],
}


@row("no advisor", "GATE 1", ["verifier:waits-for-advice"], short=True)
def no_advisor(rig):
    rig.set_up()
    for _ in range(50):
        rig.serve()
        require(rig.deployed["mode"] == 1, "a candidate without an advisor")
    rig.injected = 50
    return "50 of 50 requests have their baseline"


@row("advisor killed in mid-request (-9), restarted", "GATE 2; LCM flapping",
     ["verifier:waits-for-advice", "nobody restarts"], short=True)
def advisor_killed(rig):
    rig.set_up("searcher")
    for i in range(20):
        rig.ask()
        rig.hear(0.001 * (i % 5))
        rig["searcher"].kill()
        rig.injected += 1
        rig.await_served()
        rig.revive("searcher")
        if i % 4 == 3:
            rig.await_candidate()
    rig.await_candidate(5)
    return "all requests served; its route is in force again after the last restart"


@row("advisor frozen (SIGSTOP), goes on when all is over", "GATE 3; LCM hung",
     ["verifier:waits-for-advice", "verifier:no-key"])
def advisor_frozen(rig):
    rig.set_up("searcher")
    for attempt in range(1, 7):
        rig["searcher"].stop()
        rig.serve()
        old = rig.baseline
        rig.serve()
        # What it would have said of the request before, and has not yet.
        rig.advise(old, rig.optimum(old_ends(old)), attempt)
        rig["searcher"].resume()
        require(rig.verdict_on(attempt) == 40, "late advice is not stale")
        rig.await_candidate()
    return "late advice is stale_request; the next proposal comes into force"


def old_ends(baseline):
    return ((baseline["start_x"], baseline["start_y"]), (baseline["goal_x"], baseline["goal_y"]))


@row("slow answers (0 to 8 s)", "GATE 4",
     ["verifier:waits-for-advice", "verifier:closes-early"])
def slow_answers(rig):
    rig.set_up()
    for attempt, wait in enumerate((0, 0.5, 2, 8), start=1):
        rig.serve()
        rig.hear(wait)
        require(rig.deployed["mode"] == 1, "no baseline in force while the answer is awaited")
        rig.advise(rig.baseline, rig.optimum(rig.ends), attempt)
        require(rig.verdict_on(attempt) == 1, f"an answer after {wait} s is not accepted")
    rig.await_candidate()
    return "the baseline is in force meanwhile; each answer to what is still in force is accepted"


def attacked(rig, flags, seconds=3.0, rate=150.0, to="advice"):
    """Serves requests while terra-chaos does its worst. Returns how many."""
    options = [f"--{flag}" for flag in flags]
    rig.define("chaos", "terra-chaos", *options, "--for", seconds, "--seed", 7, "--to", to,
               *(["--rate", rate] if rate else ["--flood"]))
    rig.start("chaos")
    served = 0
    until = time.monotonic() + 6 * seconds + 10
    while rig["chaos"].running():
        require(time.monotonic() < until, "terra-chaos does not end")
        rig.serve(within=3)
        served += 1
        rig.hear(0.05)
    rig.alive("map", "planner", "verifier")
    words = rig["chaos"].output()
    lies = [line for line in words.splitlines() if "<--" in line]
    require(rig["chaos"].exit_code() == 0, f"terra-chaos: {lies or words}")
    rig.injected += sum(int(sent) for sent in re.findall(r"(\d+) datagrams", words))
    return served


def liar(kind, flaws, short=False):
    @row(f"advisor lies: {kind}", "LCM lies" + ("; GATE 9" if kind in ("geometry", "costs")
         else "; GATE 10" if kind in ("keys", "who says it") else ""), flaws, short=short)
    def lies(rig):
        rig.set_up()
        rig.start("searcher")
        # Below the gate's limits, so that it judges each of them.
        served = attacked(rig, LIES[kind] + ["many-senders"])
        rig.serve()
        rig.await_candidate()
        return f"{served} of {served} requests served, no lie accepted, the honest advisor is"


def attacker(kind, covers, flaws):
    @row(f"hostile {kind} on the advice port", covers, flaws)
    def hostile(rig):
        rig.set_up("searcher", "logger")
        served = attacked(rig, LIES[kind])
        rig.alive("searcher", "logger")
        rig.serve()
        rig.await_candidate()
        return f"{served} of {served} requests served; the gate runs on"


liar("geometry", ["verifier:no-geometry"], short=True)
liar("costs", ["verifier:no-cost"])
liar("keys", ["verifier:no-key"])
liar("who says it", ["verifier:no-geometry"])
attacker("bytes", "GATE 5; LCM hostile bytes, version skew", ["verifier:no-decoder"])
attacker("datagrams", "GATE 6; LCM hostile UDP, oversize", ["verifier:no-framing"])


@row("hostile bytes on the deployed port", "GATE 5; LCM hostile bytes", ["verifier:no-decoder"])
def hostile_on_the_deployed_bus(rig):
    rig.set_up("searcher", "logger")
    kinds = [channel for channel in rig.raw if channel != "TERRA_CONFIG"]
    for number in range(1_000):
        channel = rig.random.choice(kinds)
        data = broken(rig.random, rig.raw[channel])
        if bus.decode(bus.Heard(0, channel, data)) is None:  # else it would be believed
            rig.deployed_bus.say_raw(channel, data)
            rig.injected += 1
        if number % 20 == 0:
            rig.serve()
    rig.hear(1.2)
    rig.alive("map", "planner", "verifier", "searcher", "logger")
    refused = rig.counter("planner", "malformed")
    require(refused > 100, f"the planner counts {refused} malformed messages")
    rig.serve()
    rig.await_candidate()
    return f"50 of 50 requests served; refused and counted (by the planner {refused})"


def broken(generator, whole):
    """Cut, grown, of another type, with hostile counts and lengths."""
    at = generator.randrange(8, len(whole) - 4)
    count = generator.choice([-1, -5, 0x7FFFFFFF, 500_000_000, -0x80000000])
    return generator.choice([
        whole[:at], whole + generator.randbytes(9), generator.randbytes(len(whole)),
        whole[:3] + bytes([whole[3] ^ 1]) + whole[4:],
        whole[:at] + count.to_bytes(4, "big", signed=True) + whole[at + 4:]])


@row("the fragment that ends subscribers of liblcm (1.3.1 to 1.5.2)",
     "GATE 6; LCM offset wrap", ["verifier:ends-on-fragment"], short=True)
def offset_wrap(rig):
    rig.set_up("searcher", "logger")
    served = attacked(rig, ["offset-wrap"], rate=50, to="deployed")
    rig.alive("searcher", "logger")
    counted = rig.counter("verifier", "fragments")
    require(counted > 20, f"the gate counts {counted} fragments")
    rig.serve()
    rig.await_candidate()
    return f"{served} of {served} requests served; no process ends, {counted} fragments counted"


@row("the advisor process is hostile on both ports", "GATE 5, 6; LCM hostile UDP",
     ["verifier:ends-on-fragment", "verifier:no-framing"], short=True)
def hostile_on_both_ports(rig):
    """Bytes that are no message: what is well-formed on the deployed port is
    believed, and the firewall keeps advisors off it (docs/deployment.md)."""
    rig.set_up("searcher", "logger")
    quiet = served_in(rig, 5.0, lambda: True)
    for port in ("deployed", "advice"):
        rig.define(f"chaos-{port}", "terra-chaos", *(f"--{flag}" for flag in LIES["datagrams"]),
                   "--garbage", "--for", "5", "--seed", 7, "--to", port, "--rate", "500")
    rig.start("chaos-deployed", "chaos-advice")
    attack = served_in(rig, 5.0, rig["chaos-deployed"].running)
    rig.await_(lambda: not (rig["chaos-deployed"].running() or rig["chaos-advice"].running()),
               10, "terra-chaos does not end")
    rig.alive("map", "planner", "verifier", "searcher", "logger")
    for port in ("deployed", "advice"):
        words = rig[f"chaos-{port}"].output()
        require(rig[f"chaos-{port}"].exit_code() == 0, f"terra-chaos: {words}")
        rig.injected += sum(int(sent) for sent in re.findall(r"(\d+) datagrams", words))
    rig.serve()
    rig.await_candidate()
    return (f"served {told(attack)}, in a quiet phase {told(quiet)}; no process ends")


ADVISOR_USER = 64_999  # nobody's; stands for the user of the advisor units


@row("the firewall keeps a hostile advisor off the deployed port", "GATE 6; LCM firewall",
     ["no rule"], short=True)
def kept_off(rig):
    rules = (ROOT / "systemd" / "advisors.nft").read_text()
    rules = rules.replace('"terra-advisor"', str(ADVISOR_USER))
    if rig.flaw != "no rule":
        done = rig.run("nft", "-f", "-", input=rules)
        require(done.returncode == 0, f"nft: {done.stderr}")
    before = ("setpriv", f"--reuid={ADVISOR_USER}", "--clear-groups")
    rig.define("searcher", "terra-advisor", "--name", "searcher", before=before)
    rig.set_up("searcher", "logger")
    rig.define("chaos", "terra-chaos", "--through-obstacles", "--half-fragments", "--for", "3",
               "--seed", 7, "--to", "deployed", before=before)
    rig.start("chaos")
    fragments = rig.counter("verifier", "fragments")
    served = served_in(rig, 4.0, rig["chaos"].running)
    rig.await_(lambda: not rig["chaos"].running(), 10, "terra-chaos does not end")
    rig.hear(1.2)  # a heartbeat
    require(rig.counter("verifier", "fragments") == fragments, "fragments passed the firewall")
    rig.alive("map", "planner", "verifier", "searcher", "logger")
    words = rig["chaos"].output()
    rig.injected += sum(int(sent) for sent in re.findall(r"(\d+) misdeeds", words))
    rig.serve()
    rig.await_candidate()
    return f"served {told(served)}; nothing passes, and advice is heard as before"


def served_in(rig, seconds, while_):
    """Asks ten times a second. (requests asked, milliseconds to the route of each served)."""
    asked, took = 0, []
    until = time.monotonic() + seconds
    while time.monotonic() < until and while_():
        began = time.monotonic()
        asked += 1
        rig.serve(within=2)
        took.append((time.monotonic() - began) * 1e3)
        rig.hear(0.1)
    return asked, took


def told(phase):
    asked, took = phase
    took = sorted(took)
    return (f"{len(took)} of {asked} (request to route: median {took[len(took) // 2]:.1f} ms, "
            f"worst {took[-1]:.1f} ms)")


@row("advice larger than a message may be (61 kB to 1 MB)", "LCM oversize",
     ["verifier:no-size-limit"])
def oversize(rig):
    rig.set_up("logger")
    served = attacked(rig, ["oversize"], seconds=8.0, rate=15)
    rig.start("searcher")
    rig.serve()
    rig.await_candidate()
    return f"{served} of {served} requests served, none of it accepted"


def flooder(name, flags, flaw="verifier:reads-all"):
    @row(f"advice flood: {name}", "GATE 8; LCM floods", [flaw], lossy=True)
    def flood(rig):
        rig.set_up("searcher", "logger")
        served = attacked(rig, flags, rate=None)
        rig.serve()
        rig.await_candidate()
        return f"{served} of {served} requests served; an advisor that waits is heard again"


flooder("good routes, one sender", ["honest"])
flooder("good routes, many senders", ["honest", "many-senders"])
flooder("large datagrams and garbage", ["oversize", "garbage"], "verifier:no-framing")
