"""Tests of docs/validation: the page of each row, the numbers of the summary, and the faults of the checks."""

import importlib.util
import tempfile
import unittest
from contextlib import redirect_stdout
from importlib.machinery import SourceFileLoader
from io import StringIO
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "docs" / "validation"
SPEC = importlib.util.spec_from_loader("validation", SourceFileLoader("validation", str(SCRIPT)))
validation = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(validation)

SUMMARY = f"""# Validation

{validation.BEGIN}
{validation.END}

## Cases

### Statics

| case | contents |
|---|---|
| S2, thesis, ch. 2 | bent beam ([page](page.md)) |
| S1 | rolled beam |

### Contact

| case | contents |
|---|---|
| C1 | ball |

## Not in the tables

| case | contents | test |
|---|---|---|
| C9 | structure | `tests/a_test.cpp` |
"""


def record(case, by, value, reference=2.0, tolerance=0.1, scale=0.0, kind="value", file="tests/a_test.cpp", at="", what="x [m]"):
    error = value if kind == "distance" else abs(value - reference)
    return dict(case=case, what=what, by=by, source="F", formulation="Rigid", at=at, kind=kind, reference=reference, value=value,
                tolerance=tolerance, scale=scale, file=file, error=error, size=max(abs(reference), scale))


RECORDS = [
    record("S1", 1, 2.001),
    record("S1", 1, 4.00001, reference=4.0, at="t = 2"),
    record("S1", 2, 0.003, reference=0.0, scale=5.0, kind="distance"),
    record("S2", 0, 2.01),
    record("thesis, ch. 2", 0, 7.0, reference=7.0, tolerance=0.0),
    record("C1", 1, 0.0, reference=0.0, tolerance=0.0),
    record("C1", 3, 2.0, file="tests/long_cases/b.cpp"),
]


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        validation.DOCS = Path(self.folder.name)
        (validation.DOCS / "validation.md").write_text(SUMMARY)
        (validation.DOCS / "reliability.md").write_text(f"| a | {validation.COUNT}9{validation.AFTER} |\n| b | 3{validation.AFTER} |\n")
        self.write(RECORDS)

    def write(self, records, partial=False):
        with redirect_stdout(StringIO()):
            validation.write(records, partial)

    def text(self, name):
        return (validation.DOCS / name).read_text()

    def change(self, name, old, new):
        text = self.text(name)
        self.assertIn(old, text)
        (validation.DOCS / name).write_text(text.replace(old, new, 1))

    def assert_fault(self, faults, words):
        self.assertTrue(any(words in fault for fault in faults), faults)


class Written(Folder):
    def test_pages_of_rows(self):
        rows = {stem: [line for line in self.text(f"validated/{stem}.md").splitlines() if line.startswith(("| S", "| t", "| C", "#"))]
                for stem in ("published", "closed_forms_flexible", "closed_forms_rigid", "independent_statics", "independent_flexible", "itself")}
        self.assertEqual([line[:15] for line in rows["published"]],
                         ["# Published num", "## Statics", "### S2, thesis,", "| S2 | x [m] | ", "| thesis, ch. 2"])
        self.assertEqual(rows["closed_forms_flexible"][-1],
                         "| S1 | x [m] | Rigid | 4 at t = 2 | 4 | 2 | ≤ 0.01 | ≤ 0.005 | 0.1 | F | `tests/a_test.cpp` |")
        self.assertEqual(rows["closed_forms_rigid"][1:],
                         ["## Contact", "### C1", "| C1 | x [m] | Rigid | 0 | 0 | 1 | ≤ 0 | – | 0 | F | `tests/a_test.cpp` |"])
        self.assertEqual(rows["independent_statics"][-1],
                         "| S1 | x [m] | Rigid | (distance) | – | 1 | ≤ 0.01 | ≤ 0.002 | 0.1 | F | `tests/a_test.cpp` |")
        self.assertEqual(rows["independent_flexible"], ["# Independent: flexible bodies"])
        self.assertEqual(len(rows["itself"]), 4)

    def test_summary(self):
        lines = self.text("validation.md").splitlines()
        closed, independent = "[closed form](validated/closed_forms_flexible.md#s1)", "[independent](validated/independent_statics.md#s1)"
        self.assertIn(f"| S1 | rolled beam | {closed}, {independent} | 2 | 3 | ≤ 0.005 | ≤ 0.005 |", lines)
        published = "[published](validated/published.md#s2-thesis-ch-2)"
        self.assertIn(f"| S2, thesis, ch. 2 | bent beam ([page](page.md)) | {published} | 2 | 2 | ≤ 0.05 | ≤ 0.05 |", lines)
        self.assertTrue(any(line.startswith("| all |  | 6 | 7 | ≤ 0.002 | ≤ 0.05 |") for line in lines))
        self.assertTrue(self.text("validation.md").endswith(SUMMARY[SUMMARY.index("## Not in") :]))

    def test_count_in_another_page(self):
        self.assertEqual(self.text("reliability.md"), f"| a | {validation.COUNT}7{validation.AFTER} |\n| b | 3{validation.AFTER} |\n")

    def test_again(self):
        before = {path: path.read_text() for path in validation.DOCS.rglob("*.md")}
        self.write(RECORDS)
        self.assertEqual({path: path.read_text() for path in validation.DOCS.rglob("*.md")}, before)

    def test_rows_that_remain(self):
        long = self.text("validated/itself.md")
        self.write(RECORDS[:-1])
        self.assertEqual(self.text("validated/itself.md"), long)
        one = [record("C1", 3, 2.0, file="tests/c_test.cpp")]
        self.write(one, partial=True)
        self.assertEqual(len(validation.page_rows()), 7)
        self.write(one)
        self.assertEqual([row[-1] for _, row in validation.page_rows()], ["`tests/c_test.cpp`", "`tests/long_cases/b.cpp`"])

    def test_stale_page_is_removed(self):
        (validation.DOCS / "validated" / "old.md").write_text("")
        self.write(RECORDS)
        self.assertFalse((validation.DOCS / "validated" / "old.md").exists())

    def test_case_without_description(self):
        for case in ("S3", "C9", "thesis"):
            with self.assertRaisesRegex(SystemExit, f"does not list these cases: {case}"):
                self.write(RECORDS + [record(case, 1, 2.0)])


class Pages(Folder):
    def test_agree(self):
        self.assertEqual(validation.check_pages(), [])

    def test_changed(self):
        for name, old, new, fault in (
            ("validation.md", "| 2 | 3 |", "| 2 | 4 |", "docs/validation.md does not agree"),
            ("validation.md", "| all |  | 6 |", "| all |  | 7 |", "docs/validation.md does not agree"),
            ("reliability.md", "-->7<", "-->8<", "docs/reliability.md does not agree"),
            ("validation.md", "### Contact", "### Statics", "docs/validated/closed_forms_rigid.md does not agree"),
            ("validation.md", "### Contact", "### Other", "does not describe C1"),
            ("validation.md", "| C1 |", "| C1, C2 |", "no test records the case C2"),
            ("validation.md", "| C1 |", "| C1, S1 |", "has S1 twice"),
            ("validated/closed_forms_flexible.md", "| S1 |", "| C1 |", "docs/validated/closed_forms_flexible.md does not agree"),
            ("validated/closed_forms_flexible.md", "| S1 |", "| S5 |", "does not describe S5"),
            ("validated/itself.md", "| 1 | ≤", "| 2 | ≤", "docs/validation.md does not agree"),
            ("validated/itself.md", "## Contact", "## Statics", "docs/validated/itself.md does not agree"),
        ):
            with self.subTest(new=new, name=name):
                before = self.text(name)
                self.change(name, old, new)
                self.assert_fault(validation.check_pages(), fault)
                (validation.DOCS / name).write_text(before)

    def test_missing_and_stale(self):
        (validation.DOCS / "validated" / "independent_rigid.md").unlink()
        (validation.DOCS / "validated" / "old.md").write_text("")
        faults = validation.check_pages()
        self.assert_fault(faults, "docs/validated/independent_rigid.md does not agree")
        self.assert_fault(faults, "docs/validated/old.md is not one of the pages")
        self.assertEqual(len(faults), 2)


class Checked(Folder):
    def test_same(self):
        self.assertEqual(validation.check(RECORDS, False), [])
        self.assertEqual(validation.check(RECORDS[:-1], False), [])
        self.assertEqual(validation.check(RECORDS[-1:], True), [])

    def test_other_results(self):
        for changed, fault in (
            (record("S2", 0, 2.2), "an error of 0.2, but the page has ≤ 0.1"),
            (record("S2", 0, 2.01, reference=2.1), "the page has 2, the test 2.1"),
            (record("S2", 0, 2.01, tolerance=0.2), "the page has 0.1, the test 0.2"),
            (record("S2", 0, 2.01, what="y [m]"), "is not in the tables: S2 | y [m]"),
            (record("S2", 0, 2.01, what="y [m]"), "no test records: S2 | x [m]"),
        ):
            with self.subTest(fault=fault):
                self.assert_fault(validation.check([changed if r["case"] == "S2" else r for r in RECORDS], False), fault)

    def test_relative_error(self):
        self.change("validated/published.md", "≤ 0.05", "≤ 0.004")
        self.assert_fault(validation.check(RECORDS, False), "a relative error of 0.00")
        self.change("validated/published.md", "≤ 0.004", "–")
        self.assert_fault(validation.check(RECORDS, False), "but the page has –")

    def test_pages_are_checked(self):
        self.change("validation.md", "| all |  | 6 |", "| all |  | 7 |")
        self.assert_fault(validation.check(RECORDS, False), "docs/validation.md does not agree")


class Relative(unittest.TestCase):
    def test_one_digit_above(self):
        for error, tolerance, size, text in ((0.2, 0.25, 10.0, "≤ 0.03"), (1e-9, 1e-3, 2.0, "≤ 5e-7"), (0.0, 1.0, 1.0, "≤ 0.001"), (3.0, 9.5, 10.0, "≤ 1")):
            self.assertEqual(validation.relative([record("S1", 1, size + error, reference=size, tolerance=tolerance)]), text)


if __name__ == "__main__":
    unittest.main()
