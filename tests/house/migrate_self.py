"""Tests of docs/migrate: the tables of docs/migration.md applied to a program with old names."""

import contextlib
import importlib.util
import io
import re
import tempfile
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "docs" / "migrate"
SPEC = importlib.util.spec_from_loader("migrate", SourceFileLoader("migrate", str(SCRIPT)))
migrate = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(migrate)
TABLE = migrate.entries(migrate.TABLE.read_text(encoding="utf-8"))

OLD = """#include <polybody/integrators/generalized_alpha.hpp>
using Stepper = GeneralizedAlpha;  // the integrator GeneralizedAlpha
using Beam = Lrvf<Objective, Selective>;
using Loop = Joint<Revolute, RecursiveBy<recursive::Reduced>>;
std::string const title = "until the end, by GeneralizedAlpha";
for (State const& now : simulate(model, x, Stepper{.rho_inf = 0.8}, {.until = 2.0, .step = 1e-3}))
  std::cout << gap(model, now, pin).norm() << own.gap(now) << '\\n';
int until = 3;
"""

NEW = """#include <polybody/integrators/generalised_alpha.hpp>
using Stepper = GeneralisedAlpha;  // the integrator GeneralizedAlpha
using Beam = Lrvf<RelativeRotation, SelectiveQuadrature>;
using Loop = Joint<Revolute, JointCoordinatesBy<joint_coordinates::Augmented>>;
std::string const title = "until the end, by GeneralizedAlpha";
for (State const& now : simulate(model, x, Stepper{.rho_inf = 0.8}, {.end_time = 2.0, .step = 1e-3}))
  std::cout << constraint_violation(model, now, pin).norm() << own.gap(now) << '\\n';
int until = 3;
"""


def run(*arguments):
    """Return value and output of the script."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        returned = migrate.main([str(a) for a in arguments])
    return returned, said.getvalue()


class Migrate(unittest.TestCase):
    def test_renames_code_and_keeps_strings_comments_and_own_names(self):
        self.assertEqual(migrate.migrated(OLD, TABLE), NEW)

    def test_a_second_pass_changes_nothing(self):
        self.assertEqual(migrate.migrated(NEW, TABLE), NEW)

    def test_check_lists_the_lines_and_leaves_the_file(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "program.cpp"
            file.write_text(OLD, encoding="utf-8")
            returned, said = run("--check", file)
            self.assertEqual(returned, 1)
            self.assertEqual(file.read_text(encoding="utf-8"), OLD)
            changed = [f"{file}:{i}: {new}" for i, (old, new) in enumerate(zip(OLD.split("\n"), NEW.split("\n")), 1)
                       if old != new]
            self.assertEqual([re.sub(r": +", ": ", s) for s in said.splitlines() if "by hand" not in s],
                             [re.sub(r": +", ": ", s) for s in changed])
            self.assertEqual(run(file)[0], 0)
            self.assertEqual(file.read_text(encoding="utf-8"), NEW)
            self.assertEqual(run("--check", file)[0], 0)

    def test_lists_names_that_a_reader_must_decide(self):
        old, new = next((old, new) for old, new, kind in TABLE if kind == "manual")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "program.cpp"
            file.write_text(f"auto const x = report.{old};\n", encoding="utf-8")
            said = run(file)[1]
            self.assertIn(f"{file}:1: check by hand whether {old} is now {new}", said)

    def test_no_entry_renames_the_result_of_another(self):
        for kind in set(migrate.KINDS) - {"manual"}:
            old = {o for o, _, k in TABLE if k == kind}
            both = {n for _, n, k in TABLE if k == kind} & old
            self.assertEqual(both, set(), kind)

    def test_new_headers_and_names_exist(self):
        files = [(folder, p) for folder in ("include", "examples") for p in (ROOT / folder).rglob("*.hpp")]
        headers = {p.relative_to(ROOT / folder).as_posix() for folder, p in files}
        self.assertEqual({new for _, new, kind in TABLE if kind == "header"} - headers, set())
        text = "\n".join(p.read_text(encoding="utf-8") for _, p in files)
        words = set(re.findall(r"\w+", text))
        missing = {new for _, new, kind in TABLE if kind != "header" and not set(re.findall(r"\w+", new)) <= words}
        self.assertEqual(missing, set())


if __name__ == "__main__":
    unittest.main()
