"""Tests of prose.py and reading.py: each wrong number of a page is reported, and nothing else."""

import unittest

from prose import marked_numbers, numbers_without_source
from reading import by_pattern, columns

NUMBERS = {"ancf": {"strain": 0.2984, "forward": -40.086, "apart": 1.6, "rate": 18340.0}}


def faults(text, case="links"):
    return marked_numbers(text, case, NUMBERS)[1]


class Marked(unittest.TestCase):
    def test_right_ones_pass(self):
        for text in ("0.298<!--links/ancf/strain-->·10⁻⁵", "0.3<!--links/ancf/strain-->", "−40.1<!--links/ancf/forward--> m",
                     "1.83e4<!--links/ancf/rate--> 1/s", "18340<!--links/ancf/rate-->"):
            self.assertEqual(marked_numbers(text, "links", NUMBERS), (text, []))

    def test_wrong_ones_are_mended_to_their_digits(self):
        text, found = marked_numbers("at 0.31<!--links/ancf/strain-->, 40<!--links/ancf/forward--> m", "links", NUMBERS)
        self.assertEqual(text, "at 0.30<!--links/ancf/strain-->, −40<!--links/ancf/forward--> m")
        self.assertEqual([mended for _, mended in found], [True, True])

    def test_powers_of_ten_are_mended(self):
        self.assertEqual(marked_numbers("2.91e5<!--links/ancf/rate-->", "links", NUMBERS)[0], "1.83e4<!--links/ancf/rate-->")

    def test_bounds_are_kept(self):
        self.assertEqual(faults("2<!--<= links/ancf/apart--> and 1<!-->= links/ancf/apart-->"), [])
        found = faults("1<!--<= links/ancf/apart--> and 2<!-->= links/ancf/apart-->")
        self.assertEqual([mended for _, mended in found], [False, False])

    def test_other_cases_are_left_alone(self):
        self.assertEqual(faults("7<!--links/ancf/strain-->", "other"), [])

    def test_numbers_that_are_not_printed_are_faults(self):
        self.assertEqual(len(faults("7<!--links/ancf/stress--> 7<!--links/beam/strain-->")), 2)


class Sources(unittest.TestCase):
    def test_numbers_need_one(self):
        text = "Off by 1.5 %.\nIn 10 s, off by 1<!--links/a/b--> %.\n"
        self.assertEqual(len(numbers_without_source(text, {"links": ()}, {})), 2)
        self.assertEqual(len(numbers_without_source(text, {}, {"10 s": "an option", "by 1.5 %": "a test"})), 1)
        self.assertEqual(numbers_without_source(text, {"links": ()}, {"10 s": "an option", "by 1.5 %": "a test"}), [])

    def test_a_citation_is_in_one_line(self):
        self.assertEqual(len(numbers_without_source("See [a](#a).\nOff by 1.5 %.\nBy [Craig & Bampton 1968].", {}, {})), 1)

    def test_a_phrase_is_whole(self):
        self.assertEqual(len(numbers_without_source("0.5 s and 15 s", {}, {"5 s": "an option"})), 3)

    def test_phrases_that_are_gone_are_faults(self):
        self.assertEqual(len(numbers_without_source("no number", {}, {"10 s": "an option"})), 1)

    def test_names_are_no_numbers(self):
        for text in ("Figures 4.6, 4.9 and 4.11, Table (3.4), §4.3.5, Chapter 2", "`--until 3`", "```sh\nrun 3\n```", "T₀ v² m3",
                     "<!-- tests/long: links -->\n| 1.5 |\n<!-- end -->", "[Craig & Bampton 1968]", "[a](b3.md)"):
            self.assertEqual(numbers_without_source(text, {"links": ()}, {}), [], text)


class Reading(unittest.TestCase):
    def test_columns(self):
        numbers, table = columns(6, ["a", "b"], ["name", "b"], {"b": 1})("one    1.25  -2.55 %\nhead a\ntwo,   3.0  4.0\n")
        self.assertEqual(numbers, {"one": {"a": 1.25, "b": -2.55}, "two,": {"a": 3.0, "b": 4.0}})
        self.assertEqual(table, "| name | b |\n|---|---|\n| one | -2.5 |\n| two, | 4.0 |")

    def test_patterns(self):
        read = by_pattern({("a", "b"): r"b ([\d.]+)", ("a", "c"): r"c ([\d.]+)"})
        self.assertEqual(read("b 1.5, b 2.5"), ({"a": {"b": 2.5}}, ""))


if __name__ == "__main__":
    unittest.main()
