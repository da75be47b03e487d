"""Times scikit-image's route_through_array on the maps that terra-speed wrote.

usage: skimage_peer.py FOLDER      reads FOLDER/maps, writes FOLDER/skimage.csv

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


def time_once(costs, start, goal):
    begin = time.thread_time()
    route_through_array(costs, start, goal, fully_connected=True, geometric=True)
    return (time.thread_time() - begin) * 1e6


def main(folder):
    with open(folder / "maps" / "cases.csv", newline="") as file:
        cases = list(csv.DictReader(file))
    with open(folder / "skimage.csv", "w", newline="") as file:
        out = csv.writer(file)
        out.writerow("side family index work microseconds amount".split())
        for case in cases:
            side = int(case["side"])
            costs = numpy.fromfile(folder / "maps" / case["file"], "<f4")
            # float64, which the algorithm would convert to in every call.
            costs = costs.reshape(side, side).astype(float)
            start = int(case["start_y"]), int(case["start_x"])
            goal = int(case["goal_y"]), int(case["goal_x"])
            times = [time_once(costs, start, goal) for _ in range(ROUNDS)]
            out.writerow([side, case["family"], case["index"],
                          "scikit-image route_through_array",
                          statistics.median(times), side * side])


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
