"""Times scikit-image's route_through_array on the maps that terra-speed wrote.

usage: skimage_peer.py FOLDER    reads FOLDER/maps, writes FOLDER/samples/skimage-*

Cases that are there already are kept.

Not the same work: a step costs its length times the mean of the two cells (ours:
the cell entered), and there is no lower bound that leads the search to the goal.
"""

import csv
import pathlib
import statistics
import sys
import time

import numpy
from skimage.graph import route_through_array

ROUNDS = 3
LARGE_SIDE = 2000  # From here on one round: seconds each.


def time_once(costs, start, goal):
    begin = time.thread_time()
    route_through_array(costs, start, goal, fully_connected=True, geometric=True)
    return (time.thread_time() - begin) * 1e6


def measure(case, costs):
    """The row of a case for the samples."""
    side = int(case["side"])
    # float64, which the algorithm would convert to in every call.
    costs = costs.reshape(side, side).astype(float)
    start = int(case["start_y"]), int(case["start_x"])
    goal = int(case["goal_y"]), int(case["goal_x"])
    rounds = 1 if side >= LARGE_SIDE else ROUNDS
    times = [time_once(costs, start, goal) for _ in range(rounds)]
    return [side, case["family"], case["index"],
            "scikit-image route_through_array", statistics.median(times), side * side]


def main(folder):
    for ends in sorted((folder / "maps").glob("[!.]*.csv")):
        samples = folder / "samples" / f"skimage-{ends.name}"
        if samples.exists():
            continue
        print(f"scikit-image: {ends.stem}", file=sys.stderr)
        with open(ends, newline="") as file:
            case = next(csv.DictReader(file))
        row = measure(case, numpy.fromfile(ends.with_suffix(".f32"), "<f4"))
        part = samples.with_suffix(".part")
        with open(part, "w", newline="") as file:
            out = csv.writer(file)
            out.writerow("side family index work microseconds amount".split())
            out.writerow(row)
        part.rename(samples)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
