"""What schema.py reads from .lcm files, what it refuses, and that the table in
docs/messages.md is the one that it writes."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TYPES = ROOT / "lcmtypes"


class Schema(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.types = self.folder / "lcmtypes"
        shutil.copytree(TYPES, self.types, ignore=shutil.ignore_patterns("__pycache__"))

    def run_schema(self, *arguments):
        return subprocess.run(
            [sys.executable, str(self.types / "schema.py"), *map(str, arguments)],
            capture_output=True, text=True, check=False)

    def change(self, name, old, new):
        path = self.types / f"{name}.lcm"
        text = path.read_text()
        self.assertIn(old, text)
        path.write_text(text.replace(old, new, 1))

    def refusal(self):
        run = self.run_schema("messages", self.folder / "out.h")
        self.assertNotEqual(run.returncode, 0)
        self.assertFalse((self.folder / "out.h").exists())
        return run.stderr

    def test_the_table_in_the_documents_is_up_to_date(self):
        copy = self.folder / "messages.md"
        shutil.copy(ROOT / "docs" / "messages.md", copy)
        self.assertEqual(self.run_schema("docs", copy).returncode, 0)
        self.assertEqual(copy.read_text(), (ROOT / "docs" / "messages.md").read_text(),
                         "run: python3 lcmtypes/schema.py docs docs/messages.md")

    def test_a_table_goes_only_between_its_marks(self):
        page = self.folder / "page.md"
        page.write_text("no marks\n")
        run = self.run_schema("docs", page)
        self.assertNotEqual(run.returncode, 0)
        self.assertEqual(page.read_text(), "no marks\n")

    def test_a_new_member_is_in_layout_and_sample(self):
        self.change("pose_t", "int64_t deployed_route_seq;",
                    "int64_t deployed_route_seq;\n    // @max 5\n    string added;")
        for what in ("messages", "samples"):
            self.assertEqual(self.run_schema(what, self.folder / what).returncode, 0)
        self.assertIn('kLayout = "llliiddlls5"', (self.folder / "messages").read_text())
        self.assertIn("kMaxAdded = 5", (self.folder / "messages").read_text())
        self.assertIn("visit(message.added, TextForm::kLine, std::size_t{63})",
                      (self.folder / "messages").read_text())
        self.assertIn('m.added = "added";', (self.folder / "samples").read_text())

    def test_a_type_that_nobody_listed_is_refused(self):
        shutil.copy(self.types / "pose_t.lcm", self.types / "place_t.lcm")
        self.assertIn("place_t", self.refusal())

    def test_what_it_cannot_read_is_refused_with_file_and_line(self):
        for old, new, expected in [
                ("int32_t pose_x;", "int32_t pose_x, pose_z;", "cannot read"),
                ("int32_t pose_x;", "float pose_x;", "no layout for float"),
                ("int32_t pose_x;", "int32_t pose_x[4];", "no int32_t 4"),
                ("// Map cell.", "// @most 4", "@most is none of"),
                ("// Map cell.", "// @text line 4", "no string"),
                ("// @rate", "// @other", "@other is none of"),
                ("struct pose_t", "struct place_t", "not named pose_t")]:
            with self.subTest(new):
                self.change("pose_t", old, new)
                refusal = self.refusal()
                self.assertIn(expected, refusal)
                self.assertRegex(refusal, r"pose_t\.lcm:\d+: ")
                shutil.copy(TYPES / "pose_t.lcm", self.types / "pose_t.lcm")

    def test_a_channel_that_says_too_little_is_refused(self):
        self.change("pose_t", "// @stops", "// It stops:")
        self.assertIn("@stops", self.refusal())

    def test_limits_stand_only_where_they_mean_something(self):
        self.change("pose_t", "// Map cell.", "// @max 4")
        self.assertIn("neither count nor string", self.refusal())


unittest.main()
