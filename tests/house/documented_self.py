"""Tests of documented.py and docs/site/prepare.py: reported and accepted comments."""
import html
import sys
import tempfile
from pathlib import Path

import documented

import prepare  # documented.py put docs/site on the path

XML = """<doxygen><compounddef kind="struct"><compoundname>polybody::A</compoundname><briefdescription>{about}</briefdescription><detaileddescription/>
<memberdef kind="variable" prot="public"><type>{kind}</type><name>x</name><briefdescription>{text}</briefdescription><detaileddescription/>
<location file="include/polybody/a.hpp"/></memberdef></compounddef></doxygen>"""
FUNCTION = """<memberdef kind="function" id="f" prot="{prot}"><templateparamlist>{template}</templateparamlist><qualifiedname>{scope}f</qualifiedname><name>f</name>
<param><type>{kind}</type><declname>{name}</declname></param><briefdescription>{text}</briefdescription><detaileddescription/><location file="a.hpp" line="3"/></memberdef>"""
TABLE = "## Letters\n\n| `t` | time | a number, `double` | [s] |\n\n## A body\n"


def require(holds, what):
    if not holds:
        sys.exit(f"documented_self: {what}")


def faults(folder, warnings="", allowed="", function="", table="## Letters\n\n## A body\n", **member):
    (folder / "xml").mkdir(exist_ok=True)
    (folder / "warnings").write_text(warnings)
    (folder / "xml/structA.xml").write_text(XML.format(**{"about": "A thing.", "kind": "double", "text": "length [m]", **{k: html.escape(v) for k, v in member.items()}}).replace("</compounddef>", f"{function}</compounddef>"))
    documented.LETTERS = folder / "letters.md"
    documented.LETTERS.write_text(table)
    documented.ALLOWED = folder / "allowed"
    documented.ALLOWED.write_text(allowed)
    return documented.check(folder, False)[0]


def unnamed(folder, name, text, kind="double", template="", table="## Letters\n\n## A body\n", scope="polybody::", prot="public"):
    """Findings for a function with one parameter and this comment."""
    return faults(folder, function=FUNCTION.format(name=name, text=text, kind=html.escape(kind), template=template, scope=scope, prot=prot), table=table)


with tempfile.TemporaryDirectory() as name:
    place = Path(name)
    require(not faults(place), "a number with its unit is found")
    require(not faults(place, kind="int", text=""), "a count is found")
    require(not faults(place, text="relative to the length"), "a number that says why it has no unit is found")
    require(not faults(place, text="", about="Lengths [m]."), "the unit of a type's comment does not count")
    for kind in ("double", "Required< double >", "static constexpr double", "std::optional< Vec3 >", "std::vector< Vec2 >"):
        require(faults(place, text="length", kind=kind), f"a {kind} without a unit passes")
    require(not faults(place, text="length", allowed="units polybody/a.hpp 1\n"), "what is allowed is found")
    require(faults(place, allowed="units polybody/a.hpp 1\n"), "an allowance that is not needed stays")
    member = "include/polybody/a.hpp:3: warning: Member x (variable) of struct polybody::A is not documented.\n"
    require(faults(place, member), "a member without a comment passes")
    require(not faults(place, member, "members polybody/a.hpp 1\n"), "a member that is allowed is found")
    for what in ("Compound polybody::A", "Member f(int x) (function) of namespace polybody"):
        require(faults(place, f"include/polybody/a.hpp:3: warning: {what} is not documented.\n", "members polybody/a.hpp 1\n"),
                f"{what} passes")

    for given, text in (("length", "A bar of this length [m]."), ("x", "From <computeroutput>x</computeroutput>."), ("x", "|x²| and xᵢ."), ("omega", "At ω [rad/s]."), ("q0", "From q₀ on."),
                        ("a", "a × b."), ("a", "Of a (3)."), ("at", "About <computeroutput>at</computeroutput>."), ("x", "")):
        require(not unnamed(place, given, text), f"{given} in '{text}' is not found")
    for given, text in (("length", "The lengths [m]."), ("q", "q̇ of it."), ("v", "v˙ of it."), ("a", "A bar of a model."), ("at", "At rest, at a point."), ("x", "max of e_x, f.x, ẍ."), ("omega", "Ω̇")):
        require(unnamed(place, given, text), f"{given} passes by '{text}'")
    for kind, template in (("A const &", ""), ("B", "<param><type>A B</type></param>"), ("std::vector< A >", "")):
        require(not unnamed(place, "x", "Does it.", kind, template), f"a {kind} must be named")
    for kind, template in (("std::vector< double >", ""), ("B", "<param><type>class B</type></param>"), ("T", "<param><type>StateScalar T</type></param>")):
        require(unnamed(place, "x", "Does it.", kind, template), f"a {kind} need not be named")
    require(not unnamed(place, "t", "Does it.", table=TABLE), "a letter must be named")
    require(unnamed(place, "t", "Does it.", "VecX", table=TABLE), "a letter of another type passes")
    require(faults(place, table=TABLE), "a letter that no function has stays")
    require(not unnamed(place, "x", "Does it.", scope="polybody::detail::"), "what is in detail is asked")
    require(not unnamed(place, "x", "Does it.", prot="private"), "what is private is asked")

    for before, wrong in (("The bound S = 2 p", True), ("The rules:", False), ("", False)):
        (place / "xml/structB.xml").write_text(f"<doxygen><para>{before} <itemizedlist><listitem><para>(1 - p) S</para></listitem></itemizedlist></para></doxygen>")
        require(bool(list(documented.lists_within_sentences(place / "xml"))) == wrong, f"a list after '{before}' {'passes' if wrong else 'is found'}")

split = prepare.each_with_its_comment
require(split("  Vec<T, 3> a{}, b = f(1, 2);  ///< (3) [m]") == "  Vec<T, 3> a{}; /**< (3) [m] */ Vec<T, 3> b = f(1, 2); /**< (3) [m] */", "a list is not taken apart")
require(split("  T a, b;  ///< [m]") == "  T a; /**< [m] */ T b; /**< [m] */", "a type of one letter is not taken apart")
require(split("  double a = f(1, 2);  ///< [m]") is None, "one name is taken apart")
require(split("  VecX const &q, &v;  ///< x, y [m]") == "  VecX const &q; /**< x, y [m] */ VecX const &v; /**< x, y [m] */", "references lose their comment or their type")
require(split("  T s[6], w;  ///< x, y [m]") == "  T s[6]; /**< x, y [m] */ T w; /**< x, y [m] */", "members of a type of one letter lose their comment")
page = prepare.page(prepare.ROOT / "docs/guide/speed.md", "# Speed\n\n[a](../joints.md#policies) `[b](c.md)` [d](../../README.md)\n\n```cpp\n# x\n```\n")
require(page.startswith("# Speed {#guide_speed}\n\n\\ref page_joints_policies \"a\" `[b](c.md)` d\n"), "links of a page stay as they are")
names = prepare.page(prepare.ROOT / "docs/guide/speed.md", "# `math/types.hpp`\n\n`math/types.hpp`, `polybody/math/types.hpp`, `math/none.hpp`, [`math/types.hpp`](x)\n")
linked = '<tt>\\ref polybody/math/types.hpp "{}"</tt>'.format
require(f"\n{linked('math/types.hpp')}, {linked('polybody/math/types.hpp')}, `math/none.hpp`, [`math/types.hpp`](x)\n" in names and names.startswith("# `math"), "the name of a header is no link")
require("\n# x\n" in page, "a line of code is taken for a heading")
text = prepare.header("include/polybody/math/a.hpp", "namespace polybody {\n\nextern template struct A<int>;\nint f();\n}  // namespace polybody\n")
require("@addtogroup floor_math" in text and "extern" not in text and text.count("\n") == 5, "a header is not prepared")
signs = prepare.header("include/polybody/math/a.hpp", "/// S = 2 p\n/// + (1 - p) S0\n/// * 3.\nstruct A {\n  double x;  ///< a\n             ///< + b\n};\n")
require(signs.startswith("/// S = 2 p +\n/// (1 - p) S0 *\n/// 3.\nstruct") and "///< a +\n             ///< b\n" in signs, "a sign that begins a line stays there")
listed = "/// Rules:\n/// - one\n/// - two\n"
require(prepare.header("include/polybody/math/a.hpp", listed) == listed, "a list is changed")
above = prepare.header("include/polybody/math/a.hpp", "struct A {\n  /// Sides [m].\n  double a, b;\n};\n").split("\n")
require(above[1] == "" and above[2].count("/**< Sides [m]. */") == 2, "a comment above a list is not given to each name")
print("documented_self: as it should be")
