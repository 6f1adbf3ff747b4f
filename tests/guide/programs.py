"""The programs of the pages in docs/guide, docs/howto, docs/items and docs/lessons and of docs/coming_from.md, and their output.

  programs.py names PAGE...            folder/page:name of each, one per line. A program is the block after
                                       <!-- program: NAME -->; blocks after <!-- more: NAME --> continue it. A block has at most
                                       60 lines, in docs/howto 30, in docs/items 25. A program includes the standard
                                       header of each name of std that it uses. A page in docs may have other blocks
                                       of C++, such as programs of other codes
  programs.py write PAGE NAME FILE     writes one of them
  programs.py check PAGE NAME PROGRAM  runs it and compares its output with the block after <!-- output: NAME -->: words
                                       exactly, numbers to a thousandth, sizes of errors (1e-9) to a factor of 100
  programs.py self                     tests of `check`: differences that it reports and accepts; tests of missing headers
  programs.py lines PAGE TESTS         compares counts of the page, such as 32<!--lines: car_test, by hand + of both-->, with the
                                       numbers of lines in TESTS/car_test.cpp between "// --- code by hand" or "// --- code
                                       of both" and "// --- end", without comments and blank lines
  programs.py errors PAGE INCLUDE      checks that the page's table has exactly the exceptions that the headers under INCLUDE
                                       declare, each with its cause and remedy

"""
import re
import subprocess
import sys
from pathlib import Path

MAX_LINES = {"docs": 30, "guide": 60, "items": 25, "lessons": 60, "howto": 30}  # of a block, by folder
BLOCK = re.compile(r"<!-- (program|more|output): (\w+) -->\n```(?:cpp|text)\n(.*?)```", re.S)
HEADERS = {  # names of std; those of "" are in every header of containers
    "": "move ptrdiff_t size_t",
    "algorithm": "clamp copy fill max max_element min min_element ranges sort",
    "array": "array",
    "cmath": "abs acos asin atan atan2 cbrt ceil cos cosh exp floor hypot isfinite isnan log log10 log1p pow round sin sinh sqrt tan tanh",
    "concepts": "same_as",
    "cstdio": "fprintf printf puts snprintf",
    "filesystem": "filesystem",
    "fstream": "ifstream ofstream",
    "functional": "function",
    "iostream": "cerr cout",
    "numbers": "numbers",
    "optional": "nullopt optional",
    "span": "span",
    "string": "string to_string",
    "tuple": "tuple",
    "type_traits": "conditional_t decay_t remove_cvref_t",
    "vector": "vector",
}
HEADER_OF = {name: header for header, names in HEADERS.items() for name in names.split()}
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def missing_headers(code):
    """Standard headers of the names in the program that it does not include; "?" for names that HEADERS does not list."""
    needed = {HEADER_OF.get(name, f"? (std::{name})") for name in re.findall(r"\bstd::(\w+)", code)}
    return sorted(needed - {""} - set(re.findall(r"^#include <(\w+)>", code, re.M)))


def blocks(page):
    text = Path(page).read_text(encoding="utf-8")
    most = MAX_LINES[Path(page).parent.name]
    found, continued = {"program": {}, "output": {}}, 0
    for kind, name, content in BLOCK.findall(text):
        if kind != "output" and content.count("\n") > most:
            sys.exit(f"{page}: a block of {name} has {content.count(chr(10))} lines, above {most}.")
        if kind == "more":
            if name not in found["program"]:
                sys.exit(f"{page}: nothing comes before what continues {name}.")
            found["program"][name] += "\n" + content
            continued += 1
            continue
        if name in found[kind]:
            sys.exit(f"{page}: two blocks are the {kind} of {name}.")
        found[kind][name] = content
    if set(found["program"]) != set(found["output"]):
        sys.exit(f"{page}: programs and outputs differ: {sorted(set(found['program']) ^ set(found['output']))}.")
    for name, code in found["program"].items():
        if missing := missing_headers(code):
            sys.exit(f"{page}: {name} does not include <{'>, <'.join(missing)}>.")
    fences = len(re.findall(r"^```cpp$", text, re.M))
    if Path(page).parent.name != "docs" and fences != len(found["program"]) + continued:
        sys.exit(f"{page}: {fences} blocks of C++, but {len(found['program']) + continued} are programs or continue one.")
    return found


def same_number(shown, printed):
    a, b = float(shown), float(printed)
    if "e" in shown or "e" in printed:  # an error: of the same size
        return a == b or (a * b > 0.0 and 1e-2 < a / b < 1e2) or max(abs(a), abs(b)) < 1e-9
    last = 10.0 ** -len(shown.split(".")[1]) if "." in shown else 1.0
    return abs(a - b) <= max(1e-3 * abs(a), 1.01 * last if "." in shown else 0.0)


def difference(shown, printed):
    """The first line that differs, or nothing."""
    a, b = shown.rstrip("\n").split("\n"), printed.rstrip("\n").split("\n")
    for k in range(max(len(a), len(b))):
        x, y = (lines[k] if k < len(lines) else "(nothing)" for lines in (a, b))
        numbers_x, numbers_y = NUMBER.findall(x), NUMBER.findall(y)
        words = [re.sub(r"\s+", " ", NUMBER.sub("#", line)).strip() for line in (x, y)]
        if words[0] != words[1] or len(numbers_x) != len(numbers_y) or not all(map(same_number, numbers_x, numbers_y)):
            return f"line {k + 1}: the page has\n  {x}\nthe program prints\n  {y}"
    return None


def check_self():
    passes = [("a 1.25 m\n", "a 1.25 m"), ("x  2.00", "x 2.01"), ("off 3e-07 J", "off 8e-06 J"), ("0e+00", "2e-16"), ("5 rows", "5 rows")]
    fails = [("a 1.25 m", "a 1.25 s"), ("2.00", "2.05"), ("off 3e-07 J", "off 8e-05 J"), ("5 rows", "6 rows"), ("a", "a\nb"), ("1 2", "1"),
             ("-1e-3", "1e-3")]
    for shown, printed in passes:
        if difference(shown, printed):
            sys.exit(f"found: {shown!r}, {printed!r}")
    for shown, printed in fails:
        if not difference(shown, printed):
            sys.exit(f"not found: {shown!r}, {printed!r}")
    code = "#include <cmath>\nstd::sin(std::max(x, 1.0)); std::numbers::pi; std::size_t n; std::unknown(n);\n"
    if missing_headers(code) != ["? (std::unknown)", "algorithm", "numbers"]:
        sys.exit(f"headers: {missing_headers(code)}")
    code = "// --- code by hand\na\n\n// b\n  // --- end\nc\n// --- code of both\nd\n// --- end\n// --- code by hand\ne\nf\n// --- end\n"
    if lines_of_code(code) != {"by hand": 3, "of both": 1}:
        sys.exit(f"lines: {lines_of_code(code)}")


def check_errors(page, include):
    """Compares the classes that derive from Error, directly or indirectly, with the rows of the page's table."""
    bases = {}
    for header in Path(include).rglob("*.hpp"):
        bases.update(re.findall(r"^(?:class|struct) (\w+)(?: final)? : (?:public )?(\w+) \{", header.read_text(encoding="utf-8"), re.M))
    declared, more = {"Error"}, True
    while more:
        more = {name for name, base in bases.items() if base in declared} - declared
        declared |= more
    rows = re.findall(r"^\| `(\w+)` \| (.*?) \| (.*?) \|$", Path(page).read_text(encoding="utf-8"), re.M)
    differ = declared - {"Error"} ^ {name for name, _, _ in rows}
    if differ:
        sys.exit(f"{page}: exceptions that are shown and declared differ: {sorted(differ)}.")
    for name, cause, remedy in rows:
        if not cause.strip() or not remedy.strip():
            sys.exit(f"{page}: {name} has no cause or no remedy.")


COUNT = re.compile(r"(\d+)<!--lines: (\w+), ([\w +]+)-->")
REGION = re.compile(r"^ *// --- code ([\w ]+)\n(.*?)^ *// --- end$", re.M | re.S)


def lines_of_code(text):
    """Lines of each kind of marked code: {"by hand": 32}."""
    found = {}
    for kind, code in REGION.findall(text):
        found[kind] = found.get(kind, 0) + sum(1 for line in code.splitlines() if line.strip() and not line.lstrip().startswith("//"))
    return found


def check_lines(page, tests):
    counts = COUNT.findall(Path(page).read_text(encoding="utf-8"))
    if not counts:
        sys.exit(f"{page}: no count of lines.")
    for count, name, kinds in counts:
        found = lines_of_code((Path(tests) / f"{name}.cpp").read_text(encoding="utf-8"))
        lines = sum(found[kind] for kind in kinds.split(" + "))
        if lines != int(count):
            sys.exit(f"{page}: {count} lines of {name}, {kinds}, but there are {lines}.")


def main(command, *arguments):
    if command == "names":
        for page in arguments:
            for name in blocks(page)["program"]:
                print(f"{Path(page).parent.name}/{Path(page).stem}:{name}")
    elif command == "write":
        page, name, file = arguments
        Path(file).write_text(blocks(page)["program"][name], encoding="utf-8")
    elif command == "check":
        page, name, program = arguments
        ran = subprocess.run([program], capture_output=True, text=True)
        if ran.returncode != 0:
            sys.exit(f"{name} ends with {ran.returncode}: {ran.stderr}")
        wrong = difference(blocks(page)["output"][name], ran.stdout)
        if wrong:
            sys.exit(f"{page}, {name}, {wrong}\nwhole output:\n{ran.stdout}")
    elif command == "self":
        check_self()
    elif command == "lines":
        page, tests = arguments
        check_lines(page, tests)
    elif command == "errors":
        page, include = arguments
        check_errors(page, include)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(*sys.argv[1:])
