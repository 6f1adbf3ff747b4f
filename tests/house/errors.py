"""Codes of the errors:  errors.py INCLUDE PAGE

Each `throw` of an exception of the library in the headers below INCLUDE has a code, a string literal `area.fault`, or
takes over the code of an `ErrorCause`. The table of PAGE lists each code with its exception types, and no other.
"""

import re
import sys
from pathlib import Path

CODE = re.compile(r'"([a-z][a-z0-9_]*\.[a-z][a-z0-9_]*)"')
ROW = re.compile(r"\| `([a-z][a-z0-9_.]*)` \| ((?:`\w+`(?:, )?)+) \| \S.* \|")


def without_comments(text):
    """Text with comments replaced by blanks; strings stay."""
    blank = lambda m: m[0] if m[0][0] in "\"'" else re.sub(r"[^\n]", " ", m[0])
    return re.sub(r"//[^\n]*|/\*.*?\*/|\"(?:[^\"\\\n]|\\.)*\"|(?<![0-9a-fA-F])'(?:[^'\\\n]|\\.)+'", blank, text,
                  flags=re.S)


def throws(text):
    """Line, type and arguments of each throw expression of `text`; a rethrow and a std exception are left out."""
    text = without_comments(text)
    for found in re.finditer(r"\bthrow\s+((?:\w+::)*\w+)\s*([({])", text):
        if found[1].startswith("std::"):
            continue
        begin = end = found.end()
        depth = 1
        for part in re.finditer(r'"(?:[^"\\]|\\.)*"|[(){}]', text[begin:]):
            depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(part[0], 0)
            if depth == 0:
                end = begin + part.start()
                break
        yield text.count("\n", 0, found.start()) + 1, found[1].split("::")[-1], text[begin:end]


def codes_of(arguments):
    """Codes before the parts of the message; a condition chooses between two."""
    return CODE.findall(arguments.split("{")[0])


def faults(sources, page):
    types = {}
    for name, text in sources:
        for line, kind, arguments in throws(text):
            codes = codes_of(arguments)
            if not codes and "ErrorCause{" not in arguments:
                yield f"{name}:{line}: this {kind} has no code"
            for code in codes:
                types.setdefault(code, set()).add(kind)
    listed = {}
    for line in page.splitlines():
        if row := ROW.fullmatch(line):
            if row[1] in listed:
                yield f"the page lists {row[1]} twice"
            listed[row[1]] = set(re.findall(r"\w+", row[2]))
    for code in sorted(types.keys() | listed.keys()):
        if code not in listed:
            yield f"the page does not list {code} ({', '.join(sorted(types[code]))})"
        elif code not in types:
            yield f"the page lists {code}, but no header throws it"
        elif listed[code] != types[code]:
            yield f"the page lists {code} as {sorted(listed[code])}, but the headers throw {sorted(types[code])}"
    if list(listed) != sorted(listed):
        yield "the page does not list the codes in alphabetical order"


def self_test():
    """Each fault is found in a source or page that has it."""
    page = "| `bar.length` | `InvalidInput` | length |\n"
    good = 'throw InvalidInput("bar.length", {"a (b) {c}", ErrorValue{x}});'
    assert not list(faults([("a", good + " throw; throw std::bad_alloc();")], page))
    assert not list(faults([("a", good + ' throw InvalidInput({"b: ", ErrorCause{e}});')], page))
    assert not list(faults([("a", good + '\n// throw InvalidInput("text");')], page))
    for text in ('throw InvalidInput("text");', 'throw InvalidInput{"a.b"};'[:-3] + ' of a text"};',
                 'throw detail::InvalidInput("No code", {"a"});', "throw InvalidInput(text);"):
        assert [f for f in faults([("a", good + text)], page) if "has no code" in f], text
    for text, changed in ((good, ""), ("", page), (good.replace("InvalidInput", "IoError"), page), (good, page * 2),
                          (good + good.replace("bar", "a"), page + page.replace("bar", "a"))):
        assert list(faults([("a", text)], changed)), (text, changed)
    assert codes_of('found ? "a.b" : "c.d", {"e.f"}') == ["a.b", "c.d"]


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    self_test()
    root = Path(sys.argv[1])
    files = sorted(root.rglob("*.hpp"))
    found = list(faults([(f.relative_to(root), f.read_text(encoding="utf-8")) for f in files],
                        Path(sys.argv[2]).read_text(encoding="utf-8")))
    print(*found, sep="\n")
    sys.exit(1 if found or not files else 0)
