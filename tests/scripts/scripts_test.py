"""The scripts on machines of users: an LCM of one's own, no root, no network, a
checkout that nobody may write to, folders with spaces and umlauts. Programs that
would change the machine are stand-ins that write down how they were called.

usage: scripts_test.py SOURCE_FOLDER
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1])
SHELL_SCRIPTS = ("run", "test", "install", "bench", "bench-latency", "bench-speed",
                 "faults", "fuzz", "soak", "lcm-spy")
# The user's own programs; everything else is a stand-in or is not there.
REAL = ("bash", "sh", "env", "dirname", "basename", "awk", "grep", "sed", "head", "tail",
        "cat", "mkdir", "mktemp", "rm", "realpath", "install", "tee", "test", "touch",
        "seq", "ls")


class Machine:
    """A checkout in a folder with a difficult name, and the programs on PATH."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder) / "Prüf stand"
        self.checkout = self.folder / "terra advisor"
        self.programs = self.folder / "bin"
        self.calls_file = self.folder / "calls"
        self.programs.mkdir(parents=True)
        shutil.copytree(SOURCE / "scripts", self.checkout / "scripts")
        for name in ("docs", "systemd", "examples"):
            shutil.copytree(SOURCE / name, self.checkout / name)
        for name in REAL:
            (self.programs / name).symlink_to(shutil.which(name))
        self.stand_in("id", "echo 1000")
        self.stand_in("dpkg-query", "echo installed")
        self.stand_in("ip", "exit 0")
        self.stand_in("cmake", "exit 0")
        self.stand_in("apt-get", "exit 0")

    def stand_in(self, name, body):
        path = self.programs / name
        path.write_text(f"""#!/bin/sh\nprintf '%s\\n' "{name} $*" >>"{self.calls_file}"\n{body}\n""")
        path.chmod(0o755)

    def with_sudo(self):
        self.stand_in("sudo", 'exec "$@"')

    def without_packages(self, pattern):
        self.stand_in("dpkg-query",
                      f'for last; do :; done\ncase $last in {pattern}) exit 1 ;; esac\n'
                      'echo installed')

    def run(self, *command, **environment):
        return subprocess.run(
            [str(word) for word in command], stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120,
            cwd=self.checkout, env={"PATH": str(self.programs), **environment})

    def script(self, name, *options, **environment):
        return self.run(self.checkout / "scripts" / name, *options, **environment)

    def setup(self, commands, *options, **environment):
        """Bash commands after setup.sh."""
        return self.run("bash", "-c", "set -euo pipefail\nsource scripts/setup.sh\n"
                        + commands, "a-script", *options, **environment)

    def calls(self, name):
        if not self.calls_file.exists():
            return []
        return [line for line in self.calls_file.read_text().splitlines()
                if line.split()[0] == name]


class MachineTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="terra-scripts-")
        self.addCleanup(folder.cleanup)
        self.machine = Machine(folder.name)


class EveryScript(MachineTest):
    def test_helps_in_any_folder_with_and_without_no_install(self):
        for name in SHELL_SCRIPTS:
            for options in (["--help"], ["-h"], ["--no-install", "--help"]):
                if name == "lcm-spy" and len(options) > 1:
                    continue  # It installs nothing.
                done = self.machine.script(name, *options)
                self.assertEqual(done.returncode, 0, done.stdout)
                self.assertIn("usage: ", done.stdout)

    def test_finds_its_folder_where_cd_has_a_search_path(self):
        done = self.machine.run("bash", "scripts/run", "--help", CDPATH=".:/")
        self.assertEqual(done.returncode, 0, done.stdout)
        done = self.machine.setup('echo "root=$root"', CDPATH=".:/")
        self.assertEqual(done.stdout, f"root={self.machine.checkout}\n")

    def test_hands_no_install_on_and_leaves_the_other_options(self):
        done = self.machine.setup('echo "$TERRA_NO_INSTALL|$*"',
                                  "--a", "--no-install", "b c", "--", "--no-install")
        self.assertEqual(done.stdout, "yes|--a b c -- --no-install\n")
        done = self.machine.setup('echo "$TERRA_NO_INSTALL|$#"')
        self.assertEqual(done.stdout, "|0\n")


class Packages(MachineTest):
    def install(self, *options):
        return self.machine.setup("install_packages run; echo went on", *options)

    def test_none_is_installed_where_all_are_there(self):
        self.assertEqual(self.install().stdout, "went on\n")
        self.assertEqual(self.machine.calls("cmake"), [])

    def test_one_that_is_there_for_two_architectures_is_there(self):
        self.machine.stand_in("dpkg-query", "echo installed; echo installed")
        self.assertEqual(self.install().stdout, "went on\n")
        self.assertEqual(self.machine.calls("cmake"), [])
        self.machine.stand_in("dpkg-query", "echo config-files")
        self.machine.stand_in("cmake", "exit 1")
        self.assertEqual(self.install("--no-install").returncode, 0)
        self.assertEqual(len(self.machine.calls("cmake")), 0)

    def test_an_lcm_of_ones_own_is_enough_where_the_build_configures(self):
        self.machine.without_packages("liblcm*")
        done = self.install()
        self.assertEqual((done.returncode, done.stdout), (0, "went on\n"))
        self.assertEqual(self.machine.calls("apt-get"), [])

    def test_what_is_missing_beside_it_is_installed_alone(self):
        self.machine.with_sudo()
        self.machine.without_packages("liblcm*|libeigen3-dev")
        self.machine.stand_in("cmake", f"grep -q 'install -q' '{self.machine.calls_file}'")
        done = self.install()
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(self.machine.calls("apt-get")[1:],
                         ["apt-get install -q -y --no-install-recommends libeigen3-dev"])

    def test_the_distributions_lcm_is_installed_where_there_is_no_other(self):
        self.machine.with_sudo()
        self.machine.without_packages("liblcm*|libeigen3-dev")
        self.machine.stand_in("cmake", "exit 1")
        done = self.install()
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual([call.split()[-1] for call in self.machine.calls("apt-get")],
                         ["-q", "libeigen3-dev", "liblcm-bin"])

    def test_no_install_installs_nothing_and_names_it(self):
        self.machine.with_sudo()
        self.machine.without_packages("liblcm*")
        self.machine.stand_in("cmake", "exit 1")
        done = self.install("--no-install")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("liblcm-dev liblcm-bin", done.stdout)
        self.assertEqual(self.machine.calls("apt-get"), [])

    def test_without_root_it_says_what_root_should_install(self):
        self.machine.without_packages("libeigen3-dev")
        self.machine.stand_in("cmake", "exit 1")
        done = self.install()
        self.assertEqual(done.returncode, 1)
        self.assertIn("apt-get install libeigen3-dev", done.stdout)
        self.assertIn("--no-install", done.stdout)
        self.assertNotIn("went on", done.stdout)

    def test_without_a_network_it_shows_what_apt_said(self):
        self.machine.with_sudo()
        self.machine.without_packages("spin")
        self.machine.stand_in("apt-get", "echo 'could not resolve the mirror'; exit 100")
        done = self.machine.setup("install_packages run test")
        self.assertEqual(done.returncode, 1)
        self.assertIn("could not resolve the mirror", done.stdout)
        self.assertIn("apt-get install spin", done.stdout)


class Multicast(MachineTest):
    def test_without_root_both_commands_are_named_and_the_way_without_root(self):
        self.machine.stand_in("ip", "exit 2")
        done = self.machine.setup("ensure_multicast; echo went on")
        self.assertEqual(done.returncode, 1)
        told = done.stdout[done.stdout.index("error:"):]
        self.assertIn("\n  ip link set lo up multicast on\n", told)
        self.assertIn("\n  ip route add 224.0.0.0/4 dev lo\n", told)
        self.assertIn("unshare -rn", told)
        self.assertNotIn("went on", done.stdout)

    def test_without_the_tool_nothing_is_claimed(self):
        (self.machine.programs / "ip").unlink()
        self.assertEqual(self.machine.setup("ensure_multicast; echo went on").stdout,
                         "went on\n")

    def test_with_root_both_are_run(self):
        self.machine.with_sudo()
        self.machine.stand_in("ip", """[ "$1 $2" != 'route get' ]""")
        done = self.machine.setup("ensure_multicast")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(self.machine.calls("ip")[1:], [
            "ip link set lo up multicast on", "ip route add 224.0.0.0/4 dev lo"])


class Build(MachineTest):
    BUILD = "build release terra_stack; echo went on"

    def assert_ends(self, done, reason):
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn(reason, done.stdout)
        self.assertNotIn("went on", done.stdout)

    def test_takes_the_programs_that_were_built(self):
        self.assertIn("went on", self.machine.setup(self.BUILD).stdout)

    def test_a_log_that_cannot_be_written_ends_it(self):
        (self.machine.checkout / "build/release.log").mkdir(parents=True)
        self.assert_ends(self.machine.setup(self.BUILD), "cannot write to")

    def test_a_read_only_checkout_with_an_old_build_ends_it(self):
        build = self.machine.checkout / "build"
        build.mkdir()
        (build / "release.log").write_text("an error of the last build\n")
        as_seen = ["bash", "-c", "set -euo pipefail\nsource scripts/setup.sh\n" + self.BUILD]
        if os.getuid() == 0:  # Root may write everywhere but to a read-only mount.
            mount = 'mount --bind . . && mount -o remount,bind,ro . && cd "$PWD" && exec "$@"'
            shell = [shutil.which("unshare"), "-m", shutil.which("sh"), "-c", mount, "sh"]
            if subprocess.run([*shell, "true"], cwd=self.machine.checkout,
                              stderr=subprocess.DEVNULL).returncode != 0:
                self.skipTest("this root may not mount")
            (self.machine.programs / "mount").symlink_to(shutil.which("mount"))
            as_seen = shell + as_seen
        else:
            (build / "release.log").chmod(0o444)
            build.chmod(0o555)
            self.addCleanup(build.chmod, 0o755)
        done = self.machine.run(*as_seen)
        self.assert_ends(done, "cannot write to")
        self.assertNotIn("an error of the last build", done.stdout)

    def test_a_failure_without_the_word_for_it_is_told(self):
        self.machine.stand_in("cmake", "echo 'no space left'; exit 1")
        done = self.machine.setup(self.BUILD)
        self.assert_ends(done, "the build failed")
        self.assertIn("no space left", done.stdout)

    def test_a_failure_with_much_to_say_is_told(self):
        self.machine.stand_in("cmake", "seq 99999 | sed 's/^/error /'; exit 1")
        self.assert_ends(self.machine.setup(self.BUILD), "the build failed")


class Strictness(MachineTest):
    """Warnings are errors for CI alone."""

    def configured(self, name, *options):
        self.machine.stand_in("ctest", "exit 0")
        self.machine.stand_in("nproc", "echo 1")
        done = self.machine.script(name, *options)
        self.assertEqual(done.returncode, 0, done.stdout)
        return [call for call in self.machine.calls("cmake") if "--build" not in call]

    def test_ci_asks_for_it_in_each_build(self):
        calls = self.configured("test", "--ci")
        self.assertEqual(["-DTERRA_WERROR=ON" in call for call in calls], [True] * 3, calls)

    def test_nobody_else_does(self):
        for options in ([], ["--long"], ["--sanitize"]):
            for call in self.configured("test", *options):
                self.assertNotIn("WERROR", call)


class Install(MachineTest):
    def setUp(self):
        super().setUp()
        self.built = self.machine.folder / "built"
        self.built.mkdir()

    def test_a_new_folder_of_ones_own_needs_no_root(self):
        prefix = self.machine.folder / "home/new/terra"
        done = self.machine.script("install", "--prefix", prefix, "--no-units",
                                   "--from", self.built)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertTrue((prefix / "libexec/terra_advisor/with-credentials").exists())

    def test_a_relative_prefix_and_root_are_those_of_the_caller(self):
        done = self.machine.script("install", "--prefix", "here", "--no-units",
                                   "--from", self.built)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertTrue((self.machine.checkout / "here/share/doc/terra_advisor").exists())
        self.assertIn(f"--prefix {self.machine.checkout}/here", self.machine.calls("cmake")[0])

    @unittest.skipIf(os.getuid() == 0, "root may write everywhere")
    def test_the_systems_folders_without_root_are_refused_before_anything_is_done(self):
        done = self.machine.script("install", "--from", self.built)
        self.assertEqual(done.returncode, 1)
        self.assertIn("only root may write to", done.stdout)
        self.assertEqual(self.machine.calls("cmake"), [])

    def test_a_list_that_root_left_behind_is_no_hindrance(self):
        manifest = self.built / "install_manifest.txt"
        manifest.write_text("of root\n")
        self.machine.stand_in("cmake", f"test ! -e '{manifest}'")
        done = self.machine.script("install", "--prefix", self.machine.folder / "p",
                                   "--no-units", "--from", self.built)
        self.assertEqual(done.returncode, 0, done.stdout)

    @unittest.skipUnless(shutil.which("systemd-analyze"), "no systemd-analyze")
    def test_units_name_a_difficult_prefix_as_systemd_reads_it(self):
        stage = self.machine.folder / "stage"
        prefix = "/opt/50% größer & schöner"
        (stage / prefix.lstrip("/") / "bin").mkdir(parents=True)
        program = stage / prefix.lstrip("/") / "bin/terra-map"
        program.write_text("#!/bin/sh\n")
        program.chmod(0o755)
        done = self.machine.script("install", "--root", stage, "--prefix", prefix,
                                   "--from", self.built)
        self.assertEqual(done.returncode, 0, done.stdout)
        shutil.copytree("/usr/lib/systemd/system", stage / "usr/lib/systemd/system",
                        symlinks=True)
        done = subprocess.run(
            ["systemd-analyze", "verify", "--man=no", f"--root={stage}",
             "terra-map@demo.service"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        ours = [line for line in done.stdout.splitlines() if "terra-map" in line]
        self.assertEqual(ours, [], done.stdout)
        # It looks for the very file: without it, it says so.
        program.unlink()
        done = subprocess.run(
            ["systemd-analyze", "verify", "--man=no", f"--root={stage}",
             "terra-map@demo.service"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertIn(f"{prefix}/bin/terra-map", done.stdout)


@unittest.skipUnless(shutil.which("parallel"), "no GNU Parallel")
class BenchParallel(MachineTest):
    def test_paths_with_spaces_stay_whole(self):
        folder = self.machine.folder
        self.machine.stand_in("a terra", f"""for word; do printf '[%s]' "$word"; done \\
          >>"{folder}/words"; echo >>"{folder}/words" """)
        done = subprocess.run(
            [self.machine.checkout / "scripts/bench-parallel", "--dataset", "my data"],
            env={**os.environ, "HOME": str(folder),
                 "TERRA": str(self.machine.programs / "a terra"),
                 "RUN_OUT": f"{folder}/my run", "SHARDS": "1",
                 "PARALLEL_OPTIONS": "--will-cite"},
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertIn("[bench][run][--jobs][1][--shard][1/1]"
                      f"[--out][{folder}/my run.shards/1][--dataset][my data]",
                      (folder / "words").read_text(), done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
