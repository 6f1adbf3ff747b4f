#!/usr/bin/env python3
"""bench/page writes docs/performance.md from synthetic results in the formats of the benchmarks, and the page stays short.

The copy that it writes must have the headings and the first columns of the page, and fewer words than prose.py allows, by a
margin. A part without results must be an error.
"""
import importlib.util
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = "docs/performance.md"
MARGIN = 40  # words that results may add
SPEC = importlib.util.spec_from_file_location("prose", ROOT / "tests/house/prose.py")
prose = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(prose)

CPU = "Intel(R) Xeon(R) Platinum 8370C CPU @ 2.80GHz; c++ (Debian 12.2.0-14+deb12u1) 12.2.0; -O3 -march=native -DNDEBUG; 1234abcd\n"
RUN = {"steps": 200.0, "newton_iterations": 777.0, "factorisations": 12.0, "unknowns": 345.0, "error": 1.234e-4}


def formulations():
    bodies = ["Lrvf", "Se3", "Ancf", "AncfEngineering", "Ffr", "AncfBeam", "AncfBeamContinuum", "LrvfSpace", "Se3Space"]
    names = [f"{b}/{p}/{i}/elements:{n}" for b in bodies for p in ("Constraint", "Penalty") for i in ("GeneralisedAlpha", "Radau")
             for n in (8, 32)]
    names += [f"{b}/Constraint/GeneralisedAlpha" for b in ("Rigid", "RigidSpace")]
    names += [f"FfrModal/Constraint/GeneralisedAlpha/modes:{n}" for n in (2, 8)]
    return {f"step/robot_arm/{name}": RUN for name in names}


def steps():
    return {f"step/chain/{name}": RUN for links in (4, 16, 64, 256, 1024)
            for name in (f"Constraint/links:{links}/BlockSolver", f"Constraint/links:{links}/EigenSparseLu",
                         f"Penalty/links:{links}/BlockSolver")}


def bodies():
    names = ["Rigid<>", "Rigid<EulerParameters>", "AncfCable<>", "AncfBeam<ElasticLine>", "AncfBeam<Continuum<>>",
             "Lrvf<RelativeRotation>", "Lrvf<Direct>", "Se3Beam", "Lrvf<RelativeRotation>/damped", "Se3Beam/damped", "Ffr/modes:6",
             "Ffr/stiffening/modes:6", "Ffr/nodal_coordinates:48", "planar::Rigid", "planar::AncfCable<>", "planar::Lrvf",
             "planar::Se3Beam", "planar::Ffr/nodal_coordinates:24"]
    return {f"{kind}/{name}": {"elements": 16.0} for kind in ("residual", "tangent") for name in names}


def joints():
    policies = ["Constraint", "Penalty", "PenaltyPerEquation", "Bushing", "NonlinearBushing", "JointCoordinates"]
    chains = [f"rigid/{p}" for p in ["free", *policies]] + [f"cables/{p}" for p in ("free", "Constraint", "AncfLinear")]
    return {f"{part}/{chain}/links:{n}": RUN for part in ("residual", "tangent", "factorisation", "solution", "step")
            for chain in chains for n in (16, 64, 1024)}


def vehicle():
    links = ["Rigid", "Ancf", "Ffr", "FfrNodal", "Fe", "Lrvf", "Se3", "Beam", "Continuum", "RigidEulerParameters", "AncfEngineering"]
    pins = ["Constraint", "Penalty", "Bushing", "AncfLinear", "JointCoordinates"]
    return {f"step/{link}/{pin}": RUN for link in links for pin in pins}


def gradients():
    chains = {f"{body}{way}/links:64": 33 for body in ("Rigid", "AncfCable") for way in ("", "_turning")}
    found = {}
    for name, most in (chains | {"vehicle": 100}).items():
        for count in (1, most):
            found[f"sensitivities/{name}/parameters:{count}"] = {"runs": 3.0 + count}
            found[f"gradient/{name}/parameters:{count}"] = {"runs": 4.0 + count, "error": 1e-11}
        found[f"gradient/{name}/parameters:1/snapshots:50"] = {"runs": 5.0, "error": 1e-11}
    return found


def chains_of_start(policy):
    rows = "\n".join(f"{n:8d}" + "".join(f"  {1e-4 * n:9.3f} (1.01)" for _ in range(5)) for n in (1000, 3000, 10000, 20000, 100000))
    return f"\nchain, {policy} [s] (exponent)\n  bodies  adding            simulate          first step        summary\n{rows}\n"


TEXTS = {
    "factorisation": "\nfactor + solve, vehicle with two tracks: 1234 unknowns, 56789 in the factor, 1.23 Mflop\n" + "".join(
        f"  {name:36} {71.0:9.1f} us   {1.0:6.2f} x block LDLT   residual 1.2e-16\n"
        for name in ("block LDLT", "block LU", "block, symmetry measured", "Eigen SimplicialLDLT, AMD, shifted",
                     "Eigen SparseLU, COLAMD, numeric", "KLU refactor, its own order", "KLU refactor, block order")) + "".join(
                         f"  {n:5d} links   {0.23:6.3f} us a link   1.00 x that at 64\n" for n in (64, 256, 1024, 4096)),
    "questions": "step 40.0 us; energy, violation and reaction: of the run 7.80 us (0.195 of the step), again 0.10 us, "
                 "by functions of model and state 66.0 us\n",
    "waist": f"  {'whole Newton iteration, block solver':44} 1.34\n",
    "elements": "  planar Lrvf  M a - f: 10.0, in packs 3.0, ratio 3.33;   tangent: 10.0, in packs 3.0, ratio 3.33;   both: ratio 3.33\n",
    "start": chains_of_start("Constraint") + chains_of_start("JointCoordinates"),
    "compile": "".join(f"{name:45}  {3.6:6.1f}  {'-':>6}  {1.5:7.1f}  {500:6.0f}  {'-':>6}\n"
                       for name in ("polybody/polybody.hpp", "examples/ex01_pendulum.cpp", "examples/ex01_pendulum.cpp, compiled",
                                    "examples/ex01_pendulum.cpp, precompiled")),
}
PROGRAMS = {"formulations": formulations(), "steps": steps(), "bodies": bodies(), "joints": joints(), "vehicle": vehicle(),
            "gradients": gradients(), "trees": {f"call/{code}/links:64": {} for code in ("polybody", "Simbody")}}


def write_results(folder):
    for program, text in TEXTS.items():
        (folder / f"bench_{program}.txt").write_text(text, encoding="utf-8")
    (folder / "machine.txt").write_text(CPU, encoding="utf-8")
    for program, found in PROGRAMS.items():
        runs = [{"name": name, "run_name": name, "run_type": "iteration", "cpu_time": 1.0 + 3.3 * int((re.findall(r"links:(\d+)", name) or [9])[0]),
                 "time_unit": "us", **counters} for name, counters in found.items()]
        (folder / f"bench_{program}.json").write_text(json.dumps({"context": {"num_cpus": 16}, "benchmarks": runs}), encoding="utf-8")


def labels(page):
    """Rows of headings, and the first cell of the other rows, of the tables of a page."""
    lines = [line for line in page.splitlines() if line.startswith("|")]
    heads = {i for i, line in enumerate(lines[1:]) if re.fullmatch(r"[|\-]+", line)}
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    named = lambda row: row[:2] if len(row) == 7 and row[0].startswith("`") else row[:1]  # a body and its number of elements
    return ["; ".join(row if i in heads else named(row)) for i, row in enumerate(cells)]


def main():
    page, faults = (ROOT / PAGE).read_text(encoding="utf-8"), []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_results(folder)
        copy = folder / "page.md"
        copy.write_text(page, encoding="utf-8")
        ran = subprocess.run([sys.executable, ROOT / "bench/page", folder, "--page", copy], capture_output=True, text=True, check=False)
        faults += ran.stderr.splitlines()
        written = copy.read_text(encoding="utf-8")
        (folder / "machine.txt").unlink()
        ran = subprocess.run([sys.executable, ROOT / "bench/page", folder, "--page", copy], capture_output=True, text=True, check=False)
        if ran.returncode != 1 or "machine: the results lack" not in ran.stderr:
            faults.append("bench/page does not name a part without results.")
    count, most = prose.words(written), prose.LONGEST[PAGE]
    if count > most - MARGIN:
        faults.append(f"{PAGE} has {count} words after bench/run --write; at most {most - MARGIN} are allowed.")
    if "at commit `1234abcd`" not in written:
        faults.append("the written page does not name the commit.")
    ours, theirs = labels(page), labels(written)
    faults += [f"{PAGE} has no row \"{row}\", which bench/page writes." for row in theirs if row not in ours]
    faults += [f"{PAGE} has a row \"{row}\", which bench/page does not write." for row in ours if row not in theirs]
    if not faults and ours != theirs:
        faults.append(f"the rows of {PAGE} have another order than bench/page writes.")
    print("\n".join(faults) or f"{len(ours)} rows, {count} words after bench/run --write")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
