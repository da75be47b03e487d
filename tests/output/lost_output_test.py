"""Every program ends with an error when its output is lost.

usage: lost_output_test.py BIN_FOLDER EXAMPLES_FOLDER

Each is run with a standard output that nobody reads, which refuses what is
written as a full disk does, and with a closed one. Both must end with exit code
1 and say so; and what goes into files must come out as ever, though the first
file that is opened gets a closed stream's number.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

TIMEOUT_S = 60
URL = "udpm://239.255.76.67:17690?ttl=0"
# What some programs want before they print anything.
NEEDED = {"terra-chaos": ["--all"], "terra-graph-planner": ["--graph", "graph"]}
ROUTE = "[(30, 250), (470, 250)]"


def run(command, stream):
    """Returns (exit code, stderr); stream: "read", "refused" or "closed"."""
    kept = {}
    if stream == "read":
        kept["stdout"] = subprocess.DEVNULL
    elif stream == "refused":
        read_end, write_end = os.pipe()
        os.close(read_end)
        kept["stdout"] = write_end
        kept["restore_signals"] = False  # Python ignores SIGPIPE: an error.
    else:
        kept["preexec_fn"] = lambda: os.close(1)
    try:
        done = subprocess.run(command, stderr=subprocess.PIPE, text=True,
                              stdin=subprocess.DEVNULL, timeout=TIMEOUT_S, **kept)
    finally:
        if stream == "refused":
            os.close(write_end)
    return done.returncode, done.stderr


def subcommands(terra, before=()):
    """Yields each command that terra's own help lists, as words."""
    text = subprocess.run([terra, *before, "--help"], capture_output=True,
                          text=True, check=True).stdout
    part = re.split(r"^Subcommands:\n", text, flags=re.M)
    yield before
    if len(part) < 2:
        return
    for name in re.findall(r"^  (\S+)", part[1].split("\n\n")[0], flags=re.M):
        yield from subcommands(terra, (*before, name))


def that_print(bin_folder, examples, folder):
    """Commands whose result is on standard output."""
    terra = bin_folder / "terra"
    ends = ["--map", examples / "demo.png", "--start", "30,250", "--goal",
            "470,250"]
    for words in subcommands(terra):
        yield [terra, *words, "--help"]
    yield [terra, "--version"]
    for form in ([], ["--json"]):
        yield [terra, "plan", *ends, *form]
        yield [terra, "oracle", *ends, *form]
        yield [terra, "verify", *ends, "--baseline", ROUTE, "--candidate",
               ROUTE, *form]
        yield [terra, "advise", *ends, "--backend", "search", *form]
    yield [terra, "monitor", "--lcm-url", URL, "--for", "30"]
    for program in sorted(bin_folder.glob("terra-*")):
        if not os.access(program, os.X_OK) or program.is_dir():
            continue
        yield [program, "--help"]
        if program.name == "terra-llm-sim":
            yield [program, "--latency", "0"]
        elif program.name not in ("terra-calibrate", "terra-speed"):
            yield [program, "--version"]
            yield [program, *NEEDED.get(program.name, []), "--print-config"]


def that_write(bin_folder, examples, folder):
    """(command, file): commands that write a file and print besides."""
    terra = bin_folder / "terra"
    data = folder / "data"
    yield ([terra, "bench", "generate", "--subset", "easy", "--count", "2",
            "--seed", "1", "--out", data], data / "cases.csv")
    yield ([terra, "bench", "gap", "--dataset", data, "--strides", "50",
            "--out", folder / "gap.csv"], folder / "gap.csv")
    yield ([terra, "bench", "run", "--dataset", data, "--method", "coarse",
            "--out", folder / "run"], None)


def remove(path):
    if path.is_dir():
        for inner in path.iterdir():
            remove(inner)
        path.rmdir()
    elif path.exists():
        path.unlink()


def main(bin_folder, examples):
    faults = []

    def check(command, stream, wanted):
        code, errors = run(command, stream)
        said = "standard output cannot be written" in errors
        if code != wanted or said != (wanted == 1):
            faults.append(f"{stream}: {' '.join(map(str, command))}\n  exit code "
                          f"{code}, stderr: {errors.strip() or '(nothing)'}")

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        commands = list(that_print(bin_folder, examples, folder))
        assert len(commands) > 30, commands
        for command in commands:
            for stream in ("refused", "closed"):
                check(command, stream, 1)
        for command, file in that_write(bin_folder, examples, folder):
            out = command[command.index("--out") + 1]
            contents = []
            for stream in ("refused", "closed", "read"):
                remove(out)
                check(command, stream, 0 if stream == "read" else 1)
                if file:
                    contents.append(file.read_bytes() if file.exists() else None)
            if file and (contents.count(contents[-1]) != 3 or not contents[-1]):
                faults.append(f"{file.name} differs with the stream")
        # Nothing is printed here, so nothing is lost.
        picture = folder / "p.png"
        for stream in ("refused", "closed"):
            check([bin_folder / "terra", "render", "--map",
                   examples / "demo.png", "--out", picture], stream, 0)
    print("\n".join(faults) or f"{len(commands)} commands end with an error")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
