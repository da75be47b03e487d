"""A build in a folder with a difficult name, against an LCM of one's own in a
prefix: it is found, the installed programs will find it, terra_stack builds all
that is installed, and the jar for lcm-spy needs no locale.

usage: own_lcm_test.py SOURCE_FOLDER LCM_INCLUDE_FOLDER LCM_LIBRARY LCM_GEN
                       CXX_COMPILER [LCM_JAR]
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE, INCLUDE, LIBRARY, GEN, COMPILER = sys.argv[1:6]
JAR = sys.argv[6] if len(sys.argv) > 6 else None


def run(*command, **kwargs):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, **kwargs)
    assert done.returncode == 0, done.stdout
    return done.stdout


class OwnLcm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="terra-lcm-")
        top = pathlib.Path(cls.folder.name) / "Gelände karte"
        cls.prefix, cls.build = top / "lcm", top / "build"
        shutil.copytree(pathlib.Path(INCLUDE) / "lcm", cls.prefix / "include/lcm")
        for source, target in ((LIBRARY, "lib"), (GEN, "bin"), (JAR, "share/java")):
            if source is not None:
                (cls.prefix / target).mkdir(parents=True)
                shutil.copy(source, cls.prefix / target)
        # Without a locale, as in a container or a unit.
        cls.environment = {key: value for key, value in os.environ.items()
                           if key != "LANG" and not key.startswith("LC_")}
        cls.environment["CMAKE_PREFIX_PATH"] = str(cls.prefix)
        run("cmake", "-S", SOURCE, "-B", cls.build, "-G", "Ninja",
            f"-DCMAKE_CXX_COMPILER={COMPILER}", "-DCMAKE_BUILD_TYPE=Release",
            "-DTERRA_BUILD_TESTS=OFF",
            f"-DTERRA_BUILD_JAVA={'ON' if JAR else 'OFF'}", env=cls.environment)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def install_rules(self):
        return "\n".join(path.read_text() for path in self.build.rglob("cmake_install.cmake"))

    def test_is_found_whole(self):
        cache = (self.build / "CMakeCache.txt").read_text()
        names = ["LIBRARY", "INCLUDE_DIR", "GEN"] + (["JAR"] if JAR else [])
        for name in names:
            self.assertRegex(cache, rf"(?m)^LCM_{name}:\w+={re.escape(str(self.prefix))}/")

    def test_installed_programs_find_it(self):
        paths = re.findall(r'NEW_RPATH "([^"]*)"', self.install_rules())
        self.assertGreaterEqual(len(paths), 8)
        # terra-llm-sim has no bus.
        with_lcm = [path for path in paths if str(self.prefix / "lib") in path.split(":")]
        self.assertGreaterEqual(len(with_lcm), 8, paths)

    def test_the_package_tells_where_it_is(self):
        config = (self.build / "TerraAdvisorConfig.cmake").read_text()
        self.assertIn(f'"{self.prefix}"', config)

    def test_terra_stack_builds_all_that_is_installed(self):
        build = re.escape(str(self.build))
        wanted = set(re.findall(rf'"({build}/[^"]+)"', self.install_rules()))
        wanted = {path for path in wanted if not os.path.exists(path)
                  and "/CMakeFiles/" not in path and "$" not in path
                  and not path.endswith(".txt")}
        self.assertTrue({"terra", "terra-verifier", "libterra_verifier.a"} <=
                        {os.path.basename(path) for path in wanted}, wanted)
        commands = run("ninja", "-C", self.build, "-t", "commands", "terra_stack")
        for path in wanted:
            # A folder of generated types: its generator gets the folder above.
            names = (path, os.path.relpath(path, self.build))
            if os.path.basename(path) == "terra_msg":
                names = (os.path.dirname(path),)
            self.assertTrue(any(name in commands for name in names), path)

    @unittest.skipUnless(JAR, "configured without Java")
    def test_the_jar_needs_no_locale(self):
        run("cmake", "--build", self.build, "--target", "terra_msg_jar",
            env=self.environment)
        self.assertTrue((self.build / "lcmtypes/lcmtypes_terra.jar").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
