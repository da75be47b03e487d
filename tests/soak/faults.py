"""Which faults a soak injects, and when: all of it follows from the seed."""

import random
from dataclasses import dataclass

PATH = ["map", "planner", "verifier"]
OTHERS = ["logger", "searcher", "cutter"]
# Who is not killed in each third of a soak, so that every process has a life
# long enough to show a leak.
SPARED = [{"map", "verifier", "cutter"}, {"planner", "logger"}, {"searcher", "verifier"}]

KINDS = {"kill": 4, "stop": 3, "restart": 2, "chaos": 4, "map": 2, "full disk": 1}
PAUSE_S = (2.0, 8.0)  # between two faults
DEAD_S = (0.05, 2.0)
STOPPED_S = (0.2, 3.0)
FULL_S = (0.5, 4.0)

# The flags of terra-chaos a soak may choose from. offset-wrap is not among them:
# it crashes every process that reads a bus with liblcm 1.3.1, when sent to it.
LIES = """honest through-obstacles jumps duplicated-points huge-routes too-few-points wrong-start
wrong-goal dearer-routes ties wrong-request wrong-map wrong-baseline wrong-anchor late-advice
stale-seq same-attempt replay impersonate clock-lies cost-lies unknown-kind forged-deployed
garbage truncated bit-flips hostile-counts hostile-strings version-skew no-channel-end oversize
half-fragments slow-drip""".split()


@dataclass
class Fault:
    at: float  # seconds since the begin
    kind: str
    target: str
    seconds: float = 0.0  # how long it lasts
    options: tuple = ()


def chaos_options(generator):
    """A new way to misbehave."""
    lies = generator.sample(LIES, generator.randint(1, 6))
    rate = generator.choice([None, 0.5, 5, 50, 500])
    options = ["--" + lie for lie in sorted(set(lies))]
    options += ["--seed", str(generator.randrange(1 << 31))]
    options += ["--flood"] if rate is None else ["--rate", str(rate)]
    if generator.randrange(4) == 0:
        options.append("--many-senders")
    return tuple(options)


def planned(seed, seconds):
    """The faults of a run, by time. No process has two at once."""
    generator = random.Random(f"{seed} faults")
    free_at = {}
    faults = []
    at = 5.0
    while at < seconds - 5:
        fault = _one(generator, at, SPARED[min(2, int(3 * at / seconds))])
        if fault and free_at.get(fault.target, 0.0) <= at:
            faults.append(fault)
            free_at[fault.target] = at + fault.seconds + 1.0
        at += generator.uniform(*PAUSE_S)
    return faults


def _one(generator, at, spared):
    kind = generator.choices(list(KINDS), KINDS.values())[0]
    seconds = generator.uniform(*{"stop": STOPPED_S, "full disk": FULL_S}.get(kind, DEAD_S))
    if kind == "chaos":
        return Fault(at, kind, "chaos", 0.0, chaos_options(generator))
    if kind == "map":
        return Fault(at, kind, "map", 0.0)
    if kind == "full disk":
        return Fault(at, kind, "logger", seconds)
    names = PATH + OTHERS
    if kind != "stop":
        names = [name for name in names if name not in spared]
    return Fault(at, kind, generator.choice(names), seconds)
