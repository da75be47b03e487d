"""Replaces a measured section of a document; all around it stays.

usage: docs_section.py DOCUMENT NAME TEXT_FILE

The section is what stands between the lines <!-- NAME: begin --> and
<!-- NAME: end -->; without exactly one of each it ends with an error.
"""

import pathlib
import sys


def write_between_markers(document, name, text):
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    old = document.read_text()
    if old.count(begin) != 1 or old.count(end) != 1:
        sys.exit(f"{document}: no single section {name}")
    before, rest = old.split(begin)
    after = rest.split(end)[1]
    document.write_text(f"{before}{begin}{text.strip()}\n{end}{after}")


if __name__ == "__main__":
    write_between_markers(pathlib.Path(sys.argv[1]), sys.argv[2],
                          pathlib.Path(sys.argv[3]).read_text())
