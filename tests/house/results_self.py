"""Tests of .ci/results: cells of docs/reliability.md from logs of the stages of .ci/full."""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LOGS = {
    "random_models": "13000 models, 1 wrong; 900 refused, 10 started from their reference, 5 with rows that repeat, 1 nearly singular; 2 steps failed\n",
    "hostile": "12: 100 parameters of drives\n13: 50 numbers of bars\n14: 496 runs, 3 refused, 2 with a warning\n15: 20 runs, 1 refused, 0 with a warning, 4\n",
    "soak": " t [s] forward\n" + "".join(f"{t:6.1f}" + "  -1.00e-10" * 6 + f" 800.10     {lost:.4f}    10000\n" for t, lost in ((1.0, 0.01), (60.0, 0.17)))
            + "55.0 s of processor time for 60.0 s\n",
    "coverage": "line coverage of include/ by 1, 2: 97.36 %, 97 of 100 lines; 1 lines stand in 1 of 9 functions\n",
    "mutants": "100 mutants: 90 killed, 8 survived, 2 not reached, 7 of both with a reason, 0 not run; 3 s\n",
}
EXPECTED = {"models": "13000", "wrong models": "1", "refused models": "900", "values": "150", "runs with impacts": "496", "lines": "100", "reached lines": "97.4",
            "mutants": "100", "found mutants": "90", "mutants without effect": "7", "unexplained work": "0.17", "hostile": "**failed**", "impacts": "**failed**"}


def cells(page):
    return dict(re.findall(r"<!-- \.ci/full: ([\w ]+) -->(.*?)<!-- end -->", page))


class Results(unittest.TestCase):
    def run_with(self, logs, failed=()):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for stage, text in logs.items():
                (folder / f"{stage}.log").write_text(text, encoding="utf-8")
            for stage in failed:
                (folder / f"{stage}.failed").touch()
            page = folder / "page.md"
            page.write_text((ROOT / "docs/reliability.md").read_text(encoding="utf-8"), encoding="utf-8")
            ran = subprocess.run([sys.executable, "-B", ROOT / ".ci/results", folder, "--page", page], capture_output=True, text=True, check=False)
            return ran, page.read_text(encoding="utf-8")

    def test_written(self):
        before = (ROOT / "docs/reliability.md").read_text(encoding="utf-8")
        ran, page = self.run_with(LOGS, ["hostile"])
        self.assertEqual(ran.returncode, 0, ran.stdout)
        self.assertEqual(cells(page), cells(before) | EXPECTED)
        self.assertEqual(self.run_with({})[1], before)

    def test_number_that_is_missing(self):
        ran, _ = self.run_with({"mutants": "nothing\n"})
        self.assertEqual(ran.returncode, 1)
        self.assertEqual(ran.stdout.count("has no number"), 3)

    def test_stages(self):
        stages = re.search(r"^stages=\((.*)\)", (ROOT / ".ci/full").read_text(encoding="utf-8"), re.MULTILINE)[1].split()
        named = [cell for cell in cells((ROOT / "docs/reliability.md").read_text(encoding="utf-8")) if cell not in EXPECTED]
        self.assertEqual([cell for cell in named if cell not in stages], [])


if __name__ == "__main__":
    unittest.main()
