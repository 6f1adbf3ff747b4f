"""What the site says of public names, read off what docs/site/build made:  documented.py SITE [--shrink]

types, names   each type, function, alias, constant and concept of a public namespace has a comment
members        so has each public member; those that a concept asks for have it in docs/extending.md
units          a public member that is a number (double, Vec2, Vec3, Vec6, Mat3, a list of them; not scratch of run-time size) has its unit in brackets, [m/s], in its own comment or its
               type's, or a word that says why there is none: relative, unit vector, factor, ratio, share, part, count, ν, ξ, …

documented_allowed.txt beside this file holds what is older: `members HEADER COUNT`, `units HEADER COUNT`. It only shrinks, as the lists of
check.py do; --shrink takes off what is mended.
"""
import re
import sys
import xml.etree.ElementTree as xml
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
ALLOWED = Path(__file__).with_name("documented_allowed.txt")
sys.path.insert(0, str(ROOT / "docs/site"))
import undocumented  # noqa: E402

NUMBER = re.compile(r"(?:Required<|std::optional<|std::vector<)?(?:double|Vec[236]|Mat3)>?")
UNIT = re.compile(r"\[[^\]]+\]")
NONE = re.compile(r"relative|unit|axes? |factor|ratio|share|part of|count|how many|cosine|[νξρθ]|∈|\bin \(|weight")


def said_of(element):
    return " ".join("".join(element.find(part).itertext()) for part in ("briefdescription", "detaileddescription"))


def numbers_without_unit(folder):
    """Header of each."""
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
