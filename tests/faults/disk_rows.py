"""Disks that are full, fail, refuse; logs that are torn."""
import shutil

from process_rows import events_in, newest_log
from rig import PORT, SET, require, url
from rows import row


def mount(rig, size):
    rig.log.mkdir(exist_ok=True)
    done = rig.run("mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", rig.log)
    require(done.returncode == 0, done.stderr)


def reported(rig, within=4.0):
    rig.await_(lambda: rig.status.get("logger", {}).get("state", "").startswith("failing"), within,
               "the logger does not say that it fails")


def ends_with_failure(rig):
    code = rig["logger"].terminate()
    require(code == 1, f"the logger ended with {code}, as if nothing was lost")


def served_meanwhile(rig, times=30):
    for _ in range(times):
        rig.serve()


def readable(rig):
    done = rig.run(rig.bin / "terra", "log", "info", newest_log(rig))
    require(done.returncode in (0, 1), f"terra log info: {done.stderr}")


@row("disk full (tmpfs of 256 kB)", "GATE 17; LCM disk full", ["logger:silent"], short=True)
def disk_full(rig):
    mount(rig, "256k")
    rig.set_up("searcher", "logger")
    for _ in range(200):
        rig.deployed_bus.say("TERRA_CONFIG", {"config_name": "row", "config_text": "x" * 3_000})
        rig.injected += 1
        if rig.injected % 20 == 0:
            rig.hear(0.02)
    reported(rig)
    served_meanwhile(rig)
    readable(rig)
    ends_with_failure(rig)
    return "said in STATUS and by exit code 1; the log is readable; all requests served"


@row("disk full, then room again", "GATE 17", ["logger:silent"])
def disk_full_for_a_while(rig):
    rig.set_up("searcher", "logger")
    rig["logger"].limit_files(0)
    rig.injected = 1
    served_meanwhile(rig)
    reported(rig)
    rig["logger"].limit_files(None)
    rig.await_(lambda: rig.status["logger"]["state"].startswith("ready"), 5,
               "the logger does not go on when there is room")
    served_meanwhile(rig)
    return "said in STATUS; recording goes on when there is room; all requests served"


@row("disk writes fail (EIO, libfiu)", "GATE 17", ["logger:silent"])
def disk_errors(rig):
    control = rig.folder / "fiu-ctrl"
    rig.define("logger", "terra-logger", "--out", rig.log,
               before=("fiu-run", "-x", "-f", control))
    rig.set_up("searcher", "logger")
    # Only now: a logger whose first write fails refuses to start, as it should.
    told = rig.run("fiu-ctrl", "-f", control, "-c",
                   "enable_random name=posix/io/rw/pwrite,probability=0.5", rig["logger"].pid)
    require(told.returncode == 0, f"fiu-ctrl: {told.stderr}")
    served_meanwhile(rig)
    # Each heartbeat tells of the last write, which failed or did not.
    reported(rig, within=20)
    rig.injected = 1
    served_meanwhile(rig)
    rig.alive(*SET, "searcher", "logger")
    return "half of all writes fail: said in STATUS; all requests served"


@row("log folder cannot be written", "LCM read-only dir", ["logger:starts-anyway"])
def folder_read_only(rig):
    mount(rig, "64k")
    rig.run("mount", "-o", "remount,ro", rig.log)
    rig.start("logger")
    rig.set_up("searcher")
    rig.injected = 1
    rig.await_(lambda: not rig["logger"].running(), 5, "the logger starts without a place to write")
    require(str(rig.log) in rig["logger"].output(), "its error does not name the folder")
    served_meanwhile(rig)
    return "the logger refuses to start and names the folder; all requests served"


@row("log folder deleted while it records", "-", ["logger:silent"])
def folder_deleted(rig):
    rig.set_up("searcher", "logger")
    for _ in range(3):
        rig.await_(lambda: rig.status["logger"]["state"].startswith("ready"), 6,
                   "the logger does not go on")
        shutil.rmtree(rig.log)
        rig.injected += 1
        reported(rig)
        served_meanwhile(rig, 10)
        acknowledged = rig.counter("logger", "acknowledged")
        rig.status.pop("logger")
        rig.await_(lambda: rig.counter("logger", "acknowledged") > acknowledged, 4,
                   "the logger acknowledges nothing more")
        require(events_in(rig, newest_log(rig)) > 0, "nothing is on the disk")
    ends_with_failure(rig)
    return "said in STATUS and by exit code 1; recording goes on in a new file"


@row("logger stopped (SIGSTOP) for 2 s under load", "GATE 17 (slow logger)",
     ["logger:writes-at-the-end"])
def logger_stopped(rig):
    rig.set_up("searcher", "logger")
    rig["logger"].stop()
    rig.injected = 1
    for _ in range(40):
        rig.serve()
        rig.hear(0.05)
    rig["logger"].resume()
    rig.hear(1.5)
    rig.status.pop("logger")
    rig.await_(lambda: rig.counter("logger", "acknowledged") > 0, 4, "the logger is silent")
    acknowledged = rig.counter("logger", "acknowledged")
    require(events_in(rig, newest_log(rig)) >= acknowledged, "acknowledged, and not on the disk")
    return "all requests served; it goes on and keeps what it acknowledges"


@row("burst of 10,000 messages", "LCM burst", ["logger:writes-at-the-end"])
def burst(rig):
    rig.set_up("searcher", "logger")
    for number in range(10_000):
        rig.deployed_bus.say("TERRA_POSE", {"pose_x": number})
        rig.injected += 1
        if number % 500 == 0:
            rig.serve()
    rig.await_(lambda: rig.counter("logger", "acknowledged") >= 10_000, 10,
               "the logger does not acknowledge them all")
    acknowledged = rig.counter("logger", "acknowledged")
    rig["logger"].kill()
    written = events_in(rig, newest_log(rig))
    require(written >= acknowledged, f"{acknowledged} acknowledged, {written} on the disk")
    return "all of them acknowledged, and on the disk after kill -9"


@row("logs torn, flipped, with garbage", "GATE 18; LCM logs", ["terra:says-all-is-well"])
def logs_damaged(rig):
    rig.set_up("searcher", "logger")
    served_meanwhile(rig, 10)
    rig["logger"].terminate()
    whole = newest_log(rig).read_bytes()
    damaged = rig.folder / "damaged.lcmlog"
    for number in range(60):
        at = rig.random.randrange(1, len(whole) - 1)
        data = {0: whole[:at], 1: whole[:at] + bytes([whole[at] ^ 1 << number % 8])
                + whole[at + 1:], 2: whole[:at] + rig.random.randbytes(50) + whole[at:]}[number % 3]
        damaged.write_bytes(data)
        rig.injected += 1
        for what in ("info", "audit"):
            command = [rig.bin / "terra", "log", what, damaged]
            if rig.flaw == "terra:says-all-is-well":
                command = ["true"]
            done = rig.run(*command)
            require(done.returncode == 1, f"terra log {what} of damage at byte {at}: exit code "
                                          f"{done.returncode}: {done.stderr}")
    return "each is noticed (exit code 1) by info and by audit; none crashes a reader"


@row("a whole log replayed into the live set, by two players", "GATE 10; LCM replay, two players",
     ["verifier:returns-to-old"], limit_s=4.0)
def replay_into_the_living(rig):
    rig.set_up("searcher", "logger")
    served_meanwhile(rig, 10)
    rig.hear(1.0)
    rig["logger"].terminate()
    log = shutil.copy(newest_log(rig), rig.folder / "replayed.lcmlog")
    for speed in (1, 20):
        rig.define(f"player{speed}", "terra")  # (its command is the player's)
        rig[f"player{speed}"].command = ["lcm-logplayer", f"--speed={speed}", "--lcm-url",
                                         url(PORT), log]
        rig.start(f"player{speed}")
    rig.injected = 2
    while rig["player1"].running() or rig["player20"].running():
        rig.serve(4)
        rig.hear(0.1)
    rig.alive(*SET)
    rig.serve(3)
    rig.await_candidate()
    return "requests served meanwhile and after; nothing old comes back"
