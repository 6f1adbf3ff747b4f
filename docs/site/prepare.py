"""Input files for Doxygen, derived from the files of the project:  prepare.py TO FILE...

Each FILE, relative to the project, is written to TO under the same name.

Headers
  - belong to the group of their layer (`reference.dox`);
  - have equations, which are indented in comments, on separate lines;
  - have no line of a comment that begins with + or *, which would be an item of a list: the sign ends the line before it;
  - are read without explicit instantiations, which declare nothing, and without Eigen's traits;
  - have the comment of `double a, b;  ///< ...`, or of one line above it, at each of the names;
  - take the description of a member that a concept requires from docs/extending.md if the member has no comment;
  - have the first equation of a class's item page (docs/items) in the comment of the class.
Pages
  - and their headings have labels, and links to pages and headings are references, which Doxygen checks;
  - are ordered by the links in the pages of docs/site: \\subpage;
  - have names of headers, such as `forces/contact.hpp`, as links to the reference;
  - of docs/theory and docs/items have formulas $…$ and $$…$$, which KaTeX draws.
Lines keep their numbers, so that a warning names the right one.

"""
import html
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SITE = ROOT / "docs" / "site"


# --- headers: one comment behind several names ------------------------------------------------
DECLARED = re.compile(r"^(\s*)([A-Za-z_](?:(?:[^()=;]|size_t\(\w+\))*?[\w>&*])?)\s+([&*]?\w+\s*(?:[={\[].*)?)$")  # indent, type, first name
NAME = re.compile(r"^\s*[&*]?\w+\s*(?:$|[={\[])")
NO_TYPES = ("return", "using", "friend", "typedef", "throw", "case")


def split_at_commas(text):
    """Parts of `text` between commas outside brackets."""
    parts, depth = [""], 0
    for i, c in enumerate(text):
        depth += (c in "([{<") - (c in ")]}" or (c == ">" and text[i - 1] not in "-="))
        if c == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    return parts


def each_with_its_comment(line, comment=None):
    """`double a, b = 1.0;  ///< text` as one declaration per name, each with the text; None for other lines."""
    code, _, own = line.partition("///<")
    first, *others = split_at_commas(code.rstrip().removesuffix(";"))
    found = DECLARED.match(first)
    if not (code.rstrip().endswith(";") and others and found and all(map(NAME.match, others))) or found[2].split()[0] in NO_TYPES:
        return None
    text = (comment or own).strip()
    said = f" /**< {text.replace('*/', '* /')} */" if text else ""
    return found[1] + " ".join(f"{found[2]} {name.strip()};{said}" for name in (found[3], *others))


# --- headers: what a concept asks for ---------------------------------------------------------
SECTIONS = {"A body": "bodies", "A joint geometry": "joints", "A joint geometry with its own functions": "joints", "A policy": "joints", "A force element": "forces", "An integrator": "integrators", "A linear solver": "solvers", "Law tests": "testing"}
MEMBER_ROW = re.compile(r"^\| (`[^|]*`[^|]*) \| ([^|]*) \|$", re.M)


def asked_by_concepts():
    """Descriptions of members in the tables of docs/extending.md: {folder: {(name, True for a function): text}}."""
    said = {folder: {} for folder in (*SECTIONS.values(), "math", "vehicle")}  # these folders also contain types of these kinds
    for section in re.split(r"^## ", (ROOT / "docs/extending.md").read_text(encoding="utf-8"), flags=re.M):
        if folder := SECTIONS.get(re.match(r"[\w ]*", section)[0].strip()):
            for cell, text in MEMBER_ROW.findall(section):
                for name in (re.sub(r"[<(].*", "", part) for part in re.findall(r"`([^`]+)`", cell)):
                    if re.fullmatch(r"\w+", name) and text.strip():
                        said[folder].setdefault((name, "(" in cell), text.strip())
    return said


def undocumented():
    """Names without a comment in a first run of Doxygen: {file: {line: names}}."""
    found = {}
    file = ROOT / "build/site/parts/undocumented.txt"
    for row in file.read_text(encoding="utf-8").splitlines() if file.exists() else ():
        path, line, name, _ = row.split("\t")
        found.setdefault(path, {}).setdefault(int(line), []).append(name)
    return found


ASKED = asked_by_concepts()
WAITING = undocumented()


def asked_of(folder, member, is_function):
    """Description from the folder's own table, or from another one; those of solvers are not used in other folders."""
    tables = [ASKED[folder], *(table for other, table in ASKED.items() if "solvers" not in (folder, other))] if folder in ASKED else []
    return next((table[member, is_function] for table in tables if (member, is_function) in table), None)


def say_what_is_asked(lines, i, folder, member):
    """Puts the description of a member that line i declares before it, and before its `template` and `requires`."""
    is_function = bool(re.search(rf"\b{re.escape(member)}\(", lines[i]))
    text = asked_of(folder, member, is_function)
    if not text or not (is_function or re.search(r"static constexpr|^\s*using \w+ =", lines[i])):
        return
    while i > 0 and re.match(r"\s*(template|requires)\b", lines[i - 1]) and not lines[i - 1].rstrip().endswith(";"):
        i -= 1
    lines[i] = re.sub(r"^(\s*)", lambda m: f"{m[1]}/** {text} */ ", lines[i], count=1)


# --- headers: the rest ------------------------------------------------------------------------
SIGN = re.compile(r"^(\s*///<?) ([+*]) (?=\S)")
EQUATION = re.compile(r"^(\s*///) {2,3}(?![ -]|\d\.)(.*)$")
LEFT_OUT = (re.compile(r"^(?:extern )?template (?!<)[^;]*;", re.M), re.compile(r"^template <[^\n]*>\nstruct Eigen::.*?^\};$", re.M | re.S))


def without_leading_signs(lines):
    """A + or * that begins a line of a comment ends the line before: otherwise Doxygen begins a list. Lists have -."""
    for i, line in enumerate(lines):
        sign = SIGN.match(line)
        if sign and i > 0 and re.search(r"///.*\S", lines[i - 1]):
            lines[i - 1 : i + 1] = f"{lines[i - 1].rstrip()} {sign[2]}", f"{sign[1]} {line[sign.end() :]}"
    return lines


def on_lines_of_their_own(lines):
    """Indented lines of a comment are equations: they remain separate lines."""
    after = False
    for line in lines:
        if "///" in line:  # not the end of a sentence
            line = re.sub(r"\b(Eqs?|Figs?|et al|vol|cf)\. ", r"\1.&nbsp;", line)
        equation = EQUATION.match(line)
        plain = re.match(r"^(\s*///) ([^ \\].*)$", line) if after and not equation else None
        yield f"{equation[1]} <br/>&emsp;{equation[2]}" if equation else f"{plain[1]} <br/>{plain[2]}" if plain else line
        after = bool(equation)


def with_equations(lines):
    """The comment of each class with an item page ends with the first equation of this page."""
    namespaces = []
    for i, line in enumerate(lines):
        if inside := re.match(r"namespace (?:polybody)?(?:::)?([\w:]*) ?\{", line):
            namespaces.append(inside[1])
        elif line.startswith("}  // namespace"):
            namespaces.pop()
        found = re.match(r"(?:class|struct) (\w+)\b(?!.*;)", line)
        page = found and namespaces and ITEMS.get((namespaces[-1], found[1]))
        if not page:
            continue
        while i > 0 and lines[i - 1].strip() and not lines[i - 1].startswith(("///", "}")):  # template, requires
            i -= 1
        if lines[i - 1].startswith("///"):
            lines[i - 1] += f" <br/>{page[1]} More: \\ref {page[0]}."
    return lines


def header(name, text):
    for pattern in LEFT_OUT:
        text = pattern.sub(lambda m: "\n" * m[0].count("\n"), text)
    lines = without_leading_signs(text.split("\n"))
    _, _, folder, *within = name.split("/")  # include/polybody/LAYER/...
    for i, line in enumerate(lines):
        if "///<" in line and "," in line:
            lines[i] = each_with_its_comment(line) or line
        elif "," in line and i > 0 and (above := re.match(r"\s*/// (\w.*)$", lines[i - 1])) and "///" not in lines[i - 2]:
            if each := each_with_its_comment(line, above[1]):
                lines[i - 1 : i + 1] = "", each
        for member in WAITING.get(name, {}).get(i + 1, ()):
            say_what_is_asked(lines, i, folder, member)
    group = f"floor_{folder}" if within else "floor_all"
    if folder == "bodies" and within[0] in ("shared", "fe"):
        group += "_shared"
    text = "\n".join(with_equations(list(on_lines_of_their_own(lines))))
    text = re.sub(r"^(namespace polybody[\w:]* \{)\n", rf"\1 /** @addtogroup {group}\n@{{ */", text, flags=re.M)
    return re.sub(r"^(\}  // namespace polybody)", r"/** @} */ \1", text, flags=re.M)


# --- pages ------------------------------------------------------------------------------------
def label(path):
    """docs/guide/contact.md -> guide_contact, docs/joints.md -> page_joints"""
    return f"{path.parent.name if path.parent.name in ('guide', 'howto', 'items', 'lessons', 'theory', 'site', 'validated') else 'page'}_{path.stem}"


def anchor(heading):
    """The anchor that GitHub derives from a heading, with characters that Doxygen accepts."""
    words = re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
    return "".join(c if c.isascii() else f"_{ord(c):x}" for c in words)


def formula(tag, tex):
    """A formula for KaTeX, which draws it in the browser."""
    return f'\\htmlonly<{tag} class="tex">{html.escape(tex).replace("|", "&#124;")}</{tag}>\\endhtmlonly'


def header_link(code):
    """`forces/contact.hpp` as a link to the page of the header; None for other code."""
    name = code.strip("`").removeprefix("polybody/")
    if not name.endswith(".hpp") or Path(name).name.startswith("compiled") or not (ROOT / "include/polybody" / name).is_file():
        return None
    return f'<tt>\\ref polybody/{name} "{code.strip("`")}"</tt>'


def with_links(path, line):
    """The line with its links as references, also those of the names of headers outside headings and links."""
    parts = re.split(r"(`[^`]*`)", line)
    for i, part in enumerate(parts):
        if i % 2 == 0:
            parts[i] = LINK.sub(lambda m: link(path, m), part)
        elif not line.startswith("#") and not parts[i - 1].endswith("["):
            parts[i] = header_link(part) or part
    return "".join(parts)


def page(path, text):
    own, in_code, in_formula = label(path), False, False
    has_formulas = path.parent.name in ("theory", "items")
    if has_formulas:
        text = DISPLAY.sub(lambda m: formula("div", m[1]), text)
    out = []
    for line in text.split("\n"):
        if line.startswith("```"):
            in_code = not in_code
        elif in_formula or '<div class="tex">' in line:
            in_formula = "\\endhtmlonly" not in line
        elif not in_code:
            if heading := re.match(r"^(#+) (.*)$", line):
                name = own if heading[1] == "#" else f"{own}_{anchor(heading[2])}"
                line = f"{line} {{#{name}}}" if own != "site_index" or heading[1] != "#" else line
            line = with_links(path, line)
            line = COMMENT.sub("", line)  # Doxygen would also remove the space behind it
            line = IMAGE.sub(r"![\1](\2)", line)  # Doxygen looks for the file in IMAGE_PATH
            if has_formulas:
                line = FORMULA.sub(lambda m: formula("span", m[1]), line)
        out.append(line)
    return "\n".join(out) + (DRAW if has_formulas else "")


COMMENT = re.compile(r"<!--.*?-->")
IMAGE = re.compile(r"!\[([^\]]*)\]\((?:[^)\s]*/)?([^)\s/]+)\)")
LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)\s#:]*)(?:#([^)\s]*))?\)")


FORMULA, DISPLAY = re.compile(r"\$([^$]+)\$"), re.compile(r"\$\$(.+?)\$\$", re.S)
DRAW = """
\\htmlonly<link rel="stylesheet" href="katex/katex.min.css"><script src="katex/katex.min.js"></script><script>
for (const e of document.querySelectorAll(".tex")) katex.render(e.textContent, e, {displayMode: e.tagName === "DIV", throwOnError: false});
</script>\\endhtmlonly
"""


def items():
    """Label and first equation of the item page of each class: {(namespace inside polybody, class): …}."""
    found = {}
    for path in sorted((ROOT / "docs/items").glob("*.md")):
        text = path.read_text(encoding="utf-8")
        inner, _, name = text.split("\n", 1)[0].removeprefix("# ").rpartition("::")
        if equation := DISPLAY.search(text):
            tex = " ".join(equation[1].split())
            found[inner, name] = label(path), formula("div", tex) + DRAW.replace("\n", " ").strip()
    return found


def title(path):
    return path.read_text(encoding="utf-8").split("\n", 1)[0].removeprefix("# ") if path.exists() else path.stem


def link(path, found):
    target = (path.parent / found[2]).resolve() if found[2] else path
    if target.suffix != ".md" or not target.is_relative_to(ROOT / "docs"):
        return found[1]  # a file that is not a page of the site
    text = title(target) if found[1] == target.name else found[1]
    name = label(target) + (f"_{anchor(found[3])}" if found[3] else "")
    kind = "\\subpage" if path.parent == SITE and not found[3] and label(target) != "site_index" else "\\ref"
    return f'{kind} {name} "{text}"'


ITEMS = items()

if __name__ == "__main__":
    to = Path(sys.argv[1])
    for name in sys.argv[2:]:
        content = (ROOT / name).read_text(encoding="utf-8")
        (to / name).parent.mkdir(parents=True, exist_ok=True)
        text = header(name, content) if name.endswith(".hpp") else page(ROOT / name, content) if name.endswith(".md") else content
        (to / name).write_text(text, encoding="utf-8")
