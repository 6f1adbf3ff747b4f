"""Prose check:  prose.py ROOT [--list FILE...] [--shrink]

Reads the sentences of pages (.md), of comments (.hpp, .cpp, .cmake) and of the messages that the headers throw, and
reports the sentences that a reader has to read twice. One strong rule or two weak ones make a finding.

prose_allowed.txt gives the allowed number of findings per file; a file without an entry may have none. The list only
shrinks: --shrink lowers its numbers. --list prints the findings of the given files. Dates, commit hashes and machines are
findings in every page outside docs/notes. Pages in LONGEST have at most the given number of words.

"""

import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
LIST = HERE / "prose_allowed.txt"
NEVER = re.compile(r"README\.md|docs/(guide/.*|using|overview|glossary|migration)\.md")  # no entry in the list
DIARY_ALLOWED = re.compile(r"docs/notes/|CHANGELOG\.md|LICENSE")
SKIPPED = re.compile(r"docs/(validated|notes)/.*\.md|cmake/viewer/")

LONGEST = {"docs/performance.md": 1200, "docs/reliability.md": 900, "docs/track_stress.md": 2000, "docs/tracked_vehicle.md": 1500}  # words of a page

PRONOUN = r"(?:it|they|that|this|these|those|there|one|none|no|nothing|both|some|each|every|an?|the|its|their)"
VERB = r"(?:is|are|was|were|has|have|does|do|may|must|can|cannot|goes?|comes?|takes?|gets?|stays?|leaves?|begins?|lies)"
STRONG = {
    "a clause is the subject; begin with a noun": rf"(?:^|[.;:] |, (?:and|but|so|or) )(?:[Ww]hat|[Hh]ow|[Ww]hether) [^.;:?]{{2,90}}? {VERB}\b",
    "a comment begins with a clause or a pronoun": r"^(?:What|How|Whether|Those|That of|The same|Likewise|Ditto)\b",
    "a clause is the object; name the object": rf"\b(?:by|of|with|to|than|from|for|in|into|beyond|as|holds?|gives?|has|had) what {PRONOUN}\b",
    "where is for places and symbols; use if or when": rf"(?:^|[.;:] )Where\b|(?:[,;:(]|\b(?:and|or|only|but|so|that|is|are|it|once|known|kept|taken|left|tried)) where (?:{PRONOUN}\b|[a-z]+ (?:is|are|has|have|do|does|may|can|needs?|takes?)\b)",
    "things do not tell": r"\b(?:tells?|told|telling)\b(?! (?:them )?(?:apart\b|you\b))",
    "things do not ask; use requires or evaluates": r"\b(?:asks?|asked|asking)\b(?! for\b)",
    "things do not know or see": r"\bknows?\b (?:no|nothing|only|neither|both|one|it|of|rows|places)\b|\bneed(?: not)? know\b|\b(?:sees|noticed|forgets?|forgotten|learns?|remembers?|minds|lives on|foretells?|foretold)\b",
    "use is, are listed or are stored": r"\b(?:stands?|stood)\b(?! (?:still|alone|side by side|for\b))",
    "use is used for": r"\b(?:serves?|served|serving)\b",
    "use costs": r"\b(?:dear|owes?|pays?|paid)\b",
    "use except": r"\bbut (?:for|at|in|with|by)\b (?!example)",
    "use again": r"\b(?:anew|afresh|once more)\b",
    "use fixed": r"\b[Mm]end(?:s|ed)?\b",
    "history belongs to the commit message": r"\b(?:no longer|any longer|any more|is gone|are gone|as before|since then|first plan|had been)\b|\bbefore[):]|\b(?:took|lacked|flew|blew) ",
    "end a sentence with its own word": r", too[,.;:)]|, too$|\b[Ll]ikewise\b",
    "as what": r", as (?:no|nothing|such|most|few|those|what|noise|one|both)\b",
    "use is not a": r"(?<!here )\b(?:is|are) no (?!longer|more|need|such)\w+",
    "repeat the verb": r"(?<=[a-z`]) (?:does|do)(?:[.;,)]|$)|\b(?:it|they) do(?:es)? not\b[.;,)]",
    "name the allowed range": r"\bcannot be meant\b|\bnobody means\b|\bin the user's hand\b",
    "name the error": r"\bin a sentence\b|\brefused? (?:by (?:its|their|the|a)|with both|them|it,)\b",
    "name the method": r"\bby (?:single stores|registers|walks?|products alone|turns|what|hand of)\b",
    "name the error of": r"\bhow far off\b|\bfar off\b|\boff (?:that|its|it|beside)\b",
    "give the ratio with its two sides": r"\btakes? (?:0\.\d+|an? (?:third|quarter|half|tenth)|two thirds|half|six tenths) (?:of (?:its|their|the) (?:time|factorisations)|as long|the time)",
}
WEAK = {
    "what as an object": r"\bwhat (?:it|they|is|are|was|has|have|does|do|an?|the|no|each|every|[a-z]+s) ",
    "beside": r"\bbesides?\b",
    "in turn": r"\bin turn\b",
    "light verb take": r"\btakes? (?:it|them|that|an?|the|its|no|up|away|off|out|for|of|by|as|part)\b|\btaken (?:off|up|for|in|by|with|once|to|again)\b",
    "light verb go": r"\b(?:goes?|gone|lies?|lay|comes?|came|hangs?) (?:on|back|through|with|up|down|out|by|from|of|along|beyond|over|into|in|at|there|without)\b",
    "fronted phrase": r"^(?:Of|By|Beside|Beyond|Not|Still) [^,.]{3,60}?,? (?:is|are|was|come|comes|go|goes|it|they|an?|one|no|nothing)\b",
    "of which": r"\bof (?:which|whom|these|those)\b",
    "in place of": r"\bin (?:the )?place of\b",
    "leave": r"\b(?:leaves? (?:out|it|them|what)|left out|worked out|laid out|taken up|passed over|sets? out|given out)\b",
    "pronoun": r"\b(?:that one|the ones? that|of (?:its|their|your) own|the others?|the rest|the former|the latter)\b",
    "hold": r"\b(?:held|holds?) (?:by|it|then|what|no|nothing|that)\b",
    "bits": r"\bsame bits\b|\blast bits?\b",
    "metaphor": r"\b(?:doors?|tower|floors?|waists?|rooms?|diet|twins?|crumb|levers?|a hair|narrow|whole state)\b",
    "give way": r"\b(?:wants|yields?|gives? way|does with)\b",
}
DIARY = {
    "a date": r"\b20\d\d-\d\d-\d\d\b|\b\d{1,2} (?:January|February|March|April|May|June|July|August|September|October|November|December) 20\d\d\b",
    "a machine's mood": r"\bnot idle\b|\bon another (?:day|machine)\b|\bvirtual cores?\b|\bshared machine\b",
    "a commit": r"\b(?=[0-9a-f]*\d)(?=[0-9a-f]*[a-f])[0-9a-f]{7}\b",
    "an experiment": r"\bwas tried\b|\bwithout success\b|\bgain(?:ed)? nothing\b|\bwas weighed\b",
}
COMPILED = {
    kind: [(name, re.compile(pattern)) for name, pattern in rules.items()]
    for kind, rules in (("strong", STRONG), ("weak", WEAK), ("diary", DIARY))
}
DOT = "\u2024"  # a full stop that does not end a sentence
ABBREVIATION = re.compile(r"`[^`]*`|\b(?:e\.g|i\.e|Eqs?|Figs?|Secs?|cf|vol|et al|No|approx|resp)\.")
END = re.compile(r"[.!?](?=\s+(?:[A-Z`*\[(“\"‖ΔθΦ∂\\]|$))")


def split(lines):
    """[(line, sentence)] of the numbered lines of a paragraph."""
    text, starts = "", []
    for number, line in lines:
        starts.append((len(text), number))
        text += line.strip() + " "
    safe = ABBREVIATION.sub(lambda m: m[0].replace(".", DOT), text)
    found, begin = [], 0
    for end in [m.end() for m in END.finditer(safe)] + [len(text)]:
        sentence = text[begin:end].strip()
        if len(sentence.split()) >= 3:
            found.append((max(n for at, n in starts if at <= begin + 1), sentence))
        begin = end
    return found


def paragraphs_of_page(text):
    text = re.sub(r"<!--.*?-->|^```.*?^```", lambda m: re.sub(r"[^\n]", "", m[0]), text, flags=re.S | re.M)
    paragraph = []
    for number, line in enumerate(text.split("\n"), 1):
        if re.match(r"\s*\|", line):
            yield paragraph
            paragraph = []
            yield from ([(number, cell)] for cell in line.strip().strip("|").split("|") if len(cell.split()) >= 8)
            continue
        item = re.match(r"\s*(?:[-*]|\d+\.) ", line)
        if not line.strip() or line.startswith(("#", "    ")) or item:
            yield paragraph
            paragraph = []
        if line.strip() and not line.startswith(("#", "    ")):
            paragraph.append((number, line[item.end() :] if item else line))
    yield paragraph


def paragraphs_of_comments(text, mark):
    paragraph = []
    for number, line in enumerate(text.split("\n"), 1):
        whole = re.match(rf"\s*{mark}(?!<) ?(.*)$", line)
        words = whole[1] if whole else ""
        is_formula = re.match(r"\s{2,}\S", words) and not re.search(r"[a-z]{4,} [a-z]{2,}", words)
        if whole and words.strip() and not is_formula and not re.match(r"\\file|-{4,}|NOLINT", words.strip()):
            paragraph.append((number, words))
            continue
        yield paragraph
        paragraph = []
        if not whole and (tail := re.search(rf"(?<!:){mark}<? ?(.*)$", line)) and not tail[1].startswith("NOLINT"):
            yield [(number, tail[1])]
    yield paragraph


def paragraphs_of_messages(text):
    """The string literals of each statement that throws, joined; a gap represents a value."""
    for m in re.finditer(r"\bthrow\b[^;]*?;", text, re.S):
        literals = re.findall(r'"((?:\\.|[^"\\])*)"', m[0])
        if sentence := re.sub(r"\s+", " ", " `v` ".join(literals)).strip():
            yield [(text.count("\n", 0, m.start()) + 1, sentence)]


def sentences(path, text):
    if path.suffix == ".md":
        groups = [paragraphs_of_page(text)]
    elif path.suffix in (".hpp", ".cpp"):
        groups = [paragraphs_of_comments(text, "///?"), paragraphs_of_messages(text)]
    else:
        groups = [paragraphs_of_comments(text, "#")]
    return [s for group in groups for paragraph in group if paragraph for s in split(paragraph)]


def faults(sentence, page=False):
    """The names of the rules that a sentence violates."""
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", re.sub(r"`[^`]*`", "`c`", sentence))
    hit = {kind: [name for name, rule in rules if rule.search(plain)] for kind, rules in COMPILED.items()}
    weak = hit["weak"] if hit["strong"] or len(hit["weak"]) > 1 else []
    return hit["strong"] + weak + (hit["diary"] if page else [])


def findings(root, name):
    path = root / name
    page = path.suffix == ".md" and not DIARY_ALLOWED.search(name)
    found = []
    for line, sentence in sentences(path, path.read_text(encoding="utf-8")):
        if names := faults(sentence, page):
            found.append(f"{name}:{line}: [{'; '.join(names)}] {sentence[:200]}")
    return found


def words(text):
    """Number of words that a reader of a page sees: text separated by spaces, with a letter or a digit.

    Headings and cells of tables count. Blocks of code, comments and addresses of links do not count."""
    text = re.sub(r"<!--.*?-->|^```.*?^```|(?<=\])\([^)]*\)", "", text, flags=re.S | re.M)
    return sum(bool(re.search(r"\w", word)) for word in text.replace("|", " ").split())


def too_long(root):
    for name, most in LONGEST.items():
        if not (root / name).is_file():
            yield f"{name}: listed in LONGEST, but not a file of the project"
        elif (count := words((root / name).read_text(encoding="utf-8"))) > most:
            yield f"{name}: {count} words, at most {most} are allowed; move details to docs/notes"


def files(root):
    listed = subprocess.run(
        ["git", "-C", str(root), "ls-files", "*.md", "*.hpp", "*.cpp", "*.cmake"], capture_output=True, text=True
    ).stdout.split("\n")
    return [f for f in listed if f and not SKIPPED.search(f) and (root / f).is_file()]


def allowed():
    entries = (line.rsplit(" ", 1) for line in LIST.read_text(encoding="utf-8").splitlines() if line[:1] not in ("", "#"))
    return {name: int(count) for name, count in entries}


def check(root):
    old, total = allowed(), 0
    for name in files(root):
        found, most = findings(root, name), old.pop(name, 0)
        total += len(found)
        if most and NEVER.fullmatch(name):
            yield f"{name}: this page may have no entry in {LIST.name}"
        if len(found) > most:
            yield from found
            yield f"{name}: {len(found)} sentences to rewrite, {most} allowed"
        elif len(found) < most:
            yield f"{name}: only {len(found)} findings left of {most}: lower the number in {LIST.name} (--shrink)"
    yield from (f"{name}: listed in {LIST.name}, but not a file of the project" for name in old)
    yield from too_long(root)
    print(f"{total} sentences to rewrite")


def shrink(root):
    head = [line for line in LIST.read_text(encoding="utf-8").splitlines() if line.startswith("#")]
    old = allowed()
    counts = {name: min(old[name], len(findings(root, name))) for name in files(root) if name in old}
    LIST.write_text("\n".join(head + [f"{n} {c}" for n, c in sorted(counts.items()) if c]) + "\n", encoding="utf-8")


def main(arguments):
    if not arguments or not Path(arguments[0]).is_dir():
        sys.exit(__doc__)
    root = Path(arguments[0])
    if "--list" in arguments:
        found = [f for name in arguments[arguments.index("--list") + 1 :] for f in findings(root, name)]
    else:
        if "--shrink" in arguments:
            shrink(root)
        found = list(check(root))
    print(*found, sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
