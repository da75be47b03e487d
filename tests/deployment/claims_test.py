"""Each claim of the threat model names what shows it, and that is there: fault
rows, GoogleTest tests, fuzz targets.

usage: claims_test.py SOURCE_FOLDER
"""
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(sys.argv[1])
page = (root / "docs" / "deployment.md").read_text()
model = page[page.index("## Who may speak"):page.index("## Watching it")]

rows = subprocess.run(
    [sys.executable, str(root / "tests" / "faults" / "faults.py"), "--bin", ".", "--list"],
    capture_output=True, text=True, check=True).stdout
known_rows = {re.split(r"  \[", line)[0] for line in rows.splitlines()}
sources = "".join(path.read_text() for path in root.glob("tests/**/*_test.cc"))
known_tests = {f"{suite}.{name}" for suite, name in
               re.findall(r"(?:TYPED_TEST|TEST(?:_F|_P)?|RC_GTEST_PROP)\(\s*(\w+),\s*(\w+)",
                          sources)}
known_targets = {path.name for path in (root / "tests" / "fuzz" / "corpus").iterdir()}

faults = []
shown = 0
for kind, known in [("row \"([^\"]+)\"", known_rows), ("test `(\\w+\\.\\w+)`", known_tests),
                    ("fuzz target `(\\w+)`", known_targets)]:
    for name in re.findall(kind, model):
        shown += 1
        if name not in known:
            faults.append(f"docs/deployment.md names what is not there: {name}")
for line in model.splitlines():
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    if line.startswith("|") and len(cells) == 2 and cells[0] not in ("claim", "---"):
        if not re.search('row "|test `|fuzz target `', cells[1]):
            faults.append(f"docs/deployment.md: nothing shows: {cells[0]}")
if shown < 15:
    faults.append(f"only {shown} rows and tests found: has the page another form?")
print("\n".join(faults) or f"{shown} rows, tests and targets show the claims")
sys.exit(1 if faults else 0)
