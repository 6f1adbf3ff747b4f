"""Layout of pages and small programs:  pages.py ROOT [--split FILE...]

- A line of a page has one sentence, also in lists, and a sentence does not continue on the next line. Tables, code,
  formulas and headings are exempt. --split writes each sentence of the given pages in its own line.
- In the pages of ONE_NUMBER, a cell of a table has at most one number, except in the first column. Numbers in code,
  sources and units in brackets, and intervals such as 1 to 4 s count as words.
- No file cites CASES3 or M113.md, which are not part of the repository.
- A program of examples/mechanisms has at most 60 lines.
"""

import re
import subprocess
import sys
from pathlib import Path

GENERATED = re.compile(r"docs/(notes|validated)/.*|docs/references\.md")  # or notes
ONE_NUMBER = re.compile(r"docs/(performance|reliability|chapter2|tracked_vehicle|track_stress|validation|peers|chapter3/runs)\.md")
MISSING = re.compile(r"\bCASES\d*\.md\b|\bCASES\d\b|\bM113\.md\b")
LONGEST_MECHANISM = 60  # lines

MASK = "\u2024"  # replaces a character that does not end a sentence
NO_END = re.compile(
    r"`[^`]*`|\$[^$]*\$|\]\([^)]*\)"  # code, formulas, addresses
    r"|^\*+[^*]*\.\*+|^\[\d+\."  # a heading within a line, a numbered link
    r"|\b(?:e\.g|i\.e|App|Eqs?|Figs?|Secs?|ch|cf|vol|pp?|al|No|approx|resp|vs|etc|eds?|Dr)\."
    r"|(?<!\d )\b[A-Z]\.(?=[ -])"  # initials
)
END = re.compile(r"[.!?][)\"”*’]*(?=\s+[^\sa-z])")
NUMBER = re.compile(r"(?<![\w.₀-₉⁰-⁹])[−-]?\d+(?:[.,  ]\d+)*(?:e[−-]?\d+)?")


def sentence_ends(line):
    """Places at which a sentence ends and another one begins."""
    return [m.end() for m in END.finditer(NO_END.sub(lambda m: re.sub(r"[.!?]", MASK, m[0]), line))]


def without_code(text):
    """A page without comments, blocks of code and displayed formulas; the numbers of its lines remain."""
    return re.sub(r"<!--.*?-->|^\s*```.*?^\s*```|^\$\$.*?\$\$$", lambda m: re.sub(r"[^\n]", "", m[0]), text, flags=re.S | re.M)


def lines_of_prose(text):
    """(number of a line from 0, indentation and mark of a list item, the other text) of the lines with sentences."""
    for number, line in enumerate(without_code(text).split("\n")):
        mark = re.match(r"\s*(?:>\s*)?(?:(?:[-*]|\d+\.) +)?", line)[0]
        if line.strip() and not line.lstrip().startswith(("|", "#", "<", "![")) and not line.startswith("    "):
            yield number, mark, line[len(mark) :]


def faults_of_lines(name, text):
    before, paragraph = -2, ""
    for number, mark, line in lines_of_prose(text):
        if sentence_ends(line):
            yield f"{name}:{number + 1}: more than one sentence: {line[:80]}"
        is_item = mark.strip() not in ("", ">")
        if before == number - 1 and not is_item and not re.search(r"[.!?:;][)\"”*’_`]*\s*$", paragraph):
            yield f"{name}:{number}: the sentence continues on the next line: {paragraph[-80:]}"
        before, paragraph = number, line


def split(text):
    """The text of a page with each sentence in its own line."""
    lines = text.split("\n")
    for number, mark, line in reversed(list(lines_of_prose(text))):
        line, begin, parts = lines[number][len(mark) :], 0, []
        for end in [*sentence_ends(re.sub(r"<!--.*?-->", lambda m: MASK * len(m[0]), line)), len(line)]:
            parts.append(line[begin:end].strip() if parts else line[begin:end].rstrip())
            begin = end
        indentation = re.sub(r"[^\s>]", " ", mark)
        lines[number] = "\n".join([mark + parts[0], *(indentation + part for part in parts[1:])])
    return "\n".join(lines)


def faults_of_cells(name, text):
    for number, line in enumerate(without_code(text).split("\n"), 1):
        for cell in line.strip().strip("|").split("|")[1:] if line.startswith("|") else ():
            plain = re.sub(r"`[^`]*`|\]\([^)]*\)|\[[\d, ]+\]|\[1/\w+\]|\b\d+ to \d+", "", cell)
            if len(NUMBER.findall(plain)) > 1:
                yield f"{name}:{number}: more than one number in a cell: {cell.strip()[:80]}"


def faults(root, names):
    for name in names:
        path = root / name
        if path.suffix not in (".md", ".cpp", ".hpp", ".py", ".txt", ".cmake", "") or not path.is_file():
            continue
        text = path.read_text(encoding="utf-8", errors="replace")
        if not name.startswith("tests/house/pages"):
            yield from (f"{name}: cites {m[0]}, which is not part of the repository" for m in MISSING.finditer(text))
        if path.suffix == ".md" and (name.startswith("docs/") or name in ("README.md", "CONTRIBUTING.md")) and not GENERATED.fullmatch(name):
            yield from faults_of_lines(name, text)
        if ONE_NUMBER.fullmatch(name):
            yield from faults_of_cells(name, text)
        if re.fullmatch(r"examples/mechanisms/.*\.cpp", name) and (count := text.count("\n")) > LONGEST_MECHANISM:
            yield f"{name}: {count} lines, at most {LONGEST_MECHANISM} are allowed"


def main(arguments):
    if not arguments or not Path(arguments[0]).is_dir():
        sys.exit(__doc__)
    if "--split" in arguments:
        for path in map(Path, arguments[arguments.index("--split") + 1 :]):
            path.write_text(split(path.read_text(encoding="utf-8")), encoding="utf-8")
        return 0
    root = Path(arguments[0])
    listed = subprocess.run(["git", "-C", str(root), "ls-files"], capture_output=True, text=True, check=True).stdout
    found = list(faults(root, listed.splitlines()))
    print("\n".join(found) or "Each line of the pages has one sentence.")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
