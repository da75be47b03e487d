"""The golden messages mean the same to a decoder that shares no code with ours."""

import pathlib
import unittest

import wire

GOLDEN = pathlib.Path(__file__).resolve().parents[1] / "bus" / "golden"
MESSAGES = {path.stem[:-2]: path.read_bytes() for path in GOLDEN.glob("*.bin")}


class Wire(unittest.TestCase):
    def test_every_type_has_a_golden_message(self):
        self.assertEqual(sorted(MESSAGES), sorted(wire.TYPES))

    def test_golden_messages_are_read_and_written_again(self):
        for name, data in MESSAGES.items():
            with self.subTest(name):
                self.assertEqual(wire.encode(name, wire.decode(name, data)), data)

    def test_no_part_of_a_message_is_one(self):
        for name, data in MESSAGES.items():
            for size in range(len(data)):
                with self.subTest(name, size=size), self.assertRaises(ValueError):
                    wire.decode(name, data[:size])

    def test_nothing_follows_a_message(self):
        for name, data in MESSAGES.items():
            with self.subTest(name), self.assertRaises(ValueError):
                wire.decode(name, data + b"\0")


if __name__ == "__main__":
    unittest.main()
