"""House rules for the headers:  check.py RULE INCLUDE_DIR [--shrink]

floors     a header includes only its own layer or a lower one
compiler   a header that includes no other one of polybody includes math/compiler.hpp, the check of compiler and options
words      no #define in the code, and `virtual` only in the headers of ABSTRACT: a loop over bodies, joints or elements
           calls no virtual function (comments may use the words)
length     no header above 400 lines; reports the median and the 90 % line
umbrella   polybody.hpp or the header of a subject (polybody/<subject>.hpp) reaches every header
functions  no function above 60 lines, none with more than 6 parameters
waist      integrators, solvers, analyses and io use the mechanics through its interface: they name no pool of a model, no
           `detail::` of another folder, and no model as template parameter. Exceptions are entry points: functions of at
           most five lines, and records without functions
comments   no line of a comment begins with "Of" or "…"
repeats    no 12 successive lines of code occur twice (without comments, blank lines and includes)
system     BasicSystem has at most 25 public member functions, its constructors not counted

functions, waist and comments have a list of allowed violations, <rule>_allowed.txt in this folder: a `key` or `key count`
on each line. The lists only shrink: an entry without a violation is also an error. --shrink removes such entries.

"""

import re
import sys
from pathlib import Path

import cpp_reader

FLOORS = {
    "math": 0,
    "kinematics": 1,
    "bodies": 2,
    "joints": 3,
    "forces": 3,
    "system": 4,
    "solvers": 5,
    "elimination": 6,
    "integrators": 7,
    "signals": 8,
    "run": 8,
    "statics": 9,
    "vibration": 9,
    "stress": 10,
    "compare": 10,
    "io": 11,
    "gradients": 11,
    "vehicle": 12,
    "study": 12,
    "testing": 13,
    "": 14,  # polybody.hpp itself
}
# Headers with abstract classes, whose functions a program calls a few times in each evaluation of a system.
ABSTRACT = tuple(f"polybody/{name}.hpp" for name in ("system/coordinates", "system/model_operations", "system/step_secants", "solvers/tangent_solver"))
OPTIONAL_PACKAGES = {  # KLU, Spectra, MPI, liburdfdom
    "polybody/io/urdf_file.hpp",
    "polybody/urdf.hpp",
    "polybody/solvers/klu.hpp",
    "polybody/vibration/spectra_modes.hpp",
    "polybody/study/mpi.hpp",
}
MAX_LINES = 400  # of a header
MAX_FUNCTION_LINES = 60
REPEATED_LINES = 12
MAX_PARAMETERS = 6
MAX_SYSTEM_FUNCTIONS = 25
MAX_DOOR_LINES = 5

BEHIND_WAIST = ("integrators", "solvers", "run", "statics", "vibration", "stress", "compare", "signals", "io")
POOLS = re.compile(r"\b(?:(?:body|joint|force)_pools|for_each_(?:body|joint|force|gap)|BodyPool)\b")
VAGUE = re.compile(r"(?://+<?|^[ \t]*\*|/\*+)[ \t]*(Of|…)(?=[ \t]|$)", re.MULTILINE)

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
    """polybody/bodies/rigid/planar_rigid.hpp -> bodies"""
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


def compiler(texts):
    check = "polybody/math/compiler.hpp"
    if check not in texts:
        yield f"{check} does not exist"
    for name in texts:
        if name not in (check, "polybody/version.hpp") and not any(other in texts for other in includes(name, texts)):
            yield f"{name} includes no header of polybody: include {check}, so that old compilers get its sentence"


def words(texts):
    for name, text in texts.items():
        # Blank out comments and strings, keeping the lines.
        code = NOT_CODE.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)
        for number, line in enumerate(code.splitlines(), 1):
            if re.match(r"\s*#\s*define\b", line):
                yield f"{name}:{number}: #define (use a constexpr or a template)"
            if re.search(r"\bvirtual\b", line) and name not in ABSTRACT:
                yield f"{name}:{number}: virtual (use a concept, or declare an interface in a header of ABSTRACT)"
    for name in ABSTRACT:
        if name in texts and not re.search(r"\bvirtual\b", texts[name]):
            yield f"{name} declares no virtual function: take it off ABSTRACT"


def length(texts):
    counts = {name: len(text.splitlines()) for name, text in texts.items()}
    ordered = sorted(counts.values())
    if len(ordered) >= 10:
        last = len(ordered) - 1
        median, most = ordered[last // 2], ordered[round(0.9 * last)]
        print(f"{len(ordered)} headers, {sum(ordered)} lines; median {median}, 90 % {most}, longest {ordered[last]}")
    for name, count in counts.items():
        if count > MAX_LINES:
            yield f"{name}: {count} lines, more than {MAX_LINES}"


def umbrella(texts):
    """The headers of optional packages and the headers that only they include are exempt."""
    reached = {n for n in texts if n.count("/") == 1} | (OPTIONAL_PACKAGES & texts.keys())
    todo = sorted(reached)
    while todo:
        for other in includes(todo.pop(), texts):
            if other in texts and other not in reached:
                reached.add(other)
                todo.append(other)
    for name in texts:
        if name not in reached:
            yield f"{name} is reached from no header polybody/<subject>.hpp"


def repeats(texts):
    """Overlapping repeated runs give one sentence."""
    places, reported = {}, None
    for name, text in texts.items():
        lines = [(i, re.sub(r"//.*", "", line).strip()) for i, line in enumerate(text.split("\n"), 1)]
        lines = [(i, line) for i, line in lines if line and not line.startswith("#include")]
        for k in range(len(lines) - REPEATED_LINES + 1):
            run = tuple(line for _, line in lines[k : k + REPEATED_LINES])
            first = places.setdefault(run, (name, lines[k][0]))
            if first != (name, lines[k][0]) and reported != (name, k - 1):
                yield f"{name}:{lines[k][0]} repeats {REPEATED_LINES} lines of {first[0]}:{first[1]}"
            if first != (name, lines[k][0]):
                reported = (name, k)


def declarations(name, text):
    try:
        return list(cpp_reader.declarations(text))
    except ValueError as e:
        sys.exit(f"{name}: {e}")


def short(name):
    """polybody/bodies/rigid/rigid.hpp -> bodies/rigid/rigid.hpp"""
    return name.removeprefix("polybody/")


def offending_functions(texts):
    """{header:function: [sentences]}, one for each overload that violates the rule, most violations first."""
    rows = []
    for name, text in texts.items():
        for d in declarations(name, text):
            lines = d.last - d.first + 1
            if d.kind == "function" and d.body and (lines > MAX_FUNCTION_LINES or d.parameters > MAX_PARAMETERS):
                rows.append((-lines, -d.parameters, f"{short(name)}:{d.name}", f"{name}:{d.first}: {d.name}"))
    found = {}
    for lines, parameters, key, where in sorted(rows):
        told = f"{where}: {-lines} lines, {-parameters} parameters (at most {MAX_FUNCTION_LINES}, {MAX_PARAMETERS})"
        found.setdefault(key, []).append(told)
    return found


def takes_model(head):
    """True if a declaration is a template with a type parameter M."""
    for m in re.finditer(r"\btemplate\s*(?=<)", head):
        parameters = head[m.end() : cpp_reader.after_angles(head, m.end())]
        if re.search(r"(?:\b(?!int\b|bool\b|Index\b)\w+|>)\s+M\b", parameters):
            return True
    return False


def is_door(d, all_of_header):
    """True if a template with a model parameter is an entry point: a short or deleted function, or a record without functions."""
    if d.kind == "class":
        return not any(o.kind == "function" and o.name.startswith(f"{d.name}::") for o in all_of_header)
    if re.search(r"=\s*delete\s*$", d.head):
        return True
    return d.kind == "function" and d.body and d.lines <= MAX_DOOR_LINES


def offending_waist(texts):
    details = {}  # {name in a namespace detail: folders that define it}
    for name, text in texts.items():
        for d in declarations(name, text):
            if "detail" in d.scopes and "::" not in d.name:
                details.setdefault(d.name, set()).add(folder(name))
    found = {}
    for name, text in texts.items():
        if folder(name) not in BEHIND_WAIST:
            continue
        code = cpp_reader.code_of(text)
        named = {m: f"names {m}, which is the model's own affair" for m in POOLS.findall(code)}
        for other in re.findall(r"\bdetail::(\w+)", code):
            if folder(name) not in details.get(other, {folder(name)}):
                named[f"detail::{other}"] = f"uses detail::{other} of {', '.join(sorted(details[other]))}"
        if re.search(r"\bSystem\s*<", code):
            named["System<"] = "names System<…>: a model as template parameter"
        declared = declarations(name, text)
        if behind := [d for d in declared if takes_model(d.head) and not is_door(d, declared)]:
            named["template <class M>"] = (
                f"{behind[0].name} has a template parameter M, a model, and is no door of at most {MAX_DOOR_LINES} lines"
            )
        for what, told in sorted(named.items()):
            found[f"{short(name)}:{what}"] = [f"{name}: {told}"]
    return found


def offending_comments(texts):
    found = {}
    for name, text in texts.items():
        strings = re.compile(r'(//[^\n]*|/\*.*?\*/)|"(?:\\.|[^"\\\n])*"', re.DOTALL)
        text = strings.sub(lambda m: m[1] or '""', text)
        for m in VAGUE.finditer(text):
            told = f'{name}:{text.count(chr(10), 0, m.start(1)) + 1}: a comment begins with "{m[1]}": say of what'
            found.setdefault(short(name), []).append(told)
    return found


def list_of(rule):
    return Path(__file__).with_name(f"{rule}_allowed.txt")


def allowed(rule):
    """{key: count} of the list of a rule."""
    found = {}
    for line in list_of(rule).read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            key, count = re.fullmatch(r"(.*?)(?: (\d+))?", line).groups()
            found[key] = int(count or 1)
    return found


def beyond_list(rule, offenders, tell=False):
    """Messages about violations that the list of the rule does not allow, and about entries without a violation."""
    old = allowed(rule)
    listed = [told for key, all_told in offenders.items() if key in old for told in all_told]
    print(f"allowed by {rule}_allowed.txt: {len(listed)}")
    for told in listed if tell else ():
        print(f"  {told}")
    for key, all_told in offenders.items():
        if len(all_told) > old.get(key, 0):
            yield from all_told
            if key in old:
                yield f"{key}: {len(all_told)} of these, {old[key]} allowed"
    for key, count in old.items():
        left = len(offenders.get(key, []))
        if left < count:
            yield f"{key}: " + (f"only {left} left of {count}" if left else "no longer an offender") + (
                f": {'lower it on' if left else 'take it off'} the list {rule}_allowed.txt (--shrink does)")


def shrink(rule, offenders):
    path = list_of(rule)
    comments = [line for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("#")]
    kept = {key: min(count, len(offenders.get(key, []))) for key, count in allowed(rule).items()}
    path.write_text("\n".join(comments + entries(kept)) + "\n", encoding="utf-8")


def entries(counts):
    return [key if count == 1 else f"{key} {count}" for key, count in sorted(counts.items()) if count]


OFFENDERS = {"functions": offending_functions, "waist": offending_waist, "comments": offending_comments}


def functions(texts):
    yield from beyond_list("functions", offending_functions(texts), tell=True)


def waist(texts):
    yield from beyond_list("waist", offending_waist(texts))


def comments(texts):
    yield from beyond_list("comments", offending_comments(texts))


def system(texts):
    name = "polybody/system/basic_system.hpp"
    count = sum(
        d.kind == "function" and d.public and not d.friend
        and bool(re.fullmatch(r"BasicSystem::(?!BasicSystem$|~)[^:]+", d.name))
        for d in declarations(name, texts.get(name, ""))
    )
    if count > MAX_SYSTEM_FUNCTIONS:
        yield f"{name}: BasicSystem has {count} public member functions, more than {MAX_SYSTEM_FUNCTIONS}"


RULES = {
    f.__name__: f
    for f in (floors, compiler, words, length, umbrella, functions, waist, comments, repeats, system)
}


def main(rule, root, shrinks=False):
    texts = headers(Path(root))
    if not texts:
        sys.exit(f"no header under {root}/polybody")
    if shrinks:
        shrink(rule, OFFENDERS[rule](texts))
    found = list(RULES[rule](texts))
    print(*found, sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    asked = [a for a in sys.argv[1:] if a != "--shrink"]
    shrinks = len(asked) < len(sys.argv) - 1
    if len(asked) != 2 or asked[0] not in (OFFENDERS if shrinks else RULES):
        sys.exit(__doc__)
    sys.exit(main(*asked, shrinks))
