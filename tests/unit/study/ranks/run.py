"""Studies over MPI ranks: run.py PROGRAM MPIEXEC

Ranks write the same table as one thread, bit for bit. A rank that is killed in mid-run ends all ranks. Any later run, by
ranks or by threads, continues without losing or repeating a finished point. Every rank refuses invalid input, and no rank
waits forever.

"""
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

POINTS = 60
HEAD = 8  # lines of the record before the first point
# Open MPI without a network, as root in a container, and with more ranks than cores.
ENVIRONMENT = dict(
    os.environ,
    ASAN_OPTIONS="detect_leaks=0",  # MPI keeps its memory to the end
    OMPI_ALLOW_RUN_AS_ROOT="1",
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
    OMPI_MCA_btl="self,vader",
    OMPI_MCA_btl_vader_single_copy_mechanism="none",
    OMPI_MCA_plm="isolated",
    OMPI_MCA_rmaps_base_oversubscribe="1",
    OMPI_MCA_hwloc_base_binding_policy="none",
    OMPI_MCA_odls_base_sigkill_timeout="0",  # seconds that the other ranks go on after one is killed
)


class Runs:
    def __init__(self, program, mpiexec):
        self.program, self.mpiexec = program, mpiexec

    def command(self, folder, ranks, *options):
        alone = [self.program, str(folder), *options]
        return [*alone, "--alone"] if ranks == 0 else [self.mpiexec, "-n", str(ranks), *alone]

    def run(self, folder, ranks, *options):
        return subprocess.run(self.command(folder, ranks, *options), env=ENVIRONMENT, capture_output=True, text=True,
                              timeout=120)

    def table(self, folder, ranks, *options):
        ran = self.run(folder, ranks, *options)
        require(ran.returncode == 0, f"{ranks} ranks end with {ran.returncode}: {ran.stderr}")
        return (folder / "a.csv").read_bytes()


def require(holds, what):
    if not holds:
        sys.exit(f"study over ranks: {what}")


def calls(folder):
    """[(point, rank, process)] of the calls so far"""
    file = folder / "calls"
    return [tuple(map(int, line.split())) for line in file.read_text().splitlines()] if file.exists() else []


def recorded(folder):
    file = folder / "a.study"
    return file.read_bytes().count(b"\n") - HEAD if file.exists() else -HEAD


def kill_in_mid_run(runs, folder, ranks, victim):
    """Kills the process of rank `victim` once six more points are recorded."""
    before = recorded(folder)
    goal = max(before, 0) + 6
    first = len(calls(folder))
    running = subprocess.Popen(runs.command(folder, ranks, "--pause", "150"), env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 60
    pids = set()
    while (recorded(folder) < goal or not pids) and running.poll() is None and time.monotonic() < deadline:
        time.sleep(0.005)
        pids = {process for _, rank, process in calls(folder)[first:] if rank == victim}
    require(pids and running.poll() is None, f"rank {victim} of {ranks} did no work, or all ended before they were killed")
    for pid in pids:
        os.kill(pid, signal.SIGKILL)
    require(running.wait(timeout=60) != 0, "a run whose rank was killed ends as if all was well")
    require(goal <= recorded(folder) < POINTS, f"{recorded(folder)} points are recorded after the kill")


def check_tables(runs, root, one):
    for ranks, options in [(1, []), (1, ["--threads", "2"]), (2, []), (3, []), (0, ["--threads", "2"])]:
        folder = root / f"table of {ranks} {len(options)}"
        folder.mkdir()
        require(runs.table(folder, ranks, *options) == one, f"{ranks} ranks {options} give another table")
        require(sorted(point for point, _, _ in calls(folder)) == list(range(POINTS)), "a point is done twice, or never")
        for rank in range(1, ranks):
            require((folder / f"a{rank}.csv").read_bytes() == one, f"rank {rank} of {ranks} has another table")


def check_sharing(runs, root):
    folder = root / "sharing"
    folder.mkdir()
    runs.table(folder, 3, "--pause", "20")
    shares = [sum(rank == r for _, rank, _ in calls(folder)) for r in range(3)]
    require(min(shares) >= 5, f"points of the ranks: {shares}")


def check_kills(runs, root, one):
    for ranks, victim, then in [(2, 1, 2), (2, 0, 3), (3, 2, 0), (0, 0, 2)]:
        folder = root / f"kill {ranks} {victim}"
        folder.mkdir()
        for again in range(2):
            kill_in_mid_run(runs, folder, ranks, victim)
        finished = recorded(folder)
        before = len(calls(folder))
        require(runs.table(folder, then) == one, f"after a kill of rank {victim} of {ranks} the table is another one")
        require(recorded(folder) == POINTS, "the record has not a line for each point")
        require(len(calls(folder)) - before == POINTS - finished, "the last run did other than what was left")


def check_refusals(runs, root):
    def refused(name, ranks, words, *options, folder=None):
        if folder is None:
            folder = root / f"refused {name}"
            folder.mkdir()
        ran = runs.run(folder, ranks, *options)
        require(ran.returncode != 0, f"{name}: taken")
        require(words in ran.stderr, f"{name}: '{words}' is not in: {ran.stderr}")
        return folder, ran.stderr

    _, told = refused("differs", 2, "the ranks have different studies", "--fail", "differs")
    refused("worker", 2, "rank 1: a worker's own error", "--fail", "worker", "--pause", "2")
    refused("first", 3, "rank 0: the first rank's own error", "--fail", "first", "--pause", "2")
    folder, _ = refused("misuse", 2, 'no column "no such column"', "--fail", "misuse", "--pause", "2")
    require(runs.run(folder, 2).returncode == 0, "after an error of the program the study does not go on")
    _, told = refused("folder", 2, "cannot be created", folder=Path("/proc/no such folder"))
    require("rank 0: " in told and "rank 1: " in told, f"not every rank is told: {told}")
    folder = root / "damaged"
    folder.mkdir()
    runs.table(folder, 2)
    record = (folder / "a.study").read_bytes()
    (folder / "a.study").write_bytes(record.replace(b"\n30", b"\n31", 1))
    refused("damaged", 2, ", line ", folder=folder)


def check_limits(runs, root, one):
    """Points that do not end fail after their time limit, with ranks and threads; the other points are not affected."""
    for ranks, options in [(0, ["--threads", "2"]), (1, []), (3, [])]:
        folder = root / f"limit {ranks}"
        folder.mkdir()
        lines = runs.table(folder, ranks, "--limit", "1", "--fail", "hangs", *options).splitlines()
        for i, (line, plain) in enumerate(zip(lines, one.splitlines(), strict=True)):
            if i - 1 in (5, 40):
                require(b"The computation has not ended within the time limit of 1 s." in line, f"point {i - 1} under {ranks} ranks: {line}")
            else:
                require(line == plain, f"under a time limit and {ranks} ranks: {line} for {plain}")


def main(program, mpiexec):
    runs = Runs(program, mpiexec)
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        folder = root / "one"
        folder.mkdir()
        one = runs.table(folder, 0)
        require(one.count(b"\n") == POINTS + 1 and b"is off" in one, f"the table of one thread: {one.decode()}")
        check_tables(runs, root, one)
        check_sharing(runs, root)
        check_kills(runs, root, one)
        check_refusals(runs, root)
        check_limits(runs, root, one)
    print("studies over ranks: as they should be")


if __name__ == "__main__":
    main(*sys.argv[1:])
