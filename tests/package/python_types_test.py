"""Decodes the golden messages with the generated Python types and encodes them
again: the bytes must be the same, so C++ and Python agree on every type.

usage: python_types_test.py FOLDER_OF_PYTHON_PACKAGE FOLDER_OF_GOLDEN_MESSAGES
"""

import importlib
import pathlib
import sys

sys.path.insert(0, sys.argv[1])
golden = sorted(pathlib.Path(sys.argv[2]).glob("*.bin"))
types = {path.stem for path in pathlib.Path(sys.argv[1], "terra_msg").glob("*_t.py")}
assert types == {path.stem for path in golden}, "each type has a golden message"
for path in golden:
    module = importlib.import_module("terra_msg." + path.stem)
    message = getattr(module, path.stem).decode(path.read_bytes())
    assert message.encode() == path.read_bytes(), path.stem
    assert message.session != 0 and message.seq != 0, path.stem
print(f"{len(golden)} types agree")
