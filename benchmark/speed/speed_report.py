"""Makes tables and a plot of what terra-speed and its peers measured.

usage: speed_report.py FOLDER [DOCS]
       speed_report.py --redraw DOCS

Reads FOLDER/samples/*.csv and FOLDER/machine.txt, prints the tables and writes
them to FOLDER/speed.md, the plot to FOLDER/speed.svg. With DOCS also to
DOCS/performance.md, between its markers, and DOCS/images/speed.svg. --redraw
makes that plot anew from the tables that stand in DOCS/performance.md.
"""

import collections
import csv
import math
import pathlib
import re
import shutil
import statistics
import sys

from docs_section import write_between_markers

FAMILIES = ["easy", "hard"]
GRAPH_PEERS = ["Boost.Graph A*", "LEMON A*"]
SKIMAGE = "scikit-image route_through_array"
PEERS = ["textbook A*", *GRAPH_PEERS, SKIMAGE]
INSTRUCTIONS = ["AVX-512", "AVX2", "portable"]
# Native searches: told the baseline's cost, or that of a lattice within their
# time, or nothing.
KNOWN = "search, {}, bounded"
LATTICE = "lattice, search, {}"
ALONE = "search, {}"
# A median over fewer maps says more of these maps than of their size: it is a
# point, not part of a line.
MIN_TREND_MAPS = 5
GROWTH = "### Searches by side: median, milliseconds\n"


class Samples:
    """Times in microseconds by (side, family, work), one per map."""

    def __init__(self, folder):
        self.times = collections.defaultdict(list)
        self.rates = collections.defaultdict(list)  # Microseconds per amount.
        for path in sorted((folder / "samples").glob("[!.]*.csv")):
            with open(path, newline="") as file:
                for row in csv.DictReader(file):
                    key = int(row["side"]), row["family"], row["work"]
                    time = float(row["microseconds"])
                    self.times[key].append(time)
                    self.rates[key].append(time / float(row["amount"]))

    def has(self, side, family, work):
        return (side, family, work) in self.times

    def median(self, side, family, work):
        return statistics.median(self.times[side, family, work])

    def p95(self, side, family, work):
        return p95(self.times[side, family, work])

    def rate(self, side, family, work):
        return statistics.median(self.rates[side, family, work])

    def sides(self):
        return sorted({side for side, family, _ in self.times
                       if family in FAMILIES})

    def maps(self, side):
        """How many of each family."""
        return len(self.times[side, "easy", "floor"])

    def works(self):
        return search_works(self)

    def best(self):
        """The widest instruction set that was measured."""
        return next(name for name in INSTRUCTIONS
                    if self.has(500, "easy", f"search, {name}"))

    def faster_graph_peer(self, statistic, family):
        return min(statistic(500, family, peer) for peer in GRAPH_PEERS)


def p95(values):
    """Nearest rank."""
    return sorted(values)[math.ceil(0.95 * len(values)) - 1]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |",
             "|" + "---|" + "---:|" * (len(head) - 1)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def milliseconds(microseconds):
    return f"{microseconds / 1000:.3g}"


def figures(s):
    """Rows of (what, wanted, easy, hard), each measured figure with a mark."""
    best = s.best()
    rows = []

    def add(what, wanted, measure, reached, form):
        row = [what, wanted]
        for family, bound in zip(FAMILIES, reached):
            value = measure(family)
            row.append(form.format(value) + ("" if bound(value) else " (missed)"))
        rows.append(row)

    def at_least(*bounds):
        return [lambda v, b=b: v >= b for b in bounds]

    def at_most(bound):
        return [lambda v: v <= bound] * 2

    def ratio(statistic, work):
        return lambda family: (s.faster_graph_peer(statistic, family) /
                               statistic(500, family, work))

    def simple(statistic, work, scale=1.0):
        return lambda family: statistic(500, family, work) * scale

    for form, told in [(LATTICE, "with its own lattice"),
                       (KNOWN, "baseline's cost known"), (ALONE, "alone")]:
        work = form.format("portable")
        add(f"Portable search, {told}, against the faster graph peer: median",
            "8 times", ratio(s.median, work), at_least(8, 8), "{:.1f} times")
        add(f"Portable search, {told}: p95", "8 times", ratio(s.p95, work),
            at_least(8, 8), "{:.1f} times")
        for name in INSTRUCTIONS[:2]:
            work = form.format(name)
            if not s.has(500, "easy", work):
                continue
            hard = 25 if name == "AVX-512" else 15
            add(f"{name} search, {told}: median", f"10 / {hard} times",
                ratio(s.median, work), at_least(10, hard), "{:.1f} times")
            add(f"{name} search, {told}: p95", "30 times", ratio(s.p95, work),
                at_least(30, 30), "{:.1f} times")
    add(f"{best} search, baseline's cost known, against the floor", "5 times",
        lambda f: s.median(500, f, f"search, {best}, bounded") /
        s.median(500, f, "floor"), at_most(5), "{:.2f} times")
    for form, told in [(LATTICE, "with its own lattice"), (ALONE, "alone")]:
        for work in [form.format(name) for name in INSTRUCTIONS[:2]]:
            if s.has(500, "easy", work):
                add(f"{work.split(', ')[-1]} search, {told}, largest over all sides",
                    "2.5 ns a cell",
                    lambda f, w=work: 1000 * max(
                        s.rate(side, f, w) for side in s.sides()),
                    at_most(2.5), "{:.2f} ns")
    add("Lattice, stride 50: median", "15 us", simple(s.median, "lattice r=50"),
        at_most(15), "{:.1f} us")
    add("Verify: median", "1.5 ns a cell", lambda f: 1000 * s.rate(500, f, "verify"),
        at_most(1.5), "{:.2f} ns")
    add("Shortcut: median", "5 ms", simple(s.median, "shortcut", 1e-3), at_most(5),
        "{:.2f} ms")
    add("Shortcut: p95", "5 ms", simple(s.p95, "shortcut", 1e-3), at_most(5),
        "{:.2f} ms")
    chain = "baseline, search, verify"
    add("Baseline, search and verify: median", "0.6 ms",
        simple(s.median, chain, 1e-3), at_most(0.6), "{:.3f} ms")
    add("Baseline, search and verify: p95", "1.2 ms", simple(s.p95, chain, 1e-3),
        at_most(1.2), "{:.3f} ms")
    add("LLM input, three pictures and text: median", "15 ms",
        simple(s.median, "LLM input", 1e-3), at_most(15), "{:.2f} ms")
    add("Map digest", "5 GB/s", lambda f: 1e-3 / s.rate(500, f, "map digest"),
        at_least(5, 5), "{:.1f} GB/s")
    add("Tile compression", "150 MB/s",
        lambda f: 1 / s.rate(500, f, "tile compression"), at_least(150, 150),
        "{:.0f} MB/s")
    return rows


def search_works(s):
    works = []
    for name in INSTRUCTIONS:
        works += [form.format(name) for form in (KNOWN, LATTICE, ALONE)]
    return [w for w in works + ["floor", *PEERS] if s.has(500, "easy", w)]


def search_rows(s):
    """Times at 500 x 500, and how often the best bounded search fits in."""
    reference = KNOWN.format(s.best())
    for work in search_works(s):
        row = [work]
        for f in FAMILIES:
            row += [milliseconds(s.median(500, f, work)),
                    milliseconds(s.p95(500, f, work)),
                    f"{s.median(500, f, work) / s.median(500, f, reference):.3g}"]
        yield row


def growth_rows(s, works, cell):
    for work in works:
        for f in FAMILIES:
            yield [work, f] + [cell(side, f, work) if s.has(side, f, work) else ""
                               for side in s.sides()]


def worst_rows(s):
    textbook = "textbook A*"
    for side, family, work in s.times:
        if work == textbook and family not in FAMILIES:
            times = [s.median(side, family, w)
                     for w in ["search", "search, portable", textbook]]
            yield [family, *map(milliseconds, times),
                   f"{times[0] / times[2]:.2f}", f"{times[1] / times[2]:.2f}"]


def number_of_maps(s):
    return ", ".join(f"{s.maps(side)} at {side}" for side in s.sides())


def side_heads(s):
    """The sides; with their maps where those are too few for a trend."""
    return [str(side) if s.maps(side) >= MIN_TREND_MAPS
            else f"{side} ({s.maps(side)} map{'s'[:s.maps(side) > 1]})"
            for side in s.sides()]


def markdown(s, machine):
    sides = side_heads(s)
    time = lambda *key: milliseconds(s.median(*key))  # noqa: E731
    rate = lambda *key: f"{1000 * s.rate(*key):.2f}"  # noqa: E731
    chain = ["lattice r=50", "shortcut", "baseline, search, verify", "LLM input"]
    rates = ["verify", "map digest", "tile compression"]
    return "\n".join([
        machine,
        f"Maps of each subset: {number_of_maps(s)}.\n",
        "### Figures to reach (500 x 500; Easy, Hard)\n",
        table(["Figure", "Wanted", "Easy", "Hard"], figures(s)),
        "### Searches, 500 x 500: milliseconds, and times the bounded search\n",
        table(["Work", "Easy median", "p95", "times", "Hard median", "p95",
               "times"], search_rows(s)),
        GROWTH,
        table(["Work", "Maps", *sides], growth_rows(s, search_works(s), time)),
        "### Searches by side: median, nanoseconds per cell of the map\n",
        table(["Work", "Maps", *sides], growth_rows(s, search_works(s), rate)),
        "### The rest by side: median, milliseconds\n",
        table(["Work", "Maps", *sides], growth_rows(s, chain, time)),
        "### The rest by side: median, nanoseconds per cell (of the route) or byte\n",
        table(["Work", "Maps", *sides], growth_rows(s, rates, rate)),
        "### Worst cases, 500 x 500: milliseconds, and parts of a textbook A*\n",
        table(["Map", "search", "portable", "textbook A*", "search / textbook",
               "portable / textbook"], worst_rows(s)),
    ])


class Documented:
    """The medians of searches as a document's tables have them."""

    def __init__(self, text):
        maps = re.search(r"^Maps of each subset: (.*)\.$", text, re.M).group(1)
        self._maps = {int(side): int(number) for number, side
                      in re.findall(r"(\d+) at (\d+)", maps)}
        rows = text.split(GROWTH)[1].strip().split("\n\n")[0].splitlines()[2:]
        self._medians = {}
        for row in rows:
            work, family, *times = [c.strip() for c in row.strip("|").split("|")]
            for side, time in zip(self.sides(), times):
                if time:
                    self._medians[side, family, work] = 1000 * float(time)

    def sides(self):
        return sorted(self._maps)

    def maps(self, side):
        return self._maps[side]

    def works(self):
        return list(dict.fromkeys(work for _, _, work in self._medians))

    def has(self, side, family, work):
        return (side, family, work) in self._medians

    def median(self, side, family, work):
        """In microseconds."""
        return self._medians[side, family, work]


def trend_and_points(s, family, work):
    """Two lists of (side, milliseconds): where there are maps enough for a line,
    and where not."""
    trend, points = [], []
    for side in s.sides():
        if s.has(side, family, work):
            place = trend if s.maps(side) >= MIN_TREND_MAPS else points
            place.append((side, s.median(side, family, work) / 1000))
    return trend, points


def plot(s, path):
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "terra"  # The same bytes every time.
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(9, 4), sharey=True)
    for axis, family in zip(axes, FAMILIES):
        for work in s.works():
            trend, points = trend_and_points(s, family, work)
            line, = axis.plot(
                *zip(*trend), marker="o", markersize=3, label=work,
                linestyle=":" if work in [*PEERS, "floor"] else "-")
            line.set_gid(f"trend {family} {work}")
            if points:
                single, = axis.plot(*zip(*points), linestyle="", marker="o",
                                    markersize=4, fillstyle="none",
                                    color=line.get_color())
                single.set_gid(f"points {family} {work}")
        axis.set_title(family)
        axis.set_xscale("log", base=2)
        axis.set_yscale("log")
        axis.set_xticks(s.sides(), [head.replace(" ", "\n", 1)
                                    for head in side_heads(s)], fontsize=8)
        axis.set_xlabel("side of the map, cells")
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("median, ms")
    axes[1].legend(fontsize=7, loc="upper left", bbox_to_anchor=(1, 1))
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def write_docs(folder, docs, text):
    shutil.copyfile(folder / "speed.svg", docs / "images" / "speed.svg")
    write_between_markers(docs / "performance.md", "speed", text)


def main(folder, docs=None):
    samples = Samples(folder)
    text = markdown(samples, (folder / "machine.txt").read_text())
    (folder / "speed.md").write_text(text)
    plot(samples, folder / "speed.svg")
    if docs:
        write_docs(folder, docs, text)
    print(text)


def redraw(docs):
    plot(Documented((docs / "performance.md").read_text()),
         docs / "images" / "speed.svg")


if __name__ == "__main__":
    if sys.argv[1] == "--redraw":
        redraw(pathlib.Path(sys.argv[2]))
    else:
        main(*map(pathlib.Path, sys.argv[1:]))
