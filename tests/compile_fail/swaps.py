"""Programs that swap body, policy or integrator in the program of README.md, one edited line for each swap, and that must
not compile.

  swaps.py SOURCE COMPILER INCLUDE...

The tables of combinations in docs/joints.md name the pairs that cannot be combined: body and policy, body and integrator,
policy and integrator. A program for each of these pairs is compiled (syntax only). The first error of each program must be
a sentence of the library within its first ten lines. Every combination that is refused contains such a pair. The numbers
of combinations by body are compared with those of tests/swaps, which runs the other combinations."""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

LINES = 10
AXIS = "Revolute{.axis = {0, 1, 0}}"
LAW = "LinearLaw{.stiffness = 1e6, .damping = 1e2}"
MATRIX = "Bushing::diagonal({1e6, 1e6, 1e6}, {1e6, 1e6, 1e6})"
NUMBERS = {
    "Penalty": "{.stiffness = 1e7, .damping = 1e3}",
    "PenaltyPerEquation": "<5>{.stiffness = Vec<double, 5>::Constant(1e7), .damping = Vec<double, 5>::Constant(1e3)}",
    "Bushing": "{.stiffness = " + MATRIX + ", .damping = " + MATRIX + "}",
    "NonlinearBushing": "{" + ", ".join(6 * [LAW]) + "}",
    "RungeKutta4<Baumgarte>": "{.stabilisation = {.alpha = 50.0, .beta = 50.0}}",
}
SCOPED = {"ArticulatedBody": "joint_coordinates::ArticulatedBody"}
BODIES = {"AncfCable": "AncfCable<>", "Lrvf<RelativeRotation>": "Lrvf<>", "AncfBeam<Continuum>": "AncfBeam<Continuum<>>", "planar::AncfCable": "planar::AncfCable<>"}


def tables(page):
    """The tables between the two marks: for each the name of its corner, and its cells by row and column."""
    block = page.split("<!-- composition begins")[1].split("<!-- composition ends")[0]
    found = {}
    for text in re.findall(r"(?:^\|.*\n)+", block, re.M):
        head, _, *rows = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in text.splitlines()]
        cells = {}
        for row in rows:
            for column, cell in zip(head[1:], row[1:]):
                for r in re.findall(r"`([^`]+)`", row[0]):
                    for c in re.findall(r"`([^`]+)`( with nonholonomic equations)?", column):
                        cells[r, "".join(c)] = cell.strip(" |")
        found[head[0].strip("| "), "Constraint" in head[1]] = cells
    return found


class Axes:
    """The three axes and the pairs of them that can be combined with a `Revolute` between the ground and a body."""

    def __init__(self, page):
        table = tables(page)
        of_geometry = table["geometry", True]
        self.by_constraint = table["geometry, with `Constraint`", False]
        self.policy_body = table["policy, with at least one geometry", False]
        self.stepper_body = table["integrator", False]
        self.stepper_policy = table["integrator", True]
        self.policies = [c for r, c in of_geometry if r == "Revolute"]
        self.bodies = [c for r, c in self.by_constraint if r == "Revolute"]
        self.steppers = list(dict.fromkeys(r for r, _ in self.stepper_body))
        assert all(of_geometry["Revolute", p] == "✓" for p in self.policies)

    def joins(self, body, policy):
        return {self.by_constraint["Revolute", body], self.policy_body[policy, body]} <= {"✓", "2nd"}

    def steps(self, stepper, body):
        return self.stepper_body[stepper, body] == "✓"

    def holds(self, stepper, policy):
        return self.stepper_policy[stepper, policy] == "✓"

    def exists(self, body, policy, stepper):
        return self.joins(body, policy) and self.steps(stepper, body) and self.holds(stepper, policy)


def refused(axes):
    """For each pair that cannot be combined, a program whose other pairs can, if there is one."""
    for b in axes.bodies:
        for p in axes.policies:
            if not axes.joins(b, p):
                yield b, p, "GeneralisedAlpha"
    for b in axes.bodies:
        for s in axes.steppers:
            fits = [p for p in axes.policies if axes.joins(b, p) and axes.holds(s, p)]
            if fits and not axes.steps(s, b):
                yield b, fits[0], s
    for s in axes.steppers:
        for p in axes.policies:
            fits = [b for b in axes.bodies if axes.joins(b, p) and axes.steps(s, b)]
            if fits and not axes.holds(s, p):
                yield fits[0], p, s


def value(name):
    for short, full in SCOPED.items():
        name = name.replace(short, full)
    return name + NUMBERS.get(name, "{}")


def edited(program, body, policy, stepper):
    """The program with its three lines replaced."""
    for pattern, line in ((r"using Rod = .*?;", f"using Rod = {BODIES.get(body, body)};"),
                          (r"auto hinge = .*?;", f"auto hinge = Joint{{{AXIS}, {value(policy)}}};"),
                          (r"auto stepper = .*?;", f"auto stepper = {value(stepper)};")):
        program, count = re.subn(pattern, line, program)
        if count != 1:
            sys.exit(f"README.md: {count} lines of its program are {pattern}")
    return program


def refusals(message, name, first_lines):
    """For each program the lines of its first error. The lines before an error of g++ (In instantiation of ...) belong to
    it, and so do the notes after it."""
    place = re.compile(re.escape(name) + r":(\d+):")
    found, blocks, complete = {}, [[]], False
    for line in message.splitlines():
        error = ": error: " in line
        if (error and complete) or (": In " in line and complete):
            blocks.append([])
            complete = False
        complete = complete or error or ": note: " in line
        blocks[-1].append(line)
    for block in blocks:
        if not any(": error: " in line for line in block):
            continue  # a note of g++ with its own instantiation
        places = {max((k for k in first_lines if k <= int(n)), default=None) for line in block for n in place.findall(line)}
        for k in places - {None}:
            found.setdefault(k, block)
    return found


def main(source, compiler, *includes):
    source = Path(source)
    page = (source / "README.md").read_text(encoding="utf-8")
    axes = Axes((source / "docs/joints.md").read_text(encoding="utf-8"))
    program = re.search(r"```cpp\n.*?(int main\(\) \{\n.*?)```", page, re.S).group(1)
    text, programs = "#include <polybody/ffr.hpp>\n#include <polybody/se3_beam.hpp>\n", {}
    text += "#include <polybody/polybody.hpp>\n#include <iostream>\nusing namespace polybody;\n"
    for i, choice in enumerate(refused(axes)):
        programs[text.count("\n") + 1] = choice
        text += edited(program, *choice).replace("int main()", f"void program_{i}()")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "swaps.cpp"
        file.write_text(text, encoding="utf-8")
        flags = [flag for folder in includes for flag in ("-isystem", folder)]
        all_errors = "-ferror-limit=0" if "clang" in Path(compiler).name else "-fmax-errors=0"
        run = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", all_errors, *flags, str(file)], capture_output=True,
                             text=True, env={"LC_ALL": "C", "PATH": "/usr/bin:/bin"})
    first = refusals(run.stderr, "swaps.cpp", list(programs))
    faults = []
    for line, choice in programs.items():
        block = first.get(line)
        if block is None:
            faults.append(f"{choice} compiles, but the tables refuse it")
        elif not any("static assertion failed" in x or "static_assert failed" in x for x in block[:LINES]):
            faults.append(f"{choice} is refused without a sentence:\n" + "\n".join(block[:LINES]))
    every = [(b, p, s) for b in axes.bodies for p in axes.policies for s in axes.steppers]
    exist = sum(axes.exists(*c) for c in every)
    by_body = {b: sum(axes.exists(b, p, s) for p in axes.policies for s in axes.steppers) for b in axes.bodies}
    print(f"{len(every)} combinations: {exist} exist, {len(every) - exist} contain one of {len(programs)} refused pairs")
    counted = {}
    for test in (source / "tests/swaps").glob("*_test.cpp"):
        counted.update((b, (int(n), int(m))) for b, n, m in re.findall(r"run_all<(.+)>\(.*?Count\{(\d+), (\d+)\}", test.read_text(encoding="utf-8")))
    for body, count in by_body.items():
        by_test = counted.get(BODIES.get(body, body), (0, 0))
        if count and by_test != (count, len(axes.policies) * len(axes.steppers) - count):
            faults.append(f"{body}: {count} combinations exist by the tables, and tests/swaps runs and refuses {by_test}")
    sys.exit("\n".join(faults) if faults else 0)


if __name__ == "__main__":
    main(*sys.argv[1:])
