"""Tests of pages.py: sentences of a line, numbers of a cell, missing files and long programs."""

import tempfile
import unittest
from pathlib import Path

import pages


def faults_of(text):
    return list(pages.faults_of_lines("a.md", text))


class Sentences(unittest.TestCase):
    def test_two_in_a_line(self):
        for line in ("A bar. It bends.", "Is it stiff? Yes.", "The list (see [it](a.md)). `code` follows.", "- One. Two.", "A force of 3.5 N. 4 bars.",
                     "The value **no**. The next.", "h = 0.5. $x$ grows.", "See `a.b`. Then stop.", "1. First. Then."):
            self.assertEqual(len(faults_of(line)), 1, line)

    def test_one_in_a_line(self):
        for line in ("Forces, e.g. Gravity, act.", "M. Wallin wrote it [App. A; Eq. 3].", "*Inputs.* A bar.", "- **Cost.** An n² law.",
                     "- [1. Title](#1-title)", "A value of 1.5 m.", "| A. B | C. D |", "## A. B", "```\nA. B\n```", "$$\nA . \\tag{1}\n$$", "Let $A. B$ hold.",
                     "Length 2.<!-- A. B --> of the bar.", "", "![A. B](c.svg)", "Lines 1. and 2. are one.", "An end ... of it."):
            self.assertEqual(faults_of(line), [], line)

    def test_one_in_two_lines(self):
        for text, count in (("A bar\nthat bends.", 1), ("A bar:\n`x`.", 0), ("- A bar\n- A rod", 0), ("A bar\n\nA rod", 0), ("A bar.\nIt bends.", 0), ("- A bar\n  that bends.", 1),
                            ("Made by\n\n```\nx\n```\nand", 0)):
            self.assertEqual(len(faults_of(text)), count, text)

    def test_split(self):
        text = "1. One bar. Its `a. B` bends. *Yes.*\n\n> A. B\n\n| A. B |\n\n- x 2.5<!--a. B--> m. Then y.\n"
        self.assertEqual(pages.split(text), "1. One bar.\n   Its `a. B` bends.\n   *Yes.*\n\n> A. B\n\n| A. B |\n\n- x 2.5<!--a. B--> m.\n  Then y.\n")
        self.assertEqual(faults_of(pages.split(text)), [])


class Repository(unittest.TestCase):
    def faults(self, name, text):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
            return list(pages.faults(Path(folder), [name]))

    def test_cells(self):
        page = "docs/peers.md"
        for cell, count in (("1.5 mm", 0), ("1.5 and 2 mm", 1), ("1 to 4 s: 2", 0), ("`a 1` 2 [3, 4]", 0), ("−3e-5, 2", 1), ("12 000 models", 0), ("10⁻⁵ 1", 1),
                            ("2<!--a 3-->", 0)):
            self.assertEqual(len(self.faults(page, f"| a 1 2 | {cell} |\n")), count, cell)
        self.assertEqual(self.faults("docs/other.md", "| a | 1, 2 |\n"), [])

    def test_missing_files(self):
        for text, count in (("of CASES3 14", 1), ("in M113.md", 1), ("CASES = {}", 0), ("the M113", 0)):
            self.assertEqual(len(self.faults("tests/a_test.cpp", text)), count, text)

    def test_length(self):
        self.assertEqual(self.faults("examples/mechanisms/a.cpp", "x\n" * 60), [])
        self.assertEqual(len(self.faults("examples/mechanisms/a.cpp", "x\n" * 61)), 1)


if __name__ == "__main__":
    unittest.main()
