"""Cases of docs/chapter2.md: {name: (page, command, read)}, read(text) -> ({row: {column: number}}, table or "")."""

import math
import re

from reading import markdown

PAGE = "docs/chapter2.md"
MESHES = ["gap", "strain", "interpolation", "rms", "rms left", "element", "bow", "turn"]
PARTS = {
    "rotary inertia": "LRVF - LRVF without rotary inertia",
    "shear": "LRVF without rotary inertia - LRVF without rotary inertia and shear",
    "none: the same equations": "LRVF without rotary inertia and shear - cable of engineering strain",
    "strain measure": "cable of engineering strain - cable of Green strain",
}
NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?"


def said(text):
    """Lines '  ROW, COLUMN: VALUE UNIT'."""
    numbers = {}
    for row, column, value in re.findall(rf"^  ([^,:\n]+), ([^,:\n]+): ({NUMBER})(?: \S+)?$", text, re.MULTILINE):
        numbers.setdefault(row, {})[column] = float(value)
    return numbers


def snapshots(text):
    """Lines '  meshes NAME t ...' as rows 'NAME t', and the row with the largest difference of each name as 'NAME widest'."""
    numbers = {}
    for name, rest in re.findall(r"^  meshes (\S+) +([-\d. ]+)$", text, re.MULTILINE):
        t, *values = rest.split()
        row = dict(zip(MESHES, map(float, values)), t=float(t))
        if row["rms"] > 0:
            row["percent left"] = 100 * row["rms left"] / row["rms"]
            row["percent interpolation"] = 100 * row["interpolation"] / row["gap"]
        numbers[f"{name} {t}"] = row
        if row["gap"] >= numbers.get(f"{name} widest", {"gap": 0})["gap"]:
            numbers[f"{name} widest"] = row
    return numbers


def comparison(text):
    """The table of compare(): a row for each formulation."""
    numbers, names = {}, []
    for line in text.splitlines():
        words = re.split(r" {2,}", line)
        if line.startswith(" " * 20) and len(words) > 2:
            names = words[1:]
        elif names and len(words) == len(names) + 1 and not words[0].startswith("CPU"):
            for name, value in zip(names, words[1:]):
                numbers.setdefault(name, {})[words[0]] = float(value)
    for row in numbers.values():
        if "end: lag of the tip [m]" in row:
            row["ahead at the end"] = -row["end: lag of the tip [m]"]
            row["lag in mm"] = 1e3 * row["largest difference from the first: lag of the tip [m]"]
    return numbers


def meshes(figures):
    """All numbers, and a table of the snapshots with the largest difference; the extremes of the other snapshots as 'all'."""

    def read(text):
        numbers = {**said(text), **comparison(text)}
        seen = snapshots(text)
        rows = []
        for name, figure in figures.items():
            at = seen[f"{name} widest"]
            rows.append([figure, f"{at['t']:.0f}"] + [f"{at[c]:.4f}" for c in ("gap", "strain", "interpolation", "rms", "rms left", "bow")]
                        + [f"{at['turn']:.4f}"])
        widest = [seen[f"{name} widest"] for name in figures]
        numbers["all"] = {f"{kind} {share}": choose(w[share] for w in widest) for share in ("percent left", "percent interpolation")
                          for kind, choose in (("least", min), ("most", max))}
        head = ["figure", "t [s]", "largest distance of a node [m]", "part of the strains [m]", "part of the interpolation [m]", "rms distance [m]",
                "rms distance after the best rigid displacement [m]", "largest height of an arc above its chord [m]",
                "rotation of the best rigid displacement [rad]"]
        return {**numbers, **seen}, markdown(head, rows)

    return read


def one_interpolation(figures):
    """Snapshots with the largest difference, and the largest part of the interpolation at all nodes and snapshots; a table."""

    def read(text):
        numbers, seen = said(text), snapshots(text)
        largest = max(numbers[name]["largest interpolation part"] for name in figures)
        rows = []
        for name, figure in figures.items():
            at = seen[f"{name} widest"]
            rows.append([figure, f"{at['t']:.0f}", f"{at['gap']:.4f}", f"{at['strain']:.4f}", small(numbers[name]["largest interpolation part"], 1e-11)])
        numbers["all"] = {"largest interpolation part": largest}
        return {**numbers, **seen}, markdown(["figure", "t [s]", "largest distance of a node [m]", "part of the strains [m]", "part of the interpolation [m]"], rows)

    return read


def small(number, bound):
    return f"< {bound:.0e}".replace("e-0", "e-") if number < bound else f"{number:.2e}"


def space(text):
    """Lines '  space PROBLEM BODY N elements GAP STRAIN INTERPOLATION' as rows 'PROBLEM BODY N'; orders as 'PROBLEM BODY'; a table."""
    numbers, found = {}, {}
    for problem, body, n, *values in re.findall(rf"^  space (\S+) +(\S+) +(\d+) elements +({NUMBER}) +({NUMBER}) +({NUMBER})$", text, re.MULTILINE):
        row = numbers[f"{problem} {body} {n}"] = dict(zip(MESHES, map(float, values)))
        found.setdefault(problem, {}).setdefault(n, []).append(row)
    rows = []
    for problem, meshes in found.items():
        coarse, fine = [of[0]["interpolation"] for of in list(meshes.values())[-2:]]
        numbers[f"{problem} LRVF"] = {"order": math.log2(coarse / fine)}
        for n, bodies in meshes.items():
            rows.append([problem, n] + [small(of[c], 1e-10) for of in bodies for c in MESHES[:3]])
    head = ["problem", "elements"] + [f"{body}, {what} [m]" for body in ("LRVF", "`Se3Beam`")
                                      for what in ("largest distance of a node", "part of the strains", "part of the interpolation")]
    return numbers, markdown(head, rows)


def equal_error(text):
    """The report of EqualErrorStudy: errors by mesh, and the differences of the physical models with their bounds."""
    numbers, errors, meshes = {}, {}, []
    for name, mesh, error in re.findall(rf"^  (\S.*?) {{2,}}(\d+) elements +({NUMBER}) ", text, re.MULTILINE):
        errors.setdefault(name, {})[mesh] = float(error)
        if mesh not in meshes:
            meshes.append(mesh)
    part = text.split("Differences between the physical models", 1)[1]
    for a, b, difference, bound in re.findall(rf"^  (\S.*?) {{2,}}(\S.*?) {{2,}}({NUMBER}) +({NUMBER})$", part, re.MULTILINE):
        numbers[f"{a} - {b}"] = {"difference": float(difference), "bound": float(bound)}
    rows = [[mesh] + [f"{of[mesh]:.2g}" for of in errors.values()] for mesh in meshes]
    return numbers, markdown(["elements"] + [f"{name}, error [m]" for name in errors], rows)


def model_parts(text):
    """The differences of the physical models; without `difference` if it is not resolved. A table of the chain of PARTS."""
    numbers = {}
    part = text.split("Differences between the physical models", 1)[1]
    for a, b, difference, bound in re.findall(rf"^  (\S.*?) {{2,}}(\S.*?) {{2,}}({NUMBER}|not resolved) +({NUMBER})$", part, re.MULTILINE):
        of = numbers[f"{a} - {b}"] = {"bound": float(bound), "resolved": float(difference != "not resolved")}
        if of["resolved"]:
            of["difference"] = float(difference)
    rows = []
    for name, row in PARTS.items():
        of = numbers[row]
        rows.append([name, *row.split(" - "), f"{of['difference']:.3f}" if of["resolved"] else "not resolved", f"{of['bound']:.1g}"])
    return numbers, markdown(["part", "first model", "second model", "difference [m]", "error bound [m]"], rows)


def bands(text):
    """Lines '  density RHO and ramp T, STIFFNESS: GAP m' as a table."""
    numbers = said(text)
    kinds = ("high", "medium", "low")
    rows = [[row.split()[1], row.split()[4]] + [f"{of[s]:.2g}" for s in kinds] for row, of in numbers.items()]
    numbers["all"] = {f"{name} {s} in % of L": 100 * choose(of[s] for of in list(numbers.values())) / 10
                      for s in kinds for name, choose in (("least", min), ("most", max))}
    return numbers, markdown(["density [kg/m³]", "ramp [s]", "high stiffness [m]", "medium stiffness [m]", "low stiffness [m]"], rows)


def plain(text):
    return {**said(text), **snapshots(text)}, ""


def energies(text):
    """Lines '  energy NAME INTEGRATOR h E0 largest end'; the remaining error of Newton's method is not repeatable."""
    numbers, rows = {}, []
    for name, method, *values in re.findall(rf"^  energy (.+?) +(\w+) +({NUMBER}) +({NUMBER}) +({NUMBER}) +({NUMBER})$", text, re.MULTILINE):
        step, start, largest, end = map(float, values)
        numbers[f"{name} {method} {step:g}"] = {"start": start, "largest": largest, "end": end}
        small = largest < 1e-10
        rows.append([name, f"`{method}`", f"{step:g}", f"{start / 1e3:.1f}", "< 1e-10" if small else f"{largest:.1e}", "< 1e-10" if small else f"{end:.1e}"])
    return numbers, markdown(["arm", "integrator", "h [ms]", "E₀ [kJ]", "largest \\|E/E₀ − 1\\|", "E/E₀ − 1 at the end"], rows)


FIGURES = {"high": "2.5, high", "medium": "2.6, medium", "fast-medium": "2.7, medium", "fast-low": "2.7, low", "axial": "2.8, 100 kN"}
CASES = {
    "arm": (PAGE, "robot_arm --no-plot", meshes(FIGURES)),
    "arm_se3": (PAGE, "robot_arm --case figures --body se3 --no-plot", one_interpolation(FIGURES)),
    "space": (PAGE, "cantilever --case space --no-plot", space),
    "arm_energy": (PAGE, "robot_arm --case energy --no-plot", energies),
    "arm_unstrained_10": (PAGE, "robot_arm --case fast-low --stiffer 1e4 --elements 10 --no-plot", plain),
    "arm_unstrained_20": (PAGE, "robot_arm --case fast-low --stiffer 1e4 --elements 20 --no-plot", plain),
    "arm_unstrained_40": (PAGE, "robot_arm --case fast-low --stiffer 1e4 --elements 40 --no-plot", plain),
    "cantilever": (PAGE, "cantilever --no-plot", meshes({"tip-moment": "2.9, 30 kN m"})),
    "cantilever_fine": (PAGE, "cantilever --case moment --step 1e-3 --until 2 --no-plot", plain),
    "arm_equal_error": (PAGE, "robot_arm --case compare --no-plot", equal_error),
    "arm_split": (PAGE, "robot_arm --case split --no-plot", model_parts),
    "arm_bands": (PAGE, "robot_arm --case bands --no-plot", bands),
}
