"""What the flight recorder keeps: on a slow disk, under a wrong clock, after a
loss of power."""
import json
import os
import re
import shutil
import socket
import time

from disk_rows import ends_with_failure, mount, reported, served_meanwhile
from machine_rows import FAKETIME
from process_rows import events_in, events_of, newest_log
from rig import HERE, require
from rows import row
import wire

UNIT = HERE.parents[1] / "systemd" / "terra-logger@.service"
WATCHDOG_S = int(re.search(r"^WatchdogSec=(\d+)$", UNIT.read_text(), re.MULTILINE).group(1))
STALL_S = WATCHDOG_S + 1.5
UNSAID = "the logger does not say that its disk stands still"


class ServiceManager:
    """Systemd's side of the watchdog."""

    def __init__(self, rig):
        self.path = str(rig.folder / "notify")
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.bind(self.path)
        self._socket.setblocking(False)
        self._alive = None

    def environment(self):
        return (f"NOTIFY_SOCKET={self.path}", f"WATCHDOG_USEC={WATCHDOG_S * 1_000_000}")

    def check(self):
        try:
            while True:
                if b"WATCHDOG=1" in self._socket.recv(4_096):
                    self._alive = time.monotonic()
        except BlockingIOError:
            pass
        if self._alive is not None:
            silent = time.monotonic() - self._alive
            require(silent < WATCHDOG_S,
                    f"the watchdog aborts the logger: silent for {silent:.1f} s")


def define_on_slow_disk(rig, *environment, stall_s=STALL_S):
    """One fdatasync in a hundred takes so long (strace delays that thread alone)."""
    rig.define("logger", "terra-logger", "--out", rig.log, before=(
        "env", *environment, "strace", "-D", "-f", "--seccomp-bpf", "-qq", "-o", "/dev/null",
        "-e", "trace=fdatasync", "-e",
        f"inject=fdatasync:delay_enter={int(stall_s * 1e6)}:when=20+100"))


class Robot:
    """Says poses and remembers how many."""

    def __init__(self, rig):
        self.rig, self.said = rig, 0

    def drive(self, until, what, each=lambda: None, within=60.0):
        """Fifty poses and two requests a second, until something holds."""
        end, serve_at = time.monotonic() + within, 0.0
        while not until():
            require(time.monotonic() < end, f"{what}: not within {within:g} s")
            self.say()
            self.rig.hear(0.02)
            if time.monotonic() > serve_at:
                serve_at = time.monotonic() + 0.5
                self.rig.serve()
            each()

    def say(self):
        self.said += 1
        self.rig.deployed_bus.say("TERRA_POSE", {"pose_x": self.said})

    def kept(self):
        """How many of the poses are in the logs."""
        return len(sequence_numbers(self.rig, "pose"))


def sequence_numbers(rig, name):
    """Of the row's own messages of a type, in all logs."""
    messages = [wire.decode(name, data) for log in rig.log.glob("*.lcmlog")
                for channel, data in events_of(log) if channel == "TERRA_" + name.upper()]
    return {message["seq"] for message in messages
            if message["session"] == rig.deployed_bus.session}


def stands_still(rig):
    return "takes nothing" in rig.status.get("logger", {}).get("state", "")


def records(rig):
    return rig.status.get("logger", {}).get("state", "").startswith("ready")


@row(f"disk stands still for {STALL_S:g} s at a time, WatchdogSec={WATCHDOG_S} as in the unit",
     "GATE 17 (slow logger)", ["logger:waits-for-disk"])
def slow_disk(rig):
    manager = ServiceManager(rig)
    define_on_slow_disk(rig, *manager.environment())
    rig.set_up("searcher", "logger")
    robot = Robot(rig)
    for _ in range(2):
        robot.drive(lambda: stands_still(rig), UNSAID, manager.check)
        rig.injected += 1
        robot.drive(lambda: records(rig), "the logger does not go on", manager.check)
    code = rig["logger"].terminate()
    require(code == 0, f"the logger ended with {code}: {rig['logger'].last_words()}")
    kept = robot.kept()
    require(kept == robot.said, f"{robot.said} poses said, {kept} in the log")
    require(rig.counter("logger", "lost") == 0, "the logger says that it lost something")
    return "the watchdog is fed, said in STATUS; every pose is in the log; all requests served"


@row("logger killed (-9) while its disk stands still, restarted", "GATE 17 (slow logger)",
     ["logger:forgets-losses"])
def killed_on_slow_disk(rig):
    define_on_slow_disk(rig)
    rig.set_up("searcher", "logger")
    robot, lost = Robot(rig), 0
    for _ in range(2):
        robot.drive(lambda: stands_still(rig), UNSAID)
        lost += rig.counter("logger", "lost")
        rig["logger"].kill()
        rig.injected += 1
        for _ in range(10):
            robot.say()
        rig.hear()
        rig.status.pop("logger")
        rig.revive("logger")
        robot.drive(lambda: rig.counter("logger", "lost") > 0, "the logger counts no loss",
                    within=10)
    lost += rig.counter("logger", "lost")
    rig["logger"].terminate()
    missing = robot.said - robot.kept()
    require(missing >= 20, "no pose is missing: the row shows nothing")
    require(lost >= missing, f"{missing} poses are missing, {lost} messages counted as lost")
    return "what is missing is counted over both restarts; all requests served"


@row("disk stands still for 20 s, 90 MB come meanwhile (it holds 64)", "GATE 17 (slow logger)",
     ["logger:drops-uncounted"])
def buffer_overflows(rig):
    mount(rig, "256m")
    define_on_slow_disk(rig, stall_s=20)
    rig.set_up("searcher", "logger")
    robot = Robot(rig)
    robot.drive(lambda: stands_still(rig), UNSAID)
    for number in range(3_000):
        rig.deployed_bus.say("TERRA_CONFIG", {"config_name": "row", "config_text": "x" * 30_000})
        rig.injected += 1
        if number % 10 == 0:
            rig.hear(0.005)
        if number % 500 == 0:
            rig.serve()
    require(stands_still(rig), "the disk goes on too early: the row shows nothing")
    robot.drive(lambda: records(rig), "the logger does not go on")
    rig.status.pop("logger")
    rig.await_(lambda: "logger" in rig.status, 4, "the logger is silent")
    lost = rig.counter("logger", "lost") + rig.counter("logger", "tap_lost_in_kernel")
    code = rig["logger"].terminate()
    kept = sequence_numbers(rig, "config")
    missing = rig.injected - len(kept) + robot.said - robot.kept()
    require(set(range(1, 1_501)) <= kept, "something of the first 45 MB is missing")
    require(rig.flaw or (missing > 0 and code == 1), f"{missing} are missing, exit code {code}")
    require(lost >= missing, f"{missing} messages are missing, {lost} counted as lost")
    return "the first 45 MB are in the log, what does not fit is counted; all requests served"


@row("log file cut, moved, replaced by another program", "-", ["logger:silent"])
def file_taken(rig):
    rig.set_up("searcher", "logger")
    away = rig.folder / "away"

    def replace(log):
        log.rename(away)
        log.write_bytes(b"another file")

    for take in (lambda log: os.truncate(log, 100), lambda log: log.rename(away), replace):
        rig.await_(lambda: records(rig), 6, "the logger does not go on")
        take(newest_log(rig))
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


# ---- The quota ----

QUOTA_MB = 16


def plant_parts(rig, count):
    """A recording of many parts of 20 kB: headers alone, as the logger writes them."""
    for number in range(count):
        header = wire.encode("log_mark", {
            "session": 7, "seq": 1, "mark_kind": 1, "format_version": 1, "part": number,
            "mark_text": "recording 1\n" + "x" * 14_000})
        channel = b"TERRA_LOG"
        data = (b"\xed\xa1\xda\x01" + bytes(16) + len(channel).to_bytes(4, "big")
                + len(header).to_bytes(4, "big") + channel + header)
        name = f"terra-20260101T000000Z-00000007.{number:03d}.lcmlog"
        (rig.log / name).write_bytes(data.ljust(20_000, b"\0"))


def plant_foreign(rig):
    """What a quota has no business with; a function that requires it untouched."""
    outside = rig.folder / "outside"
    outside.write_bytes(b"x" * 100)
    link = rig.log / "terra-19700101T000000Z-00000000.000.lcmlog"
    link.symlink_to(outside)
    files = {rig.log / name: name.encode() for name in (
        "notes.txt", "robot.lcmlog", "terra-19700101T000000Z-00000001.000.lcmlog")}
    for path, data in files.items():
        path.write_bytes(data)

    def untouched():
        require(link.is_symlink() and outside.read_bytes() == b"x" * 100, "the link was touched")
        for path, data in files.items():
            require(path.exists() and path.read_bytes() == data, f"{path.name} was touched")
    return untouched


def age(path):
    """(recording, part) by the header mark, or None for what is no part."""
    first = next(iter(events_of(path)), None)
    if path.is_symlink() or first is None or first[0] != "TERRA_LOG":
        return None
    mark = wire.decode("log_mark", first[1])
    return int(re.search(r"^recording (\d+)$", mark["mark_text"], re.MULTILINE).group(1)), \
        mark["part"]


def stored(rig):
    """{(recording, part): path}, oldest first."""
    parts = {age(path): path for path in rig.log.glob("*.lcmlog") if age(path)}
    return dict(sorted(parts.items()))


def thin_by_name(rig):
    """What a logger does that goes by the clock in the names."""
    parts = sorted(stored(rig).values(), key=lambda path: path.name)
    for path in parts[:len(parts) // 2]:
        path.unlink()


def record_megabytes(rig, count):
    rig.await_(lambda: rig.counter("logger", "acknowledged") > 0, 5, "the logger is silent")
    for number in range(count * 35):
        rig.deployed_bus.say("TERRA_CONFIG", {"config_name": "row", "config_text": "x" * 30_000})
        if number % 10 == 0:
            rig.hear(0.02)


@row("wrong clocks (1970, 2040, 2001) and 1,500 parts, with a quota", "-", ["quota:by-name"])
def wrong_clocks(rig):
    mount(rig, "64m")
    plant_parts(rig, 1_500)
    untouched = plant_foreign(rig)
    ever = set(stored(rig))
    rig.set_up("searcher")
    for recording, (year, megabytes) in enumerate(((1970, 4), (2040, 20), (2001, 4)), 2):
        rig.define("logger", "terra-logger", "--out", rig.log, "--part-mb", 1, "--quota-mb",
                   QUOTA_MB, before=(
                       "env", f"LD_PRELOAD={FAKETIME}", "FAKETIME_DONT_FAKE_MONOTONIC=1",
                       f"FAKETIME=@{year}-01-02 00:00:00"))
        rig.status.pop("logger", None)
        rig.start("logger")
        rig.injected += 1
        record_megabytes(rig, megabytes)
        rig.serve()
        code = rig["logger"].terminate()
        require(code == 0, f"the logger ended with {code}: {rig['logger'].last_words()}")
        if rig.flaw == "quota:by-name":
            thin_by_name(rig)
        parts = stored(rig)
        last = max((number for one, number in parts if one == recording), default=-1)
        require(last >= megabytes // 4, f"recording {recording} has {last + 1} parts")
        ever |= {(recording, number) for number in range(last + 1)}
        require(list(parts) == sorted(ever)[-len(parts):],
                f"in {year} not the newest parts are left")
        size = sum(path.stat().st_size for path in parts.values())
        # A part is seen to be full after it was written: by at most a flush.
        require(QUOTA_MB / 2 < size / 2**20 < QUOTA_MB + 4, f"{size} bytes are left")
        for (one, _), path in parts.items():
            if one == recording:
                done = rig.run(rig.bin / "terra", "log", "info", path)
                require(done.returncode == 0, f"{path.name}: {done.stdout} {done.stderr}")
        untouched()
    return "the newest parts stay, each whole by its seals; foreign files and links are untouched"


# ---- Power ----


def make_image(rig, kind, path, megabytes):
    with open(path, "wb") as image:
        image.truncate(megabytes << 20)
    done = rig.run("mkfs." + kind, "-q", path)
    require(done.returncode == 0, done.stderr)


def mount_image(rig, image, at, options="loop"):
    at.mkdir(exist_ok=True)
    done = rig.run("mount", "-o", options, image, at)
    require(done.returncode == 0, f"{image}: {done.stderr}")


def images_are_possible(rig):
    return (shutil.which("mkfs.xfs") and shutil.which("mkfs.ext4") and os.path.exists(
        "/dev/loop-control") and rig.run("losetup", "-f").returncode == 0)


def require_good_seals(rig, log):
    """None is broken. (A stand-in's log has none.)"""
    info = rig.run(rig.bin / "terra", "log", "info", "--json", log)
    require(info.returncode in (0, 1), f"terra log info: {info.stderr}")
    told = json.loads(info.stdout)
    require(told["num_broken_seals"] == 0, f"broken seals: {told['broken_seals']}")
    require(rig.flaw or told["good_seals"] > 2, "the log has no seals")


def cut_power(rig, disks, kind):
    """A copy of the disk as it is at one moment (a clone of its blocks), mounted
    as after a loss of power: events that were acknowledged, events in it."""
    rig.status.pop("logger")
    rig.await_(lambda: rig.counter("logger", "acknowledged") > 0, 4, "the logger is silent")
    acknowledged = rig.counter("logger", "acknowledged")
    done = rig.run("cp", "--reflink=always", disks / "disk", disks / "copy")
    require(done.returncode == 0, done.stderr)
    after = rig.folder / "after"
    mount_image(rig, disks / "copy", after, "loop,nouuid" if kind == "xfs" else "loop")
    try:
        logs = list(after.glob("*.lcmlog"))
        require(logs, f"{kind}: the log is not there")
        kept = events_in(rig, logs[0])
        require_good_seals(rig, logs[0])
    finally:
        rig.run("umount", after)
    require(kept >= acknowledged, f"{kind}: {acknowledged} acknowledged, {kept} on the disk")


@row("power fails while it records (ext4, xfs)", "LCM power loss", ["logger:never-syncs"])
def power_loss(rig):
    if not images_are_possible(rig):
        rig.set_up()
        return "skipped: needs loop devices, mkfs.ext4 and mkfs.xfs"
    # The outer one is xfs, which clones a file's blocks at one moment.
    disks = rig.folder / "disks"
    make_image(rig, "xfs", rig.folder / "outer", 1_500)
    mount_image(rig, rig.folder / "outer", disks)
    rig.set_up("searcher")
    robot = Robot(rig)
    for kind in ("ext4", "xfs"):
        make_image(rig, kind, disks / "disk", 320)
        mount_image(rig, disks / "disk", rig.log)
        rig.status.pop("logger", None)
        rig.start("logger")
        rig.await_(lambda: records(rig), 5, "the logger does not start")
        for number in range(6):
            until = time.monotonic() + 0.3 + 0.17 * number
            robot.drive(lambda: time.monotonic() > until, "the time is not over")
            cut_power(rig, disks, kind)
            rig.injected += 1
        rig["logger"].terminate()
        done = rig.run("umount", rig.log)
        require(done.returncode == 0, done.stderr)
    return "after each cut all that was acknowledged is on the disk"
