"""Checks who includes what: the layers of docs/architecture.md.

usage: check_layers.py SOURCE_FOLDER

Prints each include that breaks a rule as FILE:LINE and exits with 1.
"""

import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s+[<"]([^>"]+)[>"]')
FOLDERS = ["base", "terrain", "output", "bus", "planner", "verifier", "advisor", "logger",
           "benchmark", "chaos", "cli"]

# Project folders that a folder may include, besides itself. "terrain" is the
# pure ground truth; "terrain/files" are its readers and writers.
ALLOWED = {
    "base": set(),
    "terrain": set(),
    "terrain/png": {"terrain"},
    "terrain/files": {"terrain", "terrain/png", "output"},
    # Files written whole, standard output: for all that writes.
    "output": {"terrain"},
    "bus": {"base", "terrain", "output", "terra_msg"},
    "planner": {"terrain"},
    "verifier": {"terrain"},
    "advisor": {"base", "terrain", "terrain/png", "terrain/files", "output"},
    "logger": {"base", "terrain", "terrain/png", "verifier", "bus", "terra_msg"},
    "benchmark": {"base", "terrain", "terrain/png", "terrain/files", "planner",
                  "advisor", "verifier", "output"},
    "chaos": {"terrain", "verifier", "bus", "terra_msg"},
    # A program that measures all of it.
    "benchmark/speed": {"terrain", "planner", "advisor", "verifier",
                        "benchmark", "bus", "output"},
    "cli": {"base", "terrain", "terrain/files", "planner", "advisor", "verifier",
            "logger", "benchmark", "bus", "output", "terra_msg"},
}
# Process code: files that talk to the bus. Pure files of a folder never
# include these, so the cores stay testable without a bus.
NODE_FILE = re.compile(r"(_node|_?main|_process|_codec|_options)\.(h|cc)$")
NODE_MAY_ADD = {"bus", "terra_msg", "terrain/files"}
NODE_NEVER = {"verifier": {"terrain/files"}}
# Readers of a folder's own files: no process code, but they read files. What
# uses them is process code or stands above the folder.
FILE_READER = re.compile(r"^planner/graph_file\.(h|cc)$")

# Libraries, by the prefix of the include, and the places that may use them.
LIBRARIES = {
    "lcm/": ["bus/", "logger/", "lcmtypes/"],
    "curl/": ["advisor/http_transport"],
    "httplib.h": ["advisor/sim_main"],
    "opencv2/": ["terrain/files/picture", "benchmark/panels"],
    "png.h": ["terrain/png/"],
    "CLI/": ["bus/", "cli/", "main", "_node", "_options"],
    "CLI11": ["bus/", "cli/", "main"],
    "toml++/": ["bus/toml_config"],
    "spdlog/": ["bus/", "_node", "main", "cli/"],
}


def folder_of(path):
    for folder in ("terrain/png", "terrain/files", "benchmark/speed"):
        if path.startswith(folder + "/"):
            return folder
    return path.split("/")[0]


def problem(path, included):
    """Returns what is wrong with this include, or None."""
    for prefix, places in LIBRARIES.items():
        if included.startswith(prefix) and not any(p in path for p in places):
            return f"<{prefix}...> is not for this file"
    target = folder_of(included)
    if target not in ALLOWED and target != "terra_msg":
        return None  # a system header
    own = folder_of(path)
    if target == own:
        is_node = NODE_FILE.search(path)
        if (NODE_FILE.search(included) and not is_node
                and own not in ("bus", "cli")):
            return "pure code includes process code"
        if FILE_READER.search(included) and not (is_node
                                                 or FILE_READER.search(path)):
            return "pure code includes a file reader"
        return None
    allowed = set(ALLOWED[own])
    if NODE_FILE.search(path):
        allowed |= NODE_MAY_ADD - NODE_NEVER.get(own, set())
    if FILE_READER.search(path):
        allowed.add("terrain/files")
    if target not in allowed:
        return f"{own} may not include {target}"
    return None


def check(root):
    problems = []
    for folder in FOLDERS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix not in (".h", ".cc"):
                continue
            path = file.relative_to(root).as_posix()
            for number, line in enumerate(file.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                wrong = match and problem(path, match.group(1))
                if wrong:
                    problems.append(f"{path}:{number}: {match.group(1)}: {wrong}")
    return problems


def self_test():
    """Every kind of violation must be seen, or the check proves nothing."""
    bad = [("verifier/gate.cc", "planner/coarse_lattice.h"),
           ("verifier/verify.cc", "lcm/lcm.h"),
           ("terrain/map.cc", "opencv2/core.hpp"),
           ("terrain/map.cc", "terrain/files/map_file.h"),
           ("planner/coarse_lattice.cc", "terra_msg/baseline_t.hpp"),
           ("planner/coarse_lattice.cc", "planner/planner_node.h"),
           ("planner/waypoint_graph.cc", "planner/graph_file.h"),
           ("verifier/verifier_node.cc", "terrain/files/map_file.h"),
           ("advisor/prompt.cc", "curl/curl.h")]
    good = [("verifier/verifier_node.cc", "bus/bus.h"),
            ("verifier/gate.cc", "terrain/map.h"),
            ("cli/plan_command.cc", "planner/coarse_lattice.h")]
    assert all(problem(*case) for case in bad), bad
    assert not any(problem(*case) for case in good), good


if __name__ == "__main__":
    self_test()
    found = check(pathlib.Path(sys.argv[1]))
    print("\n".join(found) or "layers are in order")
    sys.exit(1 if found else 0)
