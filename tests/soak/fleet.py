"""The set as real processes: starts, faults, exits, and what each of them uses."""

import ctypes
import os
import pathlib
import resource
import signal
import subprocess
import time

TERMINATION_S = 20.0
PR_SET_PDEATHSIG = 1


def die_with_parent():
    """For preexec_fn: nothing outlives who started it, however that ends."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


class Process:
    """One process of the set under one name, through all its lives."""

    def __init__(self, name, command, folder):
        self.name = name
        self.command = command
        self.lives = 0
        self.stopped = False
        self._output = folder / f"{name}.out"
        self._child = None

    def start(self, options=()):
        self.lives += 1
        with open(self._output, "ab") as output:
            self._child = subprocess.Popen(
                [*map(str, self.command), *options], stdout=output,
                stderr=subprocess.STDOUT, preexec_fn=die_with_parent)

    @property
    def pid(self):
        return self._child.pid

    def running(self):
        return self._child is not None and self._child.poll() is None

    def exit_code(self):
        return self._child.poll()

    def output(self):
        """Of all lives."""
        return self._output.read_bytes().decode(errors="replace")

    def last_words(self):
        return self.output()[-400:]

    def kill(self):
        self._child.kill()
        self._child.wait()

    def terminate(self):
        """Returns the exit code, or "killed" when it had to be."""
        self._child.terminate()
        try:
            return self._child.wait(TERMINATION_S)
        except subprocess.TimeoutExpired:
            self.kill()
            return "killed"

    def stop(self):
        self.stopped = True
        self._child.send_signal(signal.SIGSTOP)

    def resume(self):
        self.stopped = False
        self._child.send_signal(signal.SIGCONT)

    def limit_files(self, size):
        """No file may grow beyond so many bytes; None lifts it."""
        limit = resource.RLIM_INFINITY if size is None else size
        resource.prlimit(self.pid, resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))

    def usage(self):
        """Memory in kB, file descriptors, threads."""
        fields = dict(line.split(":", 1) for line in
                      pathlib.Path(f"/proc/{self.pid}/status").read_text().splitlines())
        return {"rss_kb": int(fields["VmRSS"].split()[0]),
                "fds": len(os.listdir(f"/proc/{self.pid}/fd")),
                "threads": int(fields["Threads"])}


class Usage:
    """What each life of each process used, over time."""

    def __init__(self):
        self.lives = {}  # (name, life): [(seconds since its start, usage)]
        self._begun = {}

    def sample(self, process):
        key = (process.name, process.lives)
        begun = self._begun.setdefault(key, time.monotonic())
        try:
            usage = process.usage()
        except (OSError, KeyError):  # just gone
            return
        self.lives.setdefault(key, []).append((time.monotonic() - begun, usage))
