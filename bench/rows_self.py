#!/usr/bin/env python3
"""Google Benchmark's compare.py and bench/table print one row for each formulation of the arm.

    bench/rows_self.py FORMULATION_BENCHMARKS ROBOT_ARM

Two runs of the benchmarks with the coarse meshes give two JSON files. `robot_arm --list` gives the number of formulations.
Returns 77, a skipped test, if compare.py or its package scipy is missing (Debian: libbenchmark-tools, python3-scipy).
A third JSON file, with times 5 + 2 n, checks the fits of bench/table.
"""
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

PYTHON = "/usr/bin/python3"  # of Debian, with the packages of Debian
COMPARE = "/usr/share/benchmark/compare.py"
TABLE = pathlib.Path(__file__).with_name("table")
COARSE = "^step/robot_arm/([^/]+/){2}[^/]+(/elements:8|/modes:2)?$"
COUNTERS = ("error", "steps", "newton_iterations", "factorisations", "unknowns")


def output_of(*command):
    return subprocess.run([str(part) for part in command], check=True, stdout=subprocess.PIPE, encoding="utf-8").stdout


def rows_of(text, start):
    """First words of the lines that begin with `start` and a name."""
    return [line[len(start):].split()[0] for line in text.splitlines() if re.match(re.escape(start) + r"\w", line)]


def fits():
    """Lines of the tables of fixed parts and parts per n, for times 5 + 2 n."""
    runs = [{"name": f"step/chain/links:{n}", "run_name": f"step/chain/links:{n}", "run_type": "iteration", "cpu_time": 5 + 2 * n,
             "time_unit": "us"} for n in (1, 2, 4)]
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump({"benchmarks": runs}, file)
        file.flush()
        text = output_of(sys.executable, TABLE, "--linear", file.name)
    return [line for line in text.splitlines() if line.startswith("| chain/links:n |")]


def main():
    program, robot_arm = sys.argv[1:]
    if subprocess.run([PYTHON, COMPARE, "--help"], stdout=subprocess.DEVNULL, check=False).returncode != 0:
        print(f"skipped: {COMPARE} or scipy is missing (Debian: libbenchmark-tools, python3-scipy)")
        return 77
    formulations = int(re.search(r"(\d+) combinations exist", output_of(robot_arm, "--list"))[1])
    with tempfile.TemporaryDirectory() as folder:
        files = [pathlib.Path(folder, name) for name in ("before.json", "after.json")]
        for file in files:
            output_of(program, f"--benchmark_filter={COARSE}", "--benchmark_min_time=1e-9", f"--benchmark_out={file}",
                      "--benchmark_out_format=json")
        compared = rows_of(output_of(PYTHON, COMPARE, "--no-color", "benchmarks", *files), "step/robot_arm/")
        table = rows_of(output_of(sys.executable, TABLE, files[0]), "| robot_arm/")
        runs = json.loads(files[0].read_text(encoding="utf-8"))["benchmarks"]
    failures = [] if fits() == ["| chain/links:n | 5 |", "| chain/links:n | 2 |"] else [f"fits: {fits()}"]
    for run in runs:
        if "error_message" in run:
            failures.append(f"{run['name']}: {run['error_message']}")
        elif not all(math.isfinite(run.get(key, math.nan)) for key in COUNTERS) or run["steps"] < 1 or run["unknowns"] < 1:
            failures.append(f"{run['name']}: counters {[run.get(key) for key in COUNTERS]}")
    named = sorted(run["name"].removeprefix("step/robot_arm/") for run in runs)
    for printer, rows in (("compare.py", compared), ("bench/table", table)):
        if len(rows) != formulations or sorted(rows) != named:
            failures.append(f"{printer} prints {len(rows)} rows for {formulations} formulations; the first are {rows[:3]}")
    print("\n".join(failures) or f"{formulations} rows")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
