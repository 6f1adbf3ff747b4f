"""Identifiers by the glossary:  names.py INCLUDE GLOSSARY

The column "instead of" of the glossary's tables lists words that a term replaces. No identifier of the headers below
INCLUDE contains such a word in code type as a part of its name, in the singular or the plural: `census` forbids `census_`,
`Census` and `make_census`. Comments, strings and the paths of includes are not examined.
"""

import re
import sys
from pathlib import Path

import cpp_reader

# Identifiers that contain a replaced word in another, general meaning: {identifier: reason}.
ALLOWED = {}


def replaced_words(text):
    """{word in code type: term that replaces it}, from the tables of the glossary with a column "instead of"."""
    words, column = {}, None
    for line in text.splitlines():
        cells = [c.strip() for c in line.strip().strip("|").split("|")] if line.startswith("|") else []
        if not cells:
            column = None
        elif "instead of" in cells:
            column = cells.index("instead of")
        elif column is not None and column < len(cells):
            words |= {w: cells[0] for w in re.findall(r"`(\w+)`", cells[column])}
    return words


def parts(identifier):
    """Words of an identifier in CamelCase or snake_case, in small letters."""
    return [p.lower() for p in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+", identifier)]


def contains(identifier, word):
    """True if the words of `word` are consecutive words of `identifier`, the last one also in the plural."""
    of, wanted = parts(identifier), parts(word)
    forms = [wanted, wanted[:-1] + [wanted[-1] + "s"]]
    return any(of[k : k + len(wanted)] in forms for k in range(len(of)))


def identifiers(text):
    """[(line, identifier)] of the code, the first line of each."""
    found = {}
    for number, line in enumerate(cpp_reader.code_of(text).splitlines(), 1):
        for name in re.findall(r"\b[A-Za-z_]\w*", line):
            found.setdefault(name, number)
    return [(number, name) for name, number in found.items()]


def findings(text, words, allowed):
    """[(line, identifier, word)] of the identifiers with a replaced word."""
    return [(n, i, w) for n, i in identifiers(text) if i not in allowed for w in words if contains(i, w)]


def main(include, glossary, allowed=None):
    allowed = ALLOWED if allowed is None else allowed
    words = replaced_words(Path(glossary).read_text(encoding="utf-8"))
    if not words:
        sys.exit(f"names: {glossary} has no column \"instead of\" with a word in code type")
    bad, used = 0, set()
    for header in sorted(Path(include).rglob("*.hpp")):
        text = header.read_text(encoding="utf-8")
        used |= {name for _, name in identifiers(text)} & set(allowed)
        for line, name, word in findings(text, words, allowed):
            bad += 1
            print(f"{header.relative_to(include)}:{line}: {name} contains \"{word}\"; the glossary's term is: {words[word]}")
    for name in sorted(set(allowed) - used):
        bad += 1
        print(f"names.py allows {name}, which no header contains")
    return 1 if bad else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
