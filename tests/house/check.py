"""House rules, read off the headers:  check.py RULE INCLUDE_DIR

floors    a header includes only its own floor or a lower one
words     no #define and no `virtual` in the code (comments may use the words)
length    no header above 410 lines; reports the median and the 90 % line
umbrella  polybody.hpp reaches every header, but for those that say why not
"""

import re
import sys
from pathlib import Path

FLOORS = {
    "math": 0,
    "kinematics": 1,
    "bodies": 2,
    "joints": 3,
    "forces": 3,
    "system": 4,
    "solvers": 5,
    "integrators": 6,
    "analysis": 7,
    "io": 8,
    "vehicle": 9,
    "": 10,  # polybody.hpp itself
}
MAX_LINES = 410

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:<(polybody/[^>]+)>|"([^"]+)")', re.MULTILINE)
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)


def headers(root):
    """Every header, as {path relative to root: text}."""
    files = sorted((root / "polybody").rglob("*.hpp"))
    return {f.relative_to(root).as_posix(): f.read_text(encoding="utf-8") for f in files}


def includes(name, texts):
    """The polybody headers that `name` includes, relative to root."""
    for angle, quoted in INCLUDE.findall(texts[name]):
        beside = (Path(name).parent / quoted).as_posix() if quoted else ""
        yield beside if beside in texts else angle or quoted


def folder(name):
    """polybody/bodies/planar/rigid.hpp -> bodies"""
    parts = name.split("/")
    return parts[1] if len(parts) > 2 else ""


def floors(texts):
    for name in texts:
        if folder(name) not in FLOORS:
            yield f"{name}: folder '{folder(name)}' has no floor (see FLOORS in check.py)"
            continue
        for other in includes(name, texts):
            if not other.startswith("polybody/"):
                yield f"{name}: \"{other}\" is neither beside it nor a polybody/... path"
            elif other not in texts:
                yield f"{name}: includes {other}, which does not exist"
            elif FLOORS.get(folder(other), 0) > FLOORS[folder(name)]:
                yield (
                    f"{name} (floor {FLOORS[folder(name)]}) looks up at "
                    f"{other} (floor {FLOORS[folder(other)]})"
                )


def words(texts):
    for name, text in texts.items():
        # Blank out comments and strings, keeping the lines.
        code = NOT_CODE.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
        for number, line in enumerate(code.splitlines(), 1):
            if re.match(r"\s*#\s*define\b", line):
                yield f"{name}:{number}: #define (use a constexpr or a template)"
            if re.search(r"\bvirtual\b", line):
                yield f"{name}:{number}: virtual (use a concept)"


def length(texts):
    counts = {name: len(text.splitlines()) for name, text in texts.items()}
    ordered = sorted(counts.values())
    if ordered:
        last = len(ordered) - 1
        print(
            f"{len(ordered)} headers, {sum(ordered)} lines; median {ordered[last // 2]}, "
            f"90 % {ordered[round(0.9 * last)]}, longest {ordered[last]} (aim: 105, 240, {MAX_LINES})"
        )
    for name, count in counts.items():
        if count > MAX_LINES:
            yield f"{name}: {count} lines, more than {MAX_LINES}"


def umbrella(texts):
    top = "polybody/polybody.hpp"
    if top not in texts:
        yield f"{top} does not exist"
        return
    reached, todo = {top}, [top]
    while todo:
        for other in includes(todo.pop(), texts):
            if other in texts and other not in reached:
                reached.add(other)
                todo.append(other)
    for name in texts:
        if name not in reached and "Not in polybody.hpp" not in texts[name]:
            yield f"{name} is not reached from {top}, and does not say why (Not in polybody.hpp: …)"


RULES = {f.__name__: f for f in (floors, words, length, umbrella)}


def main(rule, root):
    texts = headers(Path(root))
    if not texts:
        sys.exit(f"no header under {root}/polybody")
    found = list(RULES[rule](texts))
    print(*found, sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in RULES:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
