"""Tests of names.py: found and accepted identifiers, and the list of allowed ones."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import names

GLOSSARY = """
| rule | decision |
|---|---|
| limits | `max_…` |

| term | symbol | definition | source | instead of | in the code |
|---|---|---|---|---|---|
| end time | | Time at which a run ends [s]. | | `until`, at last | `end_time` |
| SIMD vector | | Several numbers. | | `pack` | `SimdVector` |
| body, `Body` | | Part of a mechanism. | | `first_part` | |
"""

HEADER = """#pragma once
#include <polybody/math/pack.hpp>  // not an identifier
/// `until` in a comment, \\param until
inline double end_time = 0.0;
char const* const text = "until pack";
int packet, unpacked, first, part;
"""


def run(text, allowed):
    """Return value and output for one header."""
    with tempfile.TemporaryDirectory() as folder:
        include = Path(folder) / "include"
        include.mkdir()
        (include / "a.hpp").write_text(text, encoding="utf-8")
        glossary = Path(folder) / "glossary.md"
        glossary.write_text(GLOSSARY, encoding="utf-8")
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            returned = names.main(include, glossary, allowed)
        return returned, said.getvalue()


class Names(unittest.TestCase):
    def test_reads_words_in_code_type_only(self):
        self.assertEqual(
            names.replaced_words(GLOSSARY), {"until": "end time", "pack": "SIMD vector", "first_part": "body, `Body`"}
        )

    def test_accepts_comments_strings_includes_and_other_words(self):
        self.assertEqual(run(HEADER, {}), (0, ""))

    def test_finds_planted_names(self):
        for name in ("until", "until_", "Until", "not_until", "PackFrom", "pack_size", "packs", "takeFirstPart", "first_parts"):
            returned, said = run(HEADER + f"int {name};\n", {})
            self.assertEqual(returned, 1, name)
            self.assertIn(f"a.hpp:7: {name} contains", said)

    def test_allowed_names_must_exist(self):
        self.assertEqual(run(HEADER + "int until_;\n", {"until_": "reason"}), (0, ""))
        returned, said = run(HEADER, {"until_": "reason"})
        self.assertEqual(returned, 1)
        self.assertIn("allows until_", said)

    def test_the_glossary_of_the_project_has_words(self):
        glossary = Path(__file__).resolve().parents[2] / "docs" / "glossary.md"
        self.assertIn("census", names.replaced_words(glossary.read_text(encoding="utf-8")))


if __name__ == "__main__":
    unittest.main()
