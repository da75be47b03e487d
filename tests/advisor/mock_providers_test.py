"""`terra advise` against a second implementation of the four providers' forms:
busy, then answered; recorded; the recording replayed without the server.

usage: mock_providers_test.py TERRA DEMO_MAP
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import mock_providers

TERRA, DEMO_MAP = sys.argv.pop(1), sys.argv.pop(1)
CASE = ["--map", DEMO_MAP, "--start", "30,250", "--goal", "470,250", "--json"]
ANSWER = "No. [(30, 250), (190, 410), (190, 461), (228, 499), (330, 499), " \
         "(470, 359), (470, 250)]"
KEYS = {"openai": "OPENAI_API_KEY", "anthropic": "ANTHROPIC_API_KEY",
        "gemini": "GEMINI_API_KEY", "chat": "TERRA_CHAT_API_KEY"}
SECRET = "a-key-that-nobody-may-see"


def advise(*options, key=None):
    environment = {k: v for k, v in os.environ.items() if k not in KEYS.values()}
    environment.update(key or {})
    done = subprocess.run([TERRA, "advise", *CASE, *options], env=environment,
                          capture_output=True, text=True, timeout=60)
    return done, done.stdout + done.stderr


class MockProviders(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="terra-mock-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def serve(self, answer, key="none"):
        server = mock_providers.Server(answer, key)
        self.addCleanup(server.close)
        return server

    def test_each_form_is_understood_recorded_and_replayed(self):
        for provider in KEYS:
            with self.subTest(provider):
                server = self.serve(ANSWER, SECRET)
                recording = self.folder / f"{provider}.jsonl"
                done, output = advise(
                    "--backend", provider, "--base-url", server.url,
                    "--record", str(recording), key={KEYS[provider]: SECRET})
                self.assertEqual(server.complaints, [])
                self.assertEqual(server.seen, [provider] * 2, "busy, then asked again")
                self.assertEqual(done.returncode, 0, output)
                result = json.loads(done.stdout)
                self.assertEqual(result["code"], "accepted", output)
                self.assertTrue(result["simulated"])
                self.assertEqual(result["answer"].strip(), ANSWER)
                self.assertNotIn(SECRET, output + recording.read_text())

                replayed, output = advise("--backend", "replay",
                                          "--recording", str(recording))
                self.assertEqual(replayed.returncode, 0, output)
                again = json.loads(replayed.stdout)
                del again["seconds"], result["seconds"]
                self.assertEqual(again, result)

    def test_a_server_here_needs_no_key(self):
        for provider in KEYS:
            server = self.serve("Yes")
            done, output = advise("--backend", provider, "--base-url", server.url)
            self.assertEqual(server.complaints, [], provider)
            self.assertEqual(json.loads(done.stdout)["code"], "retained", output)

    def test_a_wrong_key_is_said_and_not_shown(self):
        for provider in KEYS:
            server = self.serve("Yes", "another")
            done, output = advise("--backend", provider, "--base-url", server.url,
                                  key={KEYS[provider]: SECRET})
            self.assertEqual(server.seen, [], provider)
            self.assertIn("400", output)
            self.assertNotIn(SECRET, output)


if __name__ == "__main__":
    unittest.main()
