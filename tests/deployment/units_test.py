"""The installed systemd units: complete, accepted by systemd, sandboxed, and the
programs speak the watchdog's protocol from their event loop.

usage: units_test.py SOURCE_FOLDER BUILD_FOLDER
"""

import os
import pathlib
import re
import shutil
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
PROCESSES = ("map", "planner", "verifier", "advisor", "logger")
WORST_EXPOSURE = 16  # in tenths: what is reached; systemd calls up to 4.9 "OK"


def run(*command, **kwargs):
    return subprocess.run([str(word) for word in command], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, **kwargs)


class Units(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="terra-units-")
        cls.stage = pathlib.Path(cls.folder.name)
        cls.install()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def install(cls):
        done = run(SOURCE / "scripts/install", "--root", cls.stage, "--from", BUILD)
        assert done.returncode == 0, done.stdout

    def unit_folder(self):
        return self.stage / "etc/systemd/system"

    def services(self):
        return [self.unit_folder() / f"terra-{name}@.service" for name in PROCESSES]

    def settings(self, unit):
        lines = [line for line in unit.read_text().splitlines() if "=" in line]
        return dict(line.split("=", 1) for line in lines if not line.startswith("#"))

    def test_every_placeholder_is_filled_in(self):
        for unit in self.unit_folder().iterdir():
            self.assertNotIn("@BINDIR@", unit.read_text(), unit.name)
            self.assertNotIn("@LIBEXECDIR@", unit.read_text(), unit.name)
            self.assertNotIn("@DOCDIR@", unit.read_text(), unit.name)

    def test_each_unit_starts_what_was_installed_with_its_own_configuration(self):
        for name, unit in zip(PROCESSES, self.services()):
            command = self.settings(unit)["ExecStart"].split()
            self.assertEqual(command[-3:], [f"/usr/local/bin/terra-{name}", "--config",
                                            f"/etc/terra-advisor/{name}-%i.toml"])
            for word in command[:-2]:
                program = self.stage / word.lstrip("/")
                self.assertTrue(os.access(program, os.X_OK), program)
            self.assertTrue((self.stage / f"etc/terra-advisor/{name}-demo.toml").exists())

    def test_each_process_is_watched_restarted_and_bounded(self):
        for unit in self.services():
            settings = self.settings(unit)
            self.assertEqual(settings["Type"], "notify")
            self.assertEqual(settings["Restart"], "always")
            self.assertEqual(settings["StartLimitIntervalSec"], "0")
            for key in ("WatchdogSec", "RestartSec", "TimeoutStopSec", "MemoryMax",
                        "TasksMax", "LimitNOFILE"):
                self.assertIn(key, settings, unit.name)
            self.assertEqual(settings["LimitCORE"], "0")  # a core may hold a key

    def test_keys_are_for_root_only_and_no_unit_has_one_of_itself(self):
        keys = self.stage / "etc/terra-advisor/keys"
        self.assertEqual(stat.S_IMODE(keys.stat().st_mode), 0o700)
        for unit in self.services():
            text = unit.read_text()
            self.assertNotIn("Environment", text)
            self.assertNotIn("LoadCredential=", text)

    @unittest.skipUnless(shutil.which("systemd-analyze"), "no systemd-analyze")
    def test_the_documented_key_file_gives_one_advisor_one_credential(self):
        document = (SOURCE / "docs/deployment.md").read_text()
        key_file = re.search(r"key\.conf <<'END'\n(.*?)END\n", document, re.S)[1]
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            shutil.copytree(self.stage, root, dirs_exist_ok=True)
            shutil.copytree("/usr/lib/systemd/system", root / "usr/lib/systemd/system",
                            symlinks=True)
            beside = root / "etc/systemd/system/terra-advisor@gpt.service.d"
            beside.mkdir(parents=True)
            (beside / "key.conf").write_text(key_file)
            done = run("systemd-analyze", "verify", "--man=no", f"--root={root}",
                       "terra-advisor@gpt.service")
            ours = [line for line in done.stdout.splitlines() if "terra" in line]
            self.assertEqual((ours, done.returncode), ([], 0), done.stdout)
        self.assertEqual(key_file.count("LoadCredential="), 1)

    def test_another_installation_keeps_keys_and_configurations(self):
        key = self.stage / "etc/terra-advisor/keys/OPENAI_API_KEY"
        key.touch(mode=0o600)
        config = self.stage / "etc/terra-advisor/planner-demo.toml"
        key.write_text("of the user")
        config.write_text("stride = 10\n")
        self.install()
        self.assertEqual(key.read_text(), "of the user")
        self.assertEqual(config.read_text(), "stride = 10\n")

    @unittest.skipUnless(shutil.which("systemd-analyze"), "no systemd-analyze")
    def test_systemd_accepts_the_units_without_a_word(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            shutil.copytree(self.stage, root, dirs_exist_ok=True)
            shutil.copytree("/usr/lib/systemd/system", root / "usr/lib/systemd/system",
                            symlinks=True)
            names = [f"terra-{name}@demo.service" for name in PROCESSES]
            done = run("systemd-analyze", "verify", "--man=no", f"--root={root}", *names,
                       "terra-multicast.service", "terra-firewall.service",
                       "terra-advisor.target")
            ours = [line for line in done.stdout.splitlines() if "terra" in line]
            self.assertEqual((ours, done.returncode), ([], 0), done.stdout)

    @unittest.skipUnless(shutil.which("systemd-analyze"), "no systemd-analyze")
    def test_no_sandbox_is_weaker_than_it_was(self):
        for unit in [*self.services(), self.unit_folder() / "terra-multicast.service",
                     self.unit_folder() / "terra-firewall.service"]:
            done = run("systemd-analyze", "security", "--no-pager", "--offline=yes",
                       f"--threshold={WORST_EXPOSURE}", unit)
            self.assertEqual(done.returncode, 0, done.stdout[-300:])
            self.assertIn("Overall exposure level", done.stdout)

    def test_advisors_start_only_behind_the_rule_and_as_its_user(self):
        for unit in self.services():
            settings = self.settings(unit)
            if "advisor@" in unit.name:
                self.assertEqual(settings["User"], "terra-advisor")
                self.assertEqual(settings["Requires"], "terra-firewall.service")
                self.assertIn("terra-firewall.service", settings["After"].split())
            else:
                self.assertNotIn("User", settings)
        self.assertIn("u terra-advisor ",
                      (self.stage / "etc/sysusers.d/terra-advisor.conf").read_text())
        rules = (self.stage / "etc/terra-advisor/advisors.nft").read_text()
        self.assertIn('define advisors = "terra-advisor"', rules)

    def test_credentials_become_the_programs_environment(self):
        with tempfile.TemporaryDirectory() as folder:
            credentials = pathlib.Path(folder)
            (credentials / "OPENAI_API_KEY").write_text("a key with $ and 'quotes'\n")
            (credentials / "GEMINI_API_KEY").write_text("")
            done = run(self.stage / "usr/local/libexec/terra_advisor/with-credentials",
                       sys.executable, "-c",
                       "import os; print([os.environ.get(n) for n in "
                       "('OPENAI_API_KEY', 'GEMINI_API_KEY')])",
                       env={"PATH": os.environ["PATH"], "CREDENTIALS_DIRECTORY": folder})
            self.assertEqual(done.stdout, repr(["a key with $ and 'quotes'", None]) + "\n")


class Watchdog(unittest.TestCase):
    def test_is_fed_while_the_event_loop_works_and_only_then(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "notify")
            manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
            manager.bind(path)
            manager.settimeout(20)
            gate = subprocess.Popen(
                [BUILD / "bin/terra-verifier", "--lcm-url", "memq://", "--advice-url",
                 "memq://"], env={**os.environ, "NOTIFY_SOCKET": path})
            try:
                heard = ""
                while "READY=1" not in heard or heard.count("WATCHDOG=1") < 3:
                    heard += manager.recv(4096).decode() + "\n"
                gate.send_signal(signal.SIGSTOP)
                os.waitid(os.P_PID, gate.pid, os.WSTOPPED)
                manager.settimeout(0)
                with self.assertRaises(BlockingIOError):
                    while True:
                        manager.recv(4096)  # what was on its way
                manager.settimeout(3)  # three times the heartbeat's period
                with self.assertRaises(TimeoutError):
                    manager.recv(4096)
                gate.send_signal(signal.SIGCONT)
                manager.settimeout(20)
                self.assertIn("WATCHDOG=1", manager.recv(4096).decode())
                gate.terminate()
                self.assertEqual(gate.wait(20), 0)
            finally:
                gate.kill()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
