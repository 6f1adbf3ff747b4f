"""What Doxygen reads in place of the files of the project:  prepare.py TO FILE...

Each FILE, relative to the project, is written to TO under the same name.

Headers
  - belong to the group of their floor (`reference.dox`);
  - have equations, which are indented in comments, on lines of their own;
  - are read without explicit instantiations, which declare nothing, and without Eigen's traits;
  - have the comment of `double a, b;  ///< ...`, or of one line above it, at each of the names;
  - have at members that a concept asks for what docs/extending.md says of them there, where they say nothing themselves.
Pages
  - and their headings have labels, and links to pages and headings are references, which Doxygen checks;
  - links in the pages of docs/site make their order: \\subpage.
Lines keep their numbers, so that a warning names the right one.
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SITE = ROOT / "docs" / "site"
MEMBER_ROW = re.compile(r"^\| (`[^|]*`[^|]*) \| ([^|]*) \|$", re.M)


# --- headers ----------------------------------------------------------------------------------
def depth_split(text, separator=","):
    """Parts of `text` between separators that stand in no bracket."""
    parts, depth, begin = [], 0, 0
    for i, c in enumerate(text):
        if c in "([{<":
            depth += 1
        elif c in ")]}" or (c == ">" and text[i - 1] not in "-="):
            depth -= 1
        elif c == separator and depth == 0:
            parts.append(text[begin:i])
            begin = i + 1
    return [*parts, text[begin:]]


SEVERAL = re.compile(r"^(\s*)((?:static constexpr |static |inline |constexpr |mutable )*[A-Za-z_](?:(?:[^()=;]|size_t\(\w+\))*?[\w>&*])?)\s+([&*]?\w+\b[^;]*);(?:\s*///<\s?(.*))?$")


def each_with_its_comment(line, comment=None):
    """`double a, b = 1.0;  ///< text` as a declaration for each name, each with the text."""
    parts = depth_split(line.split("///<")[0].rstrip().removesuffix(";"))
    found = SEVERAL.match(line)
    if not found or len(parts) < 2 or found[2].split()[0] in ("return", "using", "friend", "typedef", "throw", "case"):
        return None
    first = re.match(r"^(\s*)(.*?[\w>&*])\s+([&*]?\w+\s*(?:=.*|\{.*|\[.*)?)$", parts[0])
    if not first or not all(re.match(r"^\s*[&*]?\w+\s*($|=|\{|\[)", p) for p in parts[1:]):
        return None
    text = comment or found[4]
    said = f" /**< {text.replace('*/', '* /')} */" if text else ""
    return first[1] + " ".join(f"{first[2].rstrip()} {name.strip()};{said}" for name in (first[3], *parts[1:]))


SECTIONS = {"A body": "bodies", "A joint geometry": "joints", "A policy": "joints", "A force element": "forces", "An integrator": "integrators", "A linear solver": "solvers", "Their laws": "testing"}


def asked_by_concepts():
    """What docs/extending.md says of each member in its tables: {folder: {(name, whether it is a function): text}}."""
    said = {folder: {} for folder in (*SECTIONS.values(), "math", "vehicle")}  # where types of these kinds are, too
    for section in re.split(r"^## ", (ROOT / "docs/extending.md").read_text(encoding="utf-8"), flags=re.M):
        folder = SECTIONS.get(re.match(r"[\w ]*", section)[0].strip())
        for cell, text in MEMBER_ROW.findall(section) if folder else ():
            names = [re.sub(r"[<(].*", "", part) for part in re.findall(r"`([^`]+)`", cell)]
            for name in names:
                if re.fullmatch(r"\w+", name) and text.strip():
                    said[folder].setdefault((name, "(" in cell), text.strip())
    return said


def asked_of(folder, member, is_function):
    """The words of the folder's own table, or of another one; those of solvers are of no other folder."""
    tables = [ASKED[folder], *(table for other, table in ASKED.items() if "solvers" not in (folder, other))]
    return next((table[member, is_function] for table in tables if (member, is_function) in table), None)


def floor_of(name):
    parts = name.split("/")  # include/polybody/FLOOR/...
    return f"floor_{parts[2]}" if len(parts) > 3 else "floor_all"


EQUATION = re.compile(r"^(\s*///) {2,3}(?![ -]|\d\.)(.*)$")


def on_lines_of_their_own(lines):
    """Indented lines of a comment are equations: they keep their lines."""
    after = False
    for line in lines:
        if "///" in line:  # no end of a sentence
            line = re.sub(r"\b(Eqs?|Figs?|et al|vol|cf)\. ", r"\1.&nbsp;", line)
        if found := EQUATION.match(line):
            yield f"{found[1]} <br/>&emsp;{found[2]}"
            after = True
        else:
            plain = re.match(r"^(\s*///) ([^ \\].*)$", line) if after else None
            yield f"{plain[1]} <br/>{plain[2]}" if plain else line
            after = False


def header(name, text):
    text = re.sub(r"^(?:extern )?template (?!<)[^;]*;", lambda m: "\n" * m[0].count("\n"), text, flags=re.M)
    text = re.sub(r"^template <[^\n]*>\nstruct Eigen::.*?^\};$", lambda m: "\n" * m[0].count("\n"), text, flags=re.M | re.S)
    lines = text.split("\n")
    waiting = WAITING.get(name, {})
    folder = name.split("/")[2]
    for i, line in enumerate(lines):
        if "///<" in line and "," in line:
            lines[i] = each_with_its_comment(line) or line
        elif "," in line and i > 0 and (above := re.match(r"\s*/// (\w.*)$", lines[i - 1])) and "///" not in lines[i - 2]:
            if each := each_with_its_comment(line, above[1]):
                lines[i - 1 : i + 1] = "", each
        for member in waiting.get(i + 1, ()):
            is_function = bool(re.search(rf"\b{re.escape(member)}\(", lines[i]))
            text_of_it = asked_of(folder, member, is_function) if folder in ASKED else None
            if text_of_it and (is_function or re.search(r"static constexpr|^\s*using \w+ =", lines[i])):
                place = i
                while place > 0 and re.match(r"\s*(template|requires)\b", lines[place - 1]) and not lines[place - 1].rstrip().endswith(";"):
                    place -= 1
                lines[place] = re.sub(r"^(\s*)", lambda m: f"{m[1]}/** {text_of_it} */ ", lines[place], count=1)
    text = "\n".join(on_lines_of_their_own(lines))
    floor = floor_of(name)
    text = re.sub(r"^(namespace polybody[\w:]* \{)\n", rf"\1 /** @addtogroup {floor}\n@{{ */", text, flags=re.M)
    return re.sub(r"^(\}  // namespace polybody)", r"/** @} */ \1", text, flags=re.M)


def undocumented():
    """What a first run found without a comment: {file: {line: names}}."""
    found = {}
    file = ROOT / "build/site/parts/undocumented.txt"
    if file.exists():
        for row in file.read_text(encoding="utf-8").splitlines():
            path, line, name, _ = row.split("\t")
            found.setdefault(path, {}).setdefault(int(line), []).append(name)
    return found


ASKED = asked_by_concepts()
WAITING = undocumented()


# --- pages ------------------------------------------------------------------------------------
def label(path):
    """docs/guide/contact.md -> guide_contact, docs/joints.md -> page_joints"""
    return f"{path.parent.name if path.parent.name in ('guide', 'site') else 'page'}_{path.stem}"


def anchor(heading):
    """As GitHub makes it of a heading, in letters that Doxygen takes."""
    words = re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
    return "".join(c if c.isascii() else f"_{ord(c):x}" for c in words)


def page(path, text):
    own, in_code = label(path), False
    out = []
    for line in text.split("\n"):
        if line.startswith("```"):
            in_code = not in_code
        elif not in_code:
            if heading := re.match(r"^(#+) (.*)$", line):
                name = own if heading[1] == "#" else f"{own}_{anchor(heading[2])}"
                line = f"{line} {{#{name}}}" if own != "site_index" or heading[1] != "#" else line
            line = "".join(part if i % 2 else LINK.sub(lambda m: link(path, m), part) for i, part in enumerate(re.split(r"(`[^`]*`)", line)))
        out.append(line)
    return "\n".join(out)


LINK = re.compile(r"\[([^\]]*)\]\(([^)\s#:]*)(?:#([^)\s]*))?\)")


def title(path):
    return path.read_text(encoding="utf-8").split("\n", 1)[0].removeprefix("# ") if path.exists() else path.stem


def link(path, found):
    target = (path.parent / found[2]).resolve() if found[2] else path
    if target.suffix != ".md" or not target.is_relative_to(ROOT / "docs"):
        return found[1]  # a file that is no page of the site
    text = title(target) if found[1] == target.name else found[1]
    name = label(target) + (f"_{anchor(found[3])}" if found[3] else "")
    kind = "\\subpage" if path.parent == SITE and not found[3] and label(target) != "site_index" else "\\ref"
    return f'{kind} {name} "{text}"'


if __name__ == "__main__":
    to = Path(sys.argv[1])
    for name in sys.argv[2:]:
        content = (ROOT / name).read_text(encoding="utf-8")
        (to / name).parent.mkdir(parents=True, exist_ok=True)
        text = header(name, content) if name.endswith(".hpp") else page(ROOT / name, content) if name.endswith(".md") else content
        (to / name).write_text(text, encoding="utf-8")
