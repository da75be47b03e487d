"""Clocks that jump; too little CPU, memory, descriptors; absurd settings."""
import os
import resource
import sys

from rig import PORT, SET, require, url
from rows import row
import advisor_rows

FAKETIME = "/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1"


@row("clock steps of an hour, both ways", "GATE 19; LCM clock step",
     ["verifier:trusts-clock"], short=True)
def clock_steps(rig):
    offset = rig.folder / "offset"
    offset.write_text("+0")
    faked = ("env", f"LD_PRELOAD={FAKETIME}",
             f"FAKETIME_TIMESTAMP_FILE={offset}", "FAKETIME_NO_CACHE=1",
             "FAKETIME_DONT_FAKE_MONOTONIC=1")
    rig.define("planner", "terra-planner", "--stride", 20, before=faked)
    rig.define("verifier", "terra-verifier", before=faked)
    rig.set_up("searcher")
    before = rig.deployed["utime"]
    for step in ("+3600", "-3600", "+0", "-86400", "+86400", "+0"):
        offset.write_text(step)
        rig.injected += 1
        for _ in range(3):
            rig.serve()
        rig.await_candidate()
        shift = (rig.deployed["utime"] - before) / 1e6
        require(abs(shift - int(step)) < 60, f"the clock did not step by {step}: {shift:.0f} s")
    return "served and improved after each step"


@row("CPU starved (stress-ng, 8 hogs)", "GATE 20; LCM CPU starvation", ["verifier:slow"],
     limit_s=2.0)
def cpu_starved(rig):
    rig.set_up("searcher", "logger")
    rig.define("hogs", "terra")
    rig["hogs"].command = ["stress-ng", "--cpu", "8", "--quiet"]
    rig.start("hogs")
    rig.injected = 8
    for _ in range(50):
        rig.serve(3)
        rig.hear(0.05)
    rig.await_candidate(10)
    rig["hogs"].terminate()
    return "all requests served, late by the worst figure"


@row("memory: gate at its limit (prlimit --as), large messages", "GATE 21",
     ["verifier:needs-memory"])
def memory_limited(rig):
    rig.set_up("searcher")
    used = int([line for line in open(f"/proc/{rig['verifier'].pid}/status", encoding="ascii")
                if line.startswith("VmSize")][0].split()[1]) * 1024
    # A stand-in, being Python, takes some 40 bytes for a number of a message.
    limit = used + ((64 if rig.flaw else 1) << 20)
    resource.prlimit(rig["verifier"].pid, resource.RLIMIT_AS, (limit, limit))
    served = advisor_rows.attacked(rig, ["huge-routes", "hostile-counts", "oversize"])
    rig.show_map(1)
    rig.serve(4)
    return f"{served} of {served} requests served, and on a new map"


@row("memory: hardly any (prlimit --as 4 to 128 MB)", "GATE 21", ["small:half-alive"],
     limit_s=4.0)
def memory_refused(rig):
    rig.set_up("searcher")
    ended = 0
    for megabytes in (4, 8, 16, 24, 32, 48, 64, 96, 128):
        rig["verifier"].kill()
        rig.define("small", "terra-verifier", "--name", "small",
                   before=("prlimit", f"--as={megabytes << 20}"))
        rig.status.pop("small", None)
        rig.start("small")
        rig.injected += 1
        # It ends, or it serves: nothing between.
        session = rig.deployed["session"]
        rig.await_(lambda: not rig["small"].running() or rig.deployed["session"] != session, 5,
                   f"with {megabytes} MB it neither ends nor serves")
        if rig["small"].running():
            rig.serve(3)
            rig["small"].kill()
        else:
            require(rig["small"].exit_code() != 0, "it ends and says that all is well")
            ended += 1
        rig.start("verifier")
        rig.serve(4)
    return f"refuses to start ({ended} times) or serves; never half a gate"


@row("no file descriptor left (prlimit --nofile)", "GATE 21; LCM fd leak",
     ["verifier:opens-files"])
def descriptors(rig):
    rig.set_up("searcher", "logger")
    for name in (*SET, "searcher", "logger"):
        count = len(os.listdir(f"/proc/{rig[name].pid}/fd"))
        resource.prlimit(rig[name].pid, resource.RLIMIT_NOFILE, (count, count))
        rig.injected += 1
    for _ in range(30):
        rig.serve()
        rig.hear(0.05)
    rig.alive(*SET, "searcher", "logger")
    rig.await_candidate()
    return "all requests served; no process needs a new descriptor to serve"


@row("1,100 descriptors open before the bus's", "LCM fd leak > 1024", ["second:half-alive"])
def high_descriptors(rig):
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, 4_096), max(hard, 4_096)))
    rig.set_up("searcher")
    rig.define("second", "terra-verifier", "--name", "second", before=(
        sys.executable, "-c", "import os, sys\nfor _ in range(1100):\n    os.set_inheritable("
        "os.open('/dev/null', os.O_RDONLY), True)\nos.execv(sys.argv[1], sys.argv[1:])"))
    rig.start("second")
    rig.injected = 1_100
    rig.await_(lambda: not rig["second"].running(), 5, "it starts where LCM would end it")
    require("file descriptors are open" in rig["second"].output(),
            f"no clear error: {rig['second'].output()}")
    rig.serve()
    return "refuses to start and says why (liblcm 1.3.1 cannot use them)"


ABSURD = [("terra-verifier", "--margin", "-1"), ("terra-verifier", "--margin", "nan"),
          ("terra-planner", "--stride", "0"), ("terra-planner", "--stride", "-3"),
          ("terra-planner", "--stride", "99999999999"), ("terra-logger", "--part-mb", "0"),
          ("terra-logger", "--quota-mb", "-1"), ("terra-advisor", "--backend", "oracle"),
          ("terra-advisor", "--name", ""), ("terra-advisor", "--name", "x" * 100),
          ("terra-verifier", "--lcm-url", "udpm://nonsense"),
          ("terra-verifier", "--config", "/nowhere.toml"), ("terra-map", "--map", "/nowhere.png"),
          ("terra-map", "--map", "/dev/null", "--clearance", "-1")]


@row("absurd settings", "GATE 23", ["settings:accepts-all"])
def absurd_settings(rig):
    rig.set_up("searcher")
    for program, *options in ABSURD:
        command = [rig.bin / program, "--lcm-url", url(PORT), *options]
        if "--lcm-url" in options:
            command = [rig.bin / program, *options]
        if rig.flaw == "settings:accepts-all":
            command = ["sleep", "30"]
        done = rig.run("timeout", "5", *command)
        require(done.returncode not in (0, 124, 134, 139),
                f"{program} {' '.join(options)}: exit code {done.returncode}")
        require(done.stderr.strip() or done.stdout.strip(), f"{program}: refuses without a word")
        rig.injected += 1
    rig.serve()
    return "each is refused with a message"
