"""Formulas in the headers: the positions before terms at which a mutant's factor can be inserted."""

import re
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests" / "house"))
from cpp_reader import code_of, declarations  # noqa: E402

OPERAND = r"(?=[\w(\-])(?!(?:std::move|std::forward|nullptr|true|false|new|co_)\b)(?!\w+\{)"
STARTS = re.compile(rf"(?: = |\breturn | [+-]= ){OPERAND}")
TERMS = re.compile(rf"(?<=[\w)\]}}] )[+-] {OPERAND}")
FORMULA = re.compile(r" [*/+-] |\.cross\(|\.dot\(|\.transpose\(\)|^-")


@dataclass(frozen=True)
class Site:
    header: str  # polybody/math/so3.hpp
    line: int
    place: int  # in the text of the header
    row: str  # with a mark at the position


def outside_brackets(text):
    """The text up to the end of its statement, with the content of brackets blanked."""
    out, depth = [], 0
    for c in text:
        depth -= c in ")]}"
        if depth < 0 or (c == ";" and depth == 0):
            break
        out.append(c if depth == 0 else "_")
        depth += c in "([{"
    return "".join(out)


def bodies_of(text, code):
    """(first, last position) of the body of each function that does not return a reference."""
    lines = [0]
    for m in re.finditer("\n", code):
        lines.append(m.end())
    for d in declarations(text):
        if d.kind != "function" or not d.body:
            continue
        begin = code.find(d.head, lines[d.first - 1])
        last = lines[d.last] if d.last < len(lines) else len(code)
        name = d.name.split("::")[-1]
        if begin < 0 or "&" in d.head.split(name)[0] or "decltype(auto)" in d.head:
            continue
        yield begin + len(d.head), last


def sites_of(path, header):
    """Every site of a header, in order."""
    text = path.read_text()
    code = code_of(text)
    found = set()
    for begin, end in bodies_of(text, code):
        for m in STARTS.finditer(code, begin, end):
            line = code[code.rfind("\n", 0, m.start()) + 1 : m.start()]
            if re.search(r"&\s*\w+$|\busing\b|\bconcept\b|\boperator$", line):
                continue
            rest = outside_brackets(code[m.end() : end]).replace("\n", " ")
            lone = re.fullmatch(r"\s*-?[\d.]+\s*", rest)
            if FORMULA.search(rest) and " = " not in rest and not lone:  # in a = b = c, b is not a term
                found.add(m.end())
        for m in TERMS.finditer(code, begin, end):
            found.add(m.end())
    for place in sorted(found):
        row = f"{text[text.rfind(chr(10), 0, place) + 1 : place]}»{text[place : text.find(chr(10), place)]}".strip()
        if '"' not in row and not re.match(r"(template|using|static_assert|requires|case|constexpr)\b", row):
            yield Site(header, text.count("\n", 0, place) + 1, place, row)


def all_sites(include):
    """Every site of the library, without the law suites for users' types."""
    for path in sorted((include / "polybody").rglob("*.hpp")):
        header = str(path.relative_to(include))
        if not header.startswith("polybody/testing/"):
            yield from sites_of(path, header)


def put_in(include, numbered):
    """Writes the sites, {number: site}, to the headers of a copy."""
    by_header = {}
    for number, site in numbered.items():
        by_header.setdefault(site.header, []).append((site.place, number))
    for header, places in by_header.items():
        path = include / header
        text = path.read_text()
        for place, number in sorted(places, reverse=True):
            text = text[:place] + f"::polybody::mutants::Site<{number}>{{}} * " + text[place:]
        path.write_text(text.replace("#pragma once", "#pragma once\n#include <polybody/mutant.hpp>", 1))


if __name__ == "__main__":
    found = list(all_sites(ROOT / "include"))
    for site in found:
        print(f"{site.header}:{site.line}: {site.row}")
    print(f"{len(found)} sites", file=sys.stderr)
