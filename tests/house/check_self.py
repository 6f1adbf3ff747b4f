"""Tests of check.py: each rule finds what it must find, and nothing else."""

import unittest

import check

GOOD = {
    "polybody/polybody.hpp": "#include <polybody/bodies/rigid.hpp>\n",
    "polybody/bodies/rigid.hpp": '#include "polybody/math/so3.hpp"\n#include "mass.hpp"\n',
    "polybody/bodies/mass.hpp": "#include <Eigen/Dense>\n#include <vector>\n",
    "polybody/math/so3.hpp": '// no #define, virtual work\n/* virtual */ auto s = "virtual";\n',
}


class Check(unittest.TestCase):
    def found(self, rule, **changes):
        renamed = {f"polybody/{k.replace('__', '/')}.hpp": v for k, v in changes.items()}
        return list(check.RULES[rule](GOOD | renamed))

    def test_good_tree_passes(self):
        for rule in check.RULES:
            self.assertEqual(self.found(rule), [], rule)

    def test_floors(self):
        for line in ('#include "polybody/bodies/rigid.hpp"', "#  include <polybody/bodies/rigid.hpp>",
                     '#include "../bodies/rigid.hpp"', '#include "polybody/math/none.hpp"'):
            self.assertEqual(len(self.found("floors", math__so3=line)), 1, line)
        self.assertEqual(len(self.found("floors", cellar__x="")), 1)
        self.assertEqual(self.found("floors", math__so3="// #include <polybody/bodies/rigid.hpp>"), [])

    def test_words(self):
        self.assertEqual(len(self.found("words", math__so3="int a;\n# define PI 3\n")), 1)
        self.assertEqual(len(self.found("words", math__so3="struct A { virtual void f(); };")), 1)

    def test_length(self):
        self.assertEqual(len(self.found("length", math__so3="//\n" * 411)), 1)
        self.assertEqual(self.found("length", math__so3="//\n" * 410), [])

    def test_umbrella(self):
        self.assertEqual(len(self.found("umbrella", math__lonely="")), 1)
        self.assertEqual(self.found("umbrella", math__lonely="/// Not in polybody.hpp: needs a library.\n"), [])


if __name__ == "__main__":
    unittest.main()
