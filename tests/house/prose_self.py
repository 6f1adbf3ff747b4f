"""Tests of prose.py: reported and accepted sentences, and the list of allowed findings; tests of changelog.py."""

import sys
import tempfile
from pathlib import Path

import changelog
import prose

REPORTED = [
    "What the derivatives of a run are told in.",
    "Whether any unknown turns.",
    "The same, for who keeps it.",
    "The history is kept where it is needed.",
    "It is solved by factors of a matrix near it, and written anew.",
    "The file stands beside the others.",
    "The event is asked whether it acts.",
    "Steps are taken by turns, beside those of the other solver.",
    "This form is no longer used.",
]
ACCEPTED = [
    "Constraint Jacobian of the joint, 6 × nv.",
    "Checks that the sizes of a state match a model.",
    "G is the constraint Jacobian, where Φ = 0 on the manifold.",
    "The file is compared with the reference of `what it stands beside`.",
]
HEADER = """#pragma once
/// Mass of a body [kg].
double mass;  ///< What it weighs is asked of it.
inline void require(double x) {
  if (x < 0.0) throw InvalidInput{"The mass is told by \\"", x, "\\" kg."};
}
///     formula = what is it
"""


def require(holds, what):
    if not holds:
        sys.exit(f"prose_self: {what}")


for sentence in REPORTED:
    require(prose.faults(sentence), f"not reported: {sentence}")
for sentence in ACCEPTED:
    require(not prose.faults(sentence), f"reported: {sentence}: {prose.faults(sentence)}")
require(not prose.faults("Measured on 2026-11-25."), "a date is reported outside of pages")
require(prose.faults("Measured on 2026-11-25.", page=True), "a date in a page is not reported")

with tempfile.TemporaryDirectory() as folder:
    root = Path(folder)
    (root / "a.hpp").write_text(HEADER, encoding="utf-8")
    (root / "README.md").write_text("# What it is\n\nA sentence.\nIt stands here.\n\n```sh\nwhat stands\n```\n")
    found = prose.findings(root, "a.hpp")
    require([f.split(":")[1] for f in found] == ["3", "5"], f"a header: {found}")
    require([f.split(":")[1] for f in prose.findings(root, "README.md")] == ["4"], "a page")

    prose.files = lambda _: ["a.hpp", "README.md"]
    prose.LONGEST = {"README.md": 8}
    prose.LIST = root / "allowed.txt"
    for entries, faults in {
        "a.hpp 2\n": "README.md: 1 sentences to rewrite, 0 allowed",
        "a.hpp 3\n": "a.hpp: only 2 findings left of 3",
        "README.md 1\na.hpp 2\n": "README.md: this page may have no entry",
        "b.hpp 1\n": "b.hpp: listed",
    }.items():
        prose.LIST.write_text(entries)
        require(any(line.startswith(faults) for line in prose.check(root)), f"{entries!r}: {list(prose.check(root))}")
    prose.LIST.write_text("# head\na.hpp 3\n")
    prose.shrink(root)
    require(prose.LIST.read_text() == "# head\na.hpp 2\n", "--shrink")

    prose.LONGEST = {"README.md": 7, "gone.md": 9}
    found = [f for f in prose.check(root) if "a.hpp" not in f]
    require([f.split(",")[0] for f in found[2:]] == ["README.md: 8 words", "gone.md: listed in LONGEST"], f"too long: {found}")

PAGE = "# A head\n\n[Two words](a/long/path.md#with-a-place), `code` – 1.5<!--of/a/case-->\n\n```sh\nnot counted\n```\n| a cell | 3.0 |\n|---|---|\n"
require(prose.words(PAGE) == 9, f"{prose.words(PAGE)} words")

CHANGES = "# Changelog\n\n## Unreleased\n\n> **Breaking, migration**\n>\n> - A.\n\n### Added\n\n- {}\n\n## 0.2.0 - 2026-11-27\n\n### Fixed\n\n- B.\n"
require(not list(changelog.faults(CHANGES.format("Forty words. " * 20))), "a correct changelog is reported")
for wrong in (
    CHANGES.format("word " * 41),
    CHANGES.replace("Added", "Speed").format("A."),
    CHANGES.replace("0.2.0 - 2026-11-27", "0.2.0").format("A."),
    CHANGES.replace("### Fixed\n", "").format("A."),
    CHANGES.format("A bullet\n  of two lines."),
):
    require(len(list(changelog.faults(wrong))) == 1, f"changelog: {list(changelog.faults(wrong))}")
