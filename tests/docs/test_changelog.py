#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""tools/changelog.py: files of changes/ are joined with the change log, and what is wrong is told."""
import contextlib
import io
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))
import changelog  # noqa: E402

LOG = "# Changes\n\n## Unreleased\n\n- One.\n\n## 0.0.9 (2020-01-01)\n\n- Old.\n"


class Changes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        (self.root / "changes").mkdir()
        (self.root / "include/se3d").mkdir(parents=True)
        (self.root / "include/se3d/base.h").write_text(
            "#define SE3D_VERSION_MAJOR 1\n#define SE3D_VERSION_MINOR 2\n"
            "#define SE3D_VERSION_PATCH 3\n")
        (self.root / "CHANGELOG.md").write_text(LOG)
        (self.root / "changes/README.md").write_text("How.\n")
        self.add("b.md", "- Two,\n  which goes on.\n")
        self.add("c.md", "- Three.\n")

    def tearDown(self):
        self.folder.cleanup()

    def add(self, name, text):
        (self.root / "changes" / name).write_text(text)

    def run_tool(self, *words):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = changelog.main(list(words), self.root)
        return code, out.getvalue(), err.getvalue()

    def test_the_list_is_joined(self):
        self.assertEqual(self.run_tool(),
                         (0, "- One.\n- Two,\n  which goes on.\n- Three.\n", ""))

    def test_a_release_takes_the_files(self):
        self.assertEqual(self.run_tool("release", "2026-12-01"), (0, "", ""))
        self.assertEqual((self.root / "CHANGELOG.md").read_text(),
                         "# Changes\n\n## Unreleased\n\n## 1.2.3 (2026-12-01)\n\n- One.\n- Two,\n"
                         "  which goes on.\n- Three.\n\n## 0.0.9 (2020-01-01)\n\n- Old.\n")
        self.assertEqual([p.name for p in (self.root / "changes").iterdir()], ["README.md"])
        code, _, error = self.run_tool("release", "2026-12-02")
        self.assertEqual(code, 1)
        self.assertIn("has 1.2.3 already", error)

    def test_what_is_wrong_is_told_and_nothing_done(self):
        for text, part in (("Three.\n", "c.md:1: must begin with"), ("", "c.md:1"),
                           ("- A.\n\n- B.\n", "c.md:2"), ("- " + 119 * "a" + "\n", "121 columns")):
            self.add("c.md", text)
            code, out, error = self.run_tool("release", "2026-12-01")
            self.assertEqual((code, out), (1, ""))
            self.assertIn(part, error)
            self.assertEqual((self.root / "CHANGELOG.md").read_text(), LOG)

    def test_dates_words_and_logs_are_checked(self):
        self.assertEqual(self.run_tool("release", "tomorrow")[0], 1)
        self.assertEqual(self.run_tool("relase", "2026-12-01")[0], 2)
        (self.root / "CHANGELOG.md").write_text("# Changes\n")
        self.assertIn("no part", self.run_tool()[2])

    def test_the_files_of_this_tree_are_right(self):
        self.assertEqual([line for path in changelog.fragments(ROOT)
                          for line in changelog.problems(path)], [])
        changelog.unreleased((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))


unittest.main()
