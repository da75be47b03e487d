"""The build files ask for no newer CMake than they say, and no preset for more
than users have. Where this host's CMake is newer, only a look at the words tells.

usage: old_cmake_test.py SOURCE_FOLDER
"""

import json
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(sys.argv[1])
OLDEST, OLDEST_FOR_PRESETS = (3, 18), (3, 20)
# What came after CMake 3.18, as one writes it, and when.
NEWER = {
    r"\bcmake_path\s*\(": "3.20",
    r"\bblock\s*\(": "3.25",
    r"\bcmake_language\s*\(\s*(DEFER|SET_DEPENDENCY_PROVIDER|GET_MESSAGE_LOG_LEVEL|EXIT)": "3.19",
    r"\bfind_package\s*\([^)]*\bGLOBAL\b": "3.24",
    r"\bfind_package\s*\(\s*GTest\b(?![^)]*\bCONFIG\b)": "3.20 for gmock",
    r"\bfind_(path|library|file|program)\s*\([^)]*\bNO_CACHE\b": "3.21",
    r"\bfind_(path|library|file|program)\s*\([^)]*\bVALIDATOR\b": "3.25",
    r"\breturn\s*\(\s*PROPAGATE": "3.25",
    r"\bstring\s*\(\s*JSON\b": "3.19",
    r"\bfile\s*\(\s*(REAL_PATH|CHMOD|CHMOD_RECURSE|COPY_FILE)\b": "3.19",
    r"\bFILE_SET\b": "3.23",
    r"\bCOMMAND_ERROR_IS_FATAL\b": "3.19",
    r"\bENVIRONMENT_MODIFICATION\b": "3.22",
    r"\bIMPORTED_RUNTIME_ARTIFACTS\b|\bRUNTIME_DEPENDENCIES\b|\bRUNTIME_DEPENDENCY_SET\b": "3.21",
    r"COMPILE_WARNING_AS_ERROR\b": "3.24",
    r"\bLINK_LIBRARY_OVERRIDE\b|\$<LINK_(LIBRARY|GROUP):": "3.24",
    r"\$<(PATH|PATH_EQUAL|TARGET_RUNTIME_DLLS|LIST|BUILD_LOCAL_INTERFACE|QUOTE)[:>]": "3.24",
    r"\bPROJECT_IS_TOP_LEVEL\b": "3.21",
    r"\bcxx_std_26\b": "3.25",
}
# One of each kind, so that a pattern which finds nothing is noticed.
EXAMPLES = [
    "cmake_path(GET x PARENT_PATH y)", "block()", "find_package(spdlog REQUIRED GLOBAL)",
    "find_package(GTest REQUIRED)", "find_path(A b.h NO_DEFAULT_PATH NO_CACHE)",
    "find_library(A b\n  VALIDATOR f)", "return(PROPAGATE a)", "string(JSON a GET b c)",
    "file(REAL_PATH a b)", "execute_process(COMMAND a COMMAND_ERROR_IS_FATAL ANY)",
    "target_sources(a PUBLIC FILE_SET HEADERS)", "cmake_language(DEFER CALL f)",
    "install(TARGETS a RUNTIME_DEPENDENCIES)", "$<PATH:GET_FILENAME,a>",
    "if(PROJECT_IS_TOP_LEVEL)", "set_tests_properties(a PROPERTIES ENVIRONMENT_MODIFICATION b)",
    "set(CMAKE_COMPILE_WARNING_AS_ERROR ON)",
]


def newer_words(text):
    text = re.sub(r"(?m)#.*$", "", text)
    return [(match.group(0), since) for pattern, since in NEWER.items()
            for match in re.finditer(pattern, text)]


def build_files():
    for pattern in ("CMakeLists.txt", "*.cmake", "*.cmake.in"):
        for path in SOURCE.rglob(pattern):
            if path.relative_to(SOURCE).parts[0] not in ("build", "out"):
                yield path


class BuildFiles(unittest.TestCase):
    def test_use_no_word_of_a_newer_cmake(self):
        paths = list(build_files())
        self.assertGreater(len(paths), 30)
        for path in paths:
            self.assertEqual(newer_words(path.read_text()), [], path)

    def test_such_words_are_found(self):
        for example in EXAMPLES:
            self.assertNotEqual(newer_words(example), [], example)
        self.assertEqual(newer_words("# block()\nfind_package(GTest CONFIG REQUIRED)"), [])

    def test_ask_for_the_oldest_alone(self):
        asked = []
        for path in build_files():
            asked += re.findall(r"(?m)^cmake_minimum_required\(VERSION (\d+)\.(\d+)",
                                path.read_text())
        self.assertGreaterEqual(len(asked), 2)
        self.assertEqual({tuple(map(int, version)) for version in asked}, {OLDEST})


class Presets(unittest.TestCase):
    def setUp(self):
        self.presets = json.loads((SOURCE / "CMakePresets.json").read_text())

    def test_are_of_the_version_that_the_oldest_cmake_with_presets_reads(self):
        self.assertEqual(self.presets["version"], 2)
        minimum = self.presets["cmakeMinimumRequired"]
        self.assertEqual((minimum["major"], minimum["minor"]), OLDEST_FOR_PRESETS)
        # This host's CMake refuses what a file of that version may not hold.
        done = subprocess.run(["cmake", "--list-presets"], cwd=SOURCE, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn('"release"', done.stdout)

    def test_none_takes_warnings_for_errors(self):
        """Users have compilers that nobody tried; scripts/test --ci asks for it."""
        values = [preset["cacheVariables"]["TERRA_WERROR"]
                  for preset in self.presets["configurePresets"]
                  if "TERRA_WERROR" in preset.get("cacheVariables", {})]
        # Said at the root, so that a build folder of before forgets its ON.
        self.assertEqual(values, ["OFF"])
        base = self.presets["configurePresets"][0]
        self.assertEqual((base["name"], base["cacheVariables"]["TERRA_WERROR"]),
                         ("base", "OFF"))

    def test_the_readme_names_these_versions(self):
        readme = (SOURCE / "README.md").read_text()
        for major, minor in (OLDEST, OLDEST_FOR_PRESETS):
            self.assertTrue(f"{major}.{minor}" in readme, f"{major}.{minor}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
