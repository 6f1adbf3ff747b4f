"""Tests of docs/references: which words are citations, which entry they name, and the form of the bibliography."""

import importlib.util
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "docs" / "references"
SPEC = importlib.util.spec_from_loader("references", SourceFileLoader("references", str(SCRIPT)))
references = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(references)

BIB = """% A comment.
@article{romero2004,
  author = {Romero, I.},
  year = {2004},
  title = {Rods},
  journal = {Mechanics},
  volume = {34},
  pages = {1–3},
  doi = {10.1/a(b)c},
}

@book{geradinrixen2015,
  author = {Géradin, M. and Rixen, D. J.},
  year = {2015},
  title = {Vibrations},
  publisher = {Wiley},
  edition = {3rd},
}

@article{sola2018,
  author = {Solà, J. and García de Jalón, J. and van der Vorst, H. A.},
  year = {2018},
  title = {Groups},
  journal = {Mechanics},
}

@article{vuquoc1986b,
  author = {Simo, J. C. and Vu-Quoc, L.},
  year = {1986},
  citedyear = {1986b},
  title = {Rods},
  journal = {Mechanics},
}

@techreport{iso2020,
  author = {{ISO}},
  year = {2020},
  citedauthor = {ISO C++},
  title = {Languages},
  institution = {ISO},
}

@article{romero2006,
  author = {Romero, I.},
  year = {2006},
  title = {More rods},
  journal = {Mechanics},
}
"""
ENTRIES = references.read_bib(BIB)


def keys(text, name="page.md"):
    return [key for _, _, key in references.citations(references.prose(name, text), references.Bibliography(ENTRIES))]


class Found(unittest.TestCase):
    def test_forms(self):
        for text, expected in {
            "as Romero 2004 shows": ["romero2004"],
            "of Romero [2004], Romero (2004), Romero's [2004]": 3 * ["romero2004"],
            "[Romero 2004, §3; Romero 2006]": ["romero2004", "romero2006"],
            "[Romero 2004, 2006]": ["romero2004", "romero2006"],
            "[Romero 2004; 2006, §1]": ["romero2004", "romero2006"],
            "| Géradin & Rixen 2015 |": ["geradinrixen2015"],
            "Géradin and Rixen 2015, Géradin–Rixen 2015": 2 * ["geradinrixen2015"],
            "[Solà et al. 2018]": ["sola2018"],
            "[Solà, García de Jalón & van der Vorst 2018: groups]": ["sola2018"],
            "Simo & Vu-Quoc 1986b": ["vuquoc1986b"],
            "[ISO C++ 2020, rand]": ["iso2020"],
            "Finally, Romero 2004": ["romero2004"],
        }.items():
            self.assertEqual(keys(text), expected, text)

    def test_over_lines(self):
        self.assertEqual(keys("/// the rods [Géradin &\n/// Rixen 2015; Romero\n/// 2004]\n", "a.hpp"), ["geradinrixen2015", "romero2004"])
        self.assertEqual(keys("double k;  ///< [Romero 2004]\nint n = 1;  // Romero 2006", "a.hpp"), ["romero2004", "romero2006"])
        found = references.citations("\n\nRomero 1999", references.Bibliography(ENTRIES))
        self.assertEqual(found, [(3, "Romero 1999", None)])


class Missing(unittest.TestCase):
    def test_without_entry(self):
        for text in ("Romero 2005", "Simo & Vu-Quoc 1986", "Simo 1986b", "Géradin 2015", "Rixen 2015", "[Solà & Rixen 2015]", "Unknown & Romero 2004",
                     "Rixen, Romero 2004", "Romero et al. 2004", "von Mises 1913", "McKay 1979", "Gutiérrez-Romero 2004"):
            self.assertEqual(keys(text), [None], text)


class Ignored(unittest.TestCase):
    def test_no_citations(self):
        for text in ("in November 2026", "the year 2004", "`Romero 2005`", "GeneralisedAlpha 2000 steps", "Version 2004.1", "File 2004-11", "Size 20040", "[a](Romero 2005)"):
            self.assertEqual(keys(text), [], text)
        self.assertEqual(keys("auto Romero = Romero(2005);\n", "a.hpp"), [])
        self.assertEqual(keys("```cpp\nRomero x{Romero 2005};  // Romero 2004\n```\n"), ["romero2004"])


class Bibliography(unittest.TestCase):
    def test_page(self):
        lines = references.page(ENTRIES).splitlines()[-6:]
        self.assertEqual(lines[0], "- Géradin, M. & Rixen, D. J. 2015, *Vibrations*, Wiley, 3rd edition")
        self.assertEqual(lines[1], "- ISO (cited as ISO C++) 2020, *Languages*, ISO")
        self.assertEqual(lines[2], "- Romero, I. 2004, *Rods*, Mechanics 34, 1–3. [doi:10.1/a(b)c](https://doi.org/10.1/a%28b%29c)")
        self.assertEqual(lines[5], "- Solà, J., García de Jalón, J. & van der Vorst, H. A. 2018, *Groups*, Mechanics")

    def test_refused(self):
        for text in ("@book{a1,\n  author = {A, B.},\n}\n", "@book{a1,\n  unknown = {A},\n}\n", BIB + BIB, "@book{a1,\n  author = {A},\n  year = {1},\n  title = {T},\n}\n"):
            with self.assertRaises(ValueError, msg=text):
                references.read_bib(text)


if __name__ == "__main__":
    unittest.main()
