"""Checks that every link and picture in the documents leads somewhere.

usage: links_test.py SOURCE_FOLDER

Prints FILE:LINE of each that does not, and exits with 1. In a checkout of git
the target must be known to git, so that it is there for everybody. Links to
other hosts are not looked at.
"""

import pathlib
import re
import subprocess
import sys

LINK = re.compile(r"\]\(\s*<?([^)\s>]+)>?[^)]*\)|(?:src|href)=\"([^\"]+)\"")
FENCE = re.compile(r"^\s*(```|~~~)")
CODE = re.compile(r"`[^`]*`")


def known_files(root):
    """Paths below root that everybody has, or None outside git."""
    try:
        listed = subprocess.run(["git", "-C", root, "ls-files", "-z", "--cached",
                                 "--others", "--exclude-standard"],
                                capture_output=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return {root / name for name in listed.stdout.decode().split("\0") if name}


def anchors(document):
    """The anchors of a document's headings, as GitHub makes them."""
    found, fenced = set(), False
    for line in document.read_text(encoding="utf-8").splitlines():
        if FENCE.match(line):
            fenced = not fenced
        elif not fenced and line.startswith("#"):
            text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", line.lstrip("#").strip())
            slug = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
            number = sum(1 for one in found if re.fullmatch(
                re.escape(slug) + r"(-\d+)?", one))
            found.add(f"{slug}-{number}" if slug in found else slug)
    return found


def links(document):
    """Yields (line number, target) of a document, code left out."""
    fenced = False
    for number, line in enumerate(
            document.read_text(encoding="utf-8").splitlines(), 1):
        if FENCE.match(line):
            fenced = not fenced
        elif not fenced:
            for match in LINK.finditer(CODE.sub("", line)):
                yield number, match.group(1) or match.group(2)


def problem(document, target, files):
    if re.match(r"[a-z][a-z0-9+.-]*:", target, re.I):
        return None
    path, _, anchor = target.partition("#")
    place = (document.parent / path).resolve() if path else document
    if not place.exists():
        return "is not there"
    if files is not None and place.is_file() and place not in files:
        return "is not in the repository"
    if anchor and place.suffix == ".md" and anchor not in anchors(place):
        return "has no such heading"
    return None


def self_test(root):
    """Every kind of fault must be seen, or the check proves nothing."""
    readme = root / "README.md"
    for target in ("docs/images/no-such.png", "docs/gate.md#no-such-heading",
                   "#no-such-heading"):
        assert problem(readme, target, None), target
    assert problem(readme, "README.md", set())
    assert not problem(readme, "docs/gate.md", None)


def main(root):
    self_test(root)
    files = known_files(root)
    documents = sorted({*root.glob("*.md"), *(root / "docs").rglob("*.md"),
                        *(root / "examples").rglob("*.md")})
    faults, count = [], 0
    for document in documents:
        for number, target in links(document):
            count += 1
            what = problem(document, target, files)
            if what:
                name = document.relative_to(root)
                faults.append(f"{name}:{number}: {target} {what}")
    assert count > 20, count
    print("\n".join(faults) or f"{count} links lead somewhere")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
