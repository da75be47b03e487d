"""speed_report.py draws a trend only where there are maps enough, and the
figure in the docs is drawn from the tables beside it.

usage: speed_report_test.py SOURCE_FOLDER
"""

import pathlib
import re
import sys
import unittest
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(sys.argv.pop(1))
sys.path.insert(0, str(ROOT / "benchmark" / "speed"))
import speed_report  # noqa: E402

DOCS = ROOT / "docs"
SVG = "{http://www.w3.org/2000/svg}"


class SpeedReport(unittest.TestCase):
    def setUp(self):
        self.figures = speed_report.Documented(
            (DOCS / "performance.md").read_text())

    def test_sides_with_few_maps_are_points(self):
        self.assertEqual(self.figures.sides(), [500, 1000, 2000, 4000])
        self.assertEqual(self.figures.maps(4000), 1)
        trend, points = speed_report.trend_and_points(
            self.figures, "easy", "search, portable")
        self.assertEqual(trend, [(500, 0.488), (1000, 2.38)])
        self.assertEqual(points, [(2000, 13.3), (4000, 0.294)])

    def test_heads_name_the_number_of_few_maps(self):
        self.assertEqual(speed_report.side_heads(self.figures),
                         ["500", "1000", "2000 (3 maps)", "4000 (1 map)"])
        head = "| Work | Maps | 500 | 1000 | 2000 (3 maps) | 4000 (1 map) |"
        self.assertEqual((DOCS / "performance.md").read_text().count(head), 4)

    def test_the_figure_in_the_docs_has_these_lines_and_points(self):
        drawn = {}
        tree = ElementTree.parse(DOCS / "images" / "speed.svg")
        for group in tree.iter(SVG + "g"):
            name = group.get("id", "")
            if name.startswith("trend "):
                path = group.find(SVG + "path")
                drawn[name] = len(re.findall("[ML]", path.get("d")))
            elif name.startswith("points "):
                drawn[name] = len(list(group.iter(SVG + "use")))
        wanted = {}
        for family in speed_report.FAMILIES:
            for work in self.figures.works():
                trend, points = speed_report.trend_and_points(
                    self.figures, family, work)
                wanted[f"trend {family} {work}"] = len(trend)
                wanted[f"points {family} {work}"] = len(points)
        self.assertEqual(drawn, wanted)


if __name__ == "__main__":
    unittest.main()
