"""Checks the comments of public names in the output of docs/site/build:  documented.py SITE [--shrink]

types, names   each type, function, alias, constant and concept of a public namespace has a comment
members        each public member has a comment; docs/extending.md describes those that a concept requires
parameters     the comment of a public function names each parameter: as a word, in `backticks`, by \\param or as the Greek letter that it spells, q₀ for q0.
               Exceptions are parameters whose type describes them, a class, enumeration or concept of the library, and the letters in the table of docs/extending.md with their types
units          a public member that is a number (double, Vec2, Vec3, Vec6, Mat3, a list of them; not a workspace of run-time size) has its unit in brackets, [m/s], in its own comment or that of its
               type, or a word that explains its absence: relative, unit vector, factor, ratio, share, part, count, ν, ξ, …
lists          the text before a list of a comment ends with : or a full stop; otherwise a sign that begins a line of a formula became an item

documented_allowed.txt in this folder lists existing violations: `members HEADER COUNT`, `units HEADER COUNT`. It only shrinks, like the lists of
check.py; --shrink removes fixed entries.

"""
import re
import sys
import xml.etree.ElementTree as xml
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
ALLOWED = Path(__file__).with_name("documented_allowed.txt")
LETTERS = ROOT / "docs/extending.md"
sys.path.insert(0, str(ROOT / "docs/site"))
import undocumented  # noqa: E402

# Types that do not describe a parameter; the other types of the library do.
PLAIN = set("Index Vec Vec2 Vec3 Vec4 Vec6 VecX VecXOf Vector V3 V6 Row Mat Mat3 Mat6 MatX MatXOf M6 Scalar StateScalar Number Numbers".split())
GREEK = dict(zip("alpha beta gamma delta epsilon zeta eta theta lambda mu nu xi rho sigma tau phi psi omega".split(), "α β γ δΔ ε ζ η θ λ μ ν ξ ρ σ τ φΦ ψ ωΩ".split()))
WORDS_OF_TEXT = set("a as at by from in of on to".split())  # as names they appear in code or in a formula
INDICES = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
RAISED = re.compile("[⁰¹²³⁴⁵⁶⁷⁸⁹ᵀ⁺⁻ᵢⱼₖ]")  # powers, transposes, entries
LETTER_ROW = re.compile(r"^\| ((?:`\w+`(?:, )?)+) \| [^|]* \| ([^|]*) \|", re.M)

NUMBER = re.compile(r"(?:Required<|std::optional<|std::vector<)?(?:double|Vec[236]|Mat3)>?")
UNIT = re.compile(r"\[[^\]]+\]")
NONE = re.compile(r"relative|unit|axes? |factor|ratio|share|part of|count|how many|cosine|[νξρθ]|∈|\bin \(|weight")


def said_of(element):
    return " ".join("".join(element.find(part).itertext()) for part in ("briefdescription", "detaileddescription"))


def numbers_without_unit(folder):
    """The header of each number without a unit."""
    for file in sorted(folder.glob("*.xml")):
        if not re.match(r"(?:class|struct)", file.name):
            continue
        whole = xml.parse(file).getroot().find("compounddef")
        about = said_of(whole)
        if UNIT.search(about):  # Energies of a state [J].
            continue
        for member in whole.iter("memberdef"):
            if member.get("kind") != "variable" or member.get("prot") != "public":
                continue
            kind = re.sub(r"\s|^static|constexpr|const", "", "".join(member.find("type").itertext()))
            text = said_of(member)
            name = member.find("name").text
            if NUMBER.fullmatch(kind) and not name.endswith("_") and not UNIT.search(text) and not NONE.search(text):
                yield member.find("location").get("file").split("include/")[-1], name


def letters():
    """The names in docs/extending.md with the same meaning everywhere: {name: words of its types}."""
    section = re.search(r"^## Letters\n(.*?)^## ", LETTERS.read_text(encoding="utf-8"), re.M | re.S)[1]
    found = {}
    for cell, types in LETTER_ROW.findall(section):
        for name in re.findall(r"\w+", cell):
            found.setdefault(name, set()).update(re.findall(r"\w+", " ".join(re.findall(r"`([^`]+)`", types))))
    return found


def is_named(name, function):
    """True if the comment of a function names the parameter."""
    after = r"(?![\w\u0300-\u036f˙¨])"  # q̇ is not q
    word = rf"(?<![\w.]){re.escape(name)}{after}"
    code = " ".join("".join(e.itertext()) for e in function.iter() if e.tag in ("computeroutput", "parametername"))
    if re.search(word, code):
        return True
    text = RAISED.sub(" ", said_of(function)).translate(INDICES)
    if name in WORDS_OF_TEXT:
        word += r"(?=\s*(?:[^\w\s`\"'(]|\(\d|$))"
    return bool(re.search(word, text)) or any(re.search(rf"(?<!\w){letter}{after}", text) for letter in GREEK.get(name, ""))


def words_of(element):
    return re.findall(r"\w+", " ".join("".join(part.itertext()) for part in (element.find("type"), element.find("declname")) if part is not None))


def unnamed_parameters(folder):
    """(header, line, function, parameter) of each unnamed parameter, and the letters that no function has."""
    wholes = [xml.parse(file).getroot().find("compounddef") for file in sorted(folder.glob("*.xml")) if file.name != "index.xml"]
    wholes = [whole for whole in wholes if whole is not None]
    members = {m.get("id"): m for whole in wholes for m in whole.iter("memberdef")}.values()
    types = {re.sub(r"<.*", "", whole.findtext("compoundname")).strip().split("::")[-1] for whole in wholes if whole.get("kind") in ("class", "struct", "concept")}
    types |= {m.findtext("name") for m in members if m.get("kind") in ("enum", "typedef")}
    types -= PLAIN
    same_everywhere, unused, found = letters(), set(letters()), []
    for function in members:
        if function.get("kind") != "function" or function.get("prot") != "public" or "detail::" in (function.findtext("qualifiedname") or ""):
            continue
        says_what = dict.fromkeys(types, True)
        for parameter in function.findall("templateparamlist/param"):
            *kind, name = words_of(parameter)
            says_what[name] = bool(types & set(kind))
        for parameter in function.findall("param"):
            name, words = parameter.findtext("declname"), set(re.findall(r"\w+", "".join(parameter.find("type").itertext())))
            if not name or any(says_what.get(word) for word in words):
                continue
            if words & same_everywhere.get(name, set()):
                unused.discard(name)
            elif said_of(function).strip() and not is_named(name, function):  # a function without a comment is reported among the members
                place = function.find("location")
                found.append((place.get("file").split("include/")[-1], place.get("line"), function.findtext("name"), name))
    return found, unused


def lists_within_sentences(folder):
    """(page, end of the text before a list) of each list that interrupts a sentence in the comments of headers."""
    for file in sorted(folder.glob("*.xml")):
        if not re.match(r"class|struct|union|concept|namespace|group", file.name):
            continue
        for paragraph in xml.parse(file).getroot().iter("para"):
            before = paragraph.text or ""
            for part in paragraph:
                if part.tag in ("itemizedlist", "orderedlist") and before.strip() and before.strip()[-1] not in ":.":
                    yield file.stem, before.strip()[-40:]
                before += "".join(part.itertext()) + (part.tail or "")


def check(site, shrink):
    faults, found, named = [], Counter(), {}
    for path, line, name, kind in undocumented.rows(site / "warnings"):
        if kind == "member":
            key = f"members {path.removeprefix('include/')}"
            found[key] += 1
            named.setdefault(key, []).append(f"{name} (line {line})")
        else:
            faults.append(f"{path}:{line}: {name} has no comment.")
    for path, name in numbers_without_unit(site / "xml"):
        found[f"units {path}"] += 1
        named.setdefault(f"units {path}", []).append(name)
    faults += [f"{page}: a list begins within a sentence, after '{before}'." for page, before in lists_within_sentences(site / "xml")]
    unnamed, unused = unnamed_parameters(site / "xml")
    faults += [f"{path}:{line}: {function} does not name its parameter {name}." for path, line, function, name in unnamed]
    faults += [f"{LETTERS.name}: no function has the letter {name} with these types." for name in sorted(unused)]
    allowed = {}
    for row in ALLOWED.read_text(encoding="utf-8").splitlines() if ALLOWED.exists() else ():
        key, count = row.rsplit(" ", 1)
        allowed[key] = int(count)
    for key in sorted({*found, *allowed}):
        have, may = found[key], allowed.get(key, 0)
        if have > may:
            faults.append(f"{key}: {have} without, {may} allowed: {', '.join(named[key])}.")
        elif have < may and not shrink:
            faults.append(f"{key}: {have} without, {may} allowed: take it off by documented.py SITE --shrink.")
    if shrink:
        left = {key: min(count, found[key]) for key, count in allowed.items() if found[key]}
        ALLOWED.write_text("".join(f"{key} {count}\n" for key, count in sorted(left.items())), encoding="utf-8")
    totals = Counter()
    for key, count in found.items():
        totals[key.split()[0]] += count
    return faults, totals


if __name__ == "__main__":
    wrong, without = check(Path(sys.argv[1]), "--shrink" in sys.argv[2:])
    print(f"without a comment: {without['members']} members; without a unit: {without['units']} numbers")
    for fault in wrong:
        print(fault)
    sys.exit(bool(wrong))
