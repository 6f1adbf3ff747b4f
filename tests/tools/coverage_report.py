"""Prints the line coverage of headers:  coverage_report.py INCLUDE_DIR LIBCLANG_DIR FOUND.info…

FOUND are the SF: and DA: lines of lcov records. A line counts as reached if one of the records reaches it. Functions
without a line in any record were not instantiated. They are found in the compiler's AST, and their lines count as not
reached.

"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.append("/usr/lib/python3/dist-packages")  # folder of clang's bindings in Debian, also for other Python versions
from clang import cindex  # noqa: E402

KIND = cindex.CursorKind
FUNCTIONS = {
    KIND.FUNCTION_DECL,
    KIND.FUNCTION_TEMPLATE,
    KIND.CXX_METHOD,
    KIND.CONSTRUCTOR,
    KIND.DESTRUCTOR,
    KIND.CONVERSION_FUNCTION,
}
CLASSES = {KIND.CLASS_DECL, KIND.STRUCT_DECL, KIND.CLASS_TEMPLATE, KIND.CLASS_TEMPLATE_PARTIAL_SPECIALIZATION}
ROOMS = CLASSES | {KIND.NAMESPACE, KIND.FRIEND_DECL}


def kind_of(cursor):
    """None for kinds that the bindings do not support, such as concepts."""
    try:
        return cursor.kind
    except ValueError:
        return None


def counts_of(records, root):
    """{header: {line: execution count}} of lcov records."""
    counts = {}
    for record in records:
        lines = None
        for row in Path(record).read_text().splitlines():
            tag, _, rest = row.partition(":")
            if tag == "SF":
                path = Path(rest)
                lines = counts.setdefault(str(path.relative_to(root)), {}) if path.is_relative_to(root) else None
            elif lines is not None:
                line, count = map(int, rest.split(",")[:2])
                lines[line] = max(lines.get(line, 0), count)
    return counts


def system_includes():
    """Folders of the system's and of Eigen's headers."""

    def told(*command):
        return subprocess.run(command, capture_output=True, text=True, check=True)

    clang = next(filter(None, (shutil.which(f"clang++-{version}") for version in range(16, 22))))
    found = told(clang, "-E", "-x", "c++", "-v", "/dev/null").stderr
    found = found.split("#include <...> search starts here:")[1].split("End of search list")[0]
    eigen = told("pkg-config", "--cflags-only-I", "eigen3").stdout
    return found.split() + [word[2:] for word in eigen.split()] + ["/usr/include/suitesparse"]


def functions_of(root):
    """(header, name, first line, last line) of the body of each function, by the compiler's AST."""
    names = sorted(str(path.relative_to(root)) for path in root.rglob("*.hpp"))
    text = "".join(f"#include <{name}>\n" for name in names)
    options = ["-std=c++20", f"-I{root}"] + [word for folder in system_includes() for word in ("-isystem", folder)]
    unit = cindex.Index.create().parse("all.cpp", options, unsaved_files=[("all.cpp", text)])
    for message in unit.diagnostics:
        if message.severity >= cindex.Diagnostic.Error:
            sys.exit(f"coverage_report.py: {message}")

    found = []

    def walk(cursor, scope):
        for child in cursor.get_children():
            if child.location.file is None or not child.location.file.name.startswith(f"{root}/"):
                continue
            kind = kind_of(child)
            if kind in FUNCTIONS:
                header = str(Path(child.location.file.name).relative_to(root))
                of = child.semantic_parent
                within = f"{of.spelling}::" if not scope and kind_of(of) in CLASSES else scope
                for body in child.get_children():
                    if kind_of(body) in (KIND.COMPOUND_STMT, KIND.CXX_TRY_STMT):
                        lines = body.extent.start.line, body.extent.end.line
                        found.append((header, within + child.spelling, *lines))
            elif kind in ROOMS:
                walk(child, scope if kind in (KIND.NAMESPACE, KIND.FRIEND_DECL) else f"{scope}{child.spelling}::")

    walk(unit.cursor, "")
    return sorted(set(found), key=lambda f: (f[0], f[2]))


def code_lines(text):
    """Numbers of the lines that contain more than blanks and comments."""
    text = re.sub(r"/\*.*?\*/", lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.DOTALL)
    return {i for i, line in enumerate(text.splitlines(), 1) if line.split("//")[0].strip()}


def spans(lines):
    """[3, 4, 5, 9] → 3–5, 9"""
    runs = []
    for line in sorted(lines):
        if runs and runs[-1][1] == line - 1:
            runs[-1][1] = line
        else:
            runs.append([line, line])
    return ", ".join(str(a) if a == b else f"{a}–{b}" for a, b in runs)


def main():
    root = Path(sys.argv[1]).resolve()
    counts = counts_of(sys.argv[3:], root)
    cindex.Config.set_library_path(sys.argv[2])
    functions = functions_of(root)
    unknown = {}
    for header, name, first, last in functions:
        lines = counts.setdefault(header, {})
        if any(first <= line <= last for line in lines):
            continue
        code = code_lines((root / header).read_text())
        unknown.setdefault(header, []).append((name, {line for line in range(first, last + 1) if line in code}))

    total = reached = without = 0
    rows = []
    for header, lines in counts.items():
        missed = {line for line, count in lines.items() if count == 0}
        extra = set().union(*(body for _, body in unknown.get(header, [])))
        count = len(lines) + len(extra)
        total += count
        reached += len(lines) - len(missed)
        without += len(extra)
        if missed or extra:
            rows.append((len(missed) + len(extra), count, header, missed))
    print(f"{'lines':>6} {'of':>6}    not reached")
    for lost, count, header, missed in sorted(rows, key=lambda row: (-row[0], row[2])):
        print(f"{lost:6} {count:6}    {header}: {spans(missed)}")
        for name, body in unknown.get(header, []):
            print(f"{'':17}{spans(body)}: {name} is not instantiated")
    of = ", ".join(sorted((Path(name).stem for name in sys.argv[3:]), key=lambda name: (len(name), name)))
    names = sum(len(found) for found in unknown.values())
    print(f"line coverage of include/ by {of}: {100.0 * reached / max(total, 1):.2f} %, {reached} of {total} lines; "
          f"{without} lines stand in {names} of {len(functions)} functions, which no test instantiates")


if __name__ == "__main__":
    main()
