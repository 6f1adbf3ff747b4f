"""Mutants of the formulas in the headers, and the number of them that a test detects (tests/tools/mutants/run)."""

import argparse
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from sites import ROOT, all_sites, put_in  # noqa: E402

FACTORS = {-1.0: "sign", 0.0: "dropped", 1.01: "x 1.01"}
BUILD = ROOT / "build" / "mutants"
REASONS = ROOT / "tests/tools/mutants/reasons.txt"
LONGEST_TEST = 40.0  # s; longer tests are not used


def arguments():
    p = argparse.ArgumentParser(prog="tests/tools/mutants/run", description=__doc__)
    p.add_argument("--mutants", type=int, default=400, help="how many are drawn (400)")
    p.add_argument("--seed", type=int, default=None, help="of the drawing (by the clock)")
    p.add_argument("--only", default="", help="of headers whose path holds this")
    p.add_argument("--clang", required=True)
    p.add_argument("--minutes", type=float, default=90, help="no mutant is begun later (90)")
    p.add_argument("--again", type=Path, help="those that a run left in build/mutants/survivors.txt, or a copy of it")
    return p.parse_args()


def draw(options):
    """{number: site}, twice the requested number, because some sites contain no number; and {number: factor}."""
    sites = [s for s in all_sites(ROOT / "include") if options.only in s.header]
    lot = random.Random(options.seed)
    if options.again:
        asked = [line.split(" @ ") for line in options.again.read_text().splitlines()]
        factors = {(header, row): float(factor) for header, row, factor in asked}
        drawn = [s for s in sites if (s.header, s.row) in factors]
        return dict(enumerate(drawn)), {i: factors[s.header, s.row] for i, s in enumerate(drawn)}, len(sites)
    drawn = lot.sample(sites, min(len(sites), 2 * options.mutants, 4095))
    return dict(enumerate(drawn)), {i: lot.choice(list(FACTORS)) for i in range(len(drawn))}, len(sites)


def build(numbered, clang):
    """A copy of the sources with the sites, and its test programs."""
    copy = BUILD / "source"
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True, check=True).stdout.decode()
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, copy / name)
    shutil.copy2(ROOT / "tests/tools/mutants/mutant.hpp", copy / "include/polybody/mutant.hpp")
    put_in(copy / "include", numbered)
    log = BUILD / "build.log"
    with log.open("w") as out:
        configure = ["cmake", "--preset", "clang", f"-DCMAKE_CXX_COMPILER={clang}", "-DPOLYBODY_BUILD_EXAMPLES=OFF"]
        made = subprocess.run(configure, cwd=copy, stdout=out, stderr=out).returncode == 0
        if made:
            graph = subprocess.run(["ninja", "-C", "build/clang", "-t", "targets", "all"], cwd=copy, capture_output=True)
            programs = re.findall(r"^(tests/test_\w+): CXX_EXECUTABLE_LINKER", graph.stdout.decode(), re.MULTILINE)
            made = subprocess.run(["ninja", "-C", "build/clang", "-j", str(os.cpu_count()), "-k", "0", *programs], cwd=copy, stdout=out, stderr=out).returncode == 0
    if not made:
        sys.exit(f"The copy with the mutants does not build; {log} says where.")


class Test:
    def __init__(self, program, name):
        self.program, self.name = program, name
        self.seconds, self.passed, self.reached = 0.0, False, set()


def list_tests():
    tests = []
    for program in sorted((BUILD / "source/build/clang/tests").glob("test_*")):
        if not (program.is_file() and os.access(program, os.X_OK)):
            continue
        said = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True).stdout
        suite = ""
        for line in said.splitlines():
            if line.startswith("  "):
                tests.append(Test(program, suite + line.split("#")[0].strip()))
            elif re.match(r"\S+\.\s*(#.*)?$", line):
                suite = line.split("#")[0].strip()
    return tests


def run(program, names, seconds, **environment):
    """True if the tests pass. They run in a separate folder because they write files."""
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "--gtest_filter=" + ":".join(names), "--gtest_fail_fast", "--gtest_brief=1"]
        try:
            done = subprocess.run(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                  timeout=seconds, env={**os.environ, **environment, "TMPDIR": folder})
            return done.returncode == 0
        except subprocess.TimeoutExpired:
            return False


def record(test):
    """Runs the test without a mutant. Returns the sites it reaches, 1 as numbers, 2 as other objects."""
    with tempfile.TemporaryDirectory() as folder:
        reached = Path(folder) / "reached"
        begin = time.monotonic()
        test.passed = run(test.program, [test.name], 300, POLYBODY_MUTANT_REACHED=str(reached))
        test.seconds = time.monotonic() - begin
        rows = reached.read_text().split() if reached.exists() else []
    test.reached = {int(i) for i, kind in zip(rows[::2], rows[1::2]) if kind == "1"}
    test.others = {int(i) for i, kind in zip(rows[::2], rows[1::2]) if kind == "2"}


def batches(tests):
    """Tests that run together: few and short ones first, each batch from one program."""
    waiting, most = sorted(tests, key=lambda t: t.seconds), 1.0
    while waiting:
        now, budget = [], most
        while waiting and (not now or budget > 0):
            now.append(waiting.pop(0))
            budget -= now[-1].seconds
        for program in sorted({t.program for t in now}):
            yield program, [t for t in now if t.program == program]
        most *= 3


def notices(number, factor, tests):
    """The name of the test that fails with the mutant, or of the first of several; None if all pass."""
    for program, some in batches(tests):
        seconds = 5 + 5 * sum(t.seconds for t in some)
        if not run(program, [t.name for t in some], seconds, POLYBODY_MUTANT=f"{number}:{factor}"):
            return some[0].name
    return None


def reasons():
    """{(header, row with its mark): reason}: rows of reasons.txt are `header @ row @ reason`."""
    known = {}
    for line in REASONS.read_text().splitlines() if REASONS.exists() else []:
        if line and not line.startswith("#"):
            header, row, reason = (part.strip() for part in line.split(" @ "))
            known[header, row] = reason
    return known


def main():
    options = arguments()
    options.seed = options.seed if options.seed is not None else int(time.time()) % 100000
    begin = time.monotonic()
    numbered, factors, total = draw(options)
    print(f"seed {options.seed}: {len(numbered)} of {total} sites", flush=True)
    shutil.rmtree(BUILD / "source/include", ignore_errors=True)
    BUILD.mkdir(parents=True, exist_ok=True)
    build(numbered, options.clang)
    print(f"built in {time.monotonic() - begin:.0f} s", flush=True)
    tests = list_tests()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(record, tests))
    failing = [t for t in tests if not t.passed]
    print(f"{len(tests)} tests recorded, {time.monotonic() - begin:.0f} s; without a mutant {len(failing)} fail and are left out", flush=True)
    for t in failing[:20]:
        print(f"  fails: {t.program.name} {t.name}")
    good = [t for t in tests if t.passed and t.seconds <= LONGEST_TEST]

    numbers = {i for t in tests for i in t.reached}
    others = {i for t in tests for i in t.others} - numbers
    chosen = [i for i in numbered if i not in others][: options.mutants]
    known, lock, found = reasons(), threading.Lock(), {"killed": 0, "survived": [], "not reached": [], "not run": 0}

    def check_step(i):
        if time.monotonic() - begin > 60 * options.minutes:
            with lock:
                found["not run"] += 1
            return
        if i not in numbers:
            with lock:
                found["not reached"].append(i)
            return
        reaching = [t for t in good if i in t.reached]
        killer = notices(i, factors[i], reaching)
        with lock:
            if killer:
                found["killed"] += 1
            else:
                found["survived"].append((i, len(reaching)))

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(check_step, chosen))

    open_ones, survivors = 0, (BUILD / "survivors.txt").open("w")
    for i, count in sorted(found["survived"] + [(i, 0) for i in found["not reached"]]):
        site = numbered[i]
        reason = known.get((site.header, site.row))
        open_ones += reason is None
        survivors.write(f"{site.header} @ {site.row} @ {factors[i]}\n")
        print(f"{site.header}:{site.line} ({FACTORS[factors[i]]}, {count} tests reach it)\n    {site.row}"
              + (f"\n    {reason}" if reason else ""))
    survivors.close()
    left = len(found["survived"]) + len(found["not reached"])
    print(f"{len(chosen)} mutants: {found['killed']} killed, {len(found['survived'])} survived, "
          f"{len(found['not reached'])} not reached, {left - open_ones} of both with a reason, {found['not run']} not run; "
          f"{time.monotonic() - begin:.0f} s")
    sys.exit(1 if open_ones else 0)


if __name__ == "__main__":
    main()
