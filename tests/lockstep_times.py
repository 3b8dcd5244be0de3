"""Time of a run in lockstep: `python -m tests.lockstep_times [--against TREE] [--plan standard]`.

Simulated rig and `hexdbb-run` are processes of their own, as for a user. Printed for each run: wall-clock time from the
command to its end, processor time of both processes (user and system; start-up of `hexdbb-run` included), and how often
each of them gave up or lost its processor, per sample. Other programs of the computer stretch the wall-clock time, and
the processor time less. With another source tree, built as this one, runs of both take turns, and all their samples
must be equal.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from statistics import median

import numpy as np

from hexdbb.record import read_record

ROOT = Path(__file__).parents[1]
SEED = 5
RIG = "from hexdbb.cli import main; main()"
RUN = "from hexdbb.cli.run import main; main()"


@dataclass(frozen=True)
class Times:
    """Times of one run, s, and switches of each process per sample."""

    wall_s: float
    run_user_s: float
    run_system_s: float
    rig_user_s: float
    rig_system_s: float
    run_switches: float
    rig_switches: float


def measured(tree: Path, plan: str, rate_hz: float, record: Path) -> Times:
    """Run a plan with the program of a source tree."""
    words = ["--plan", plan, "--rate", str(rate_hz), "--lockstep", "--yes", "-o", str(record), "--overwrite"]
    with _program(tree, RIG, "rig", "--seed", str(SEED), "--exit-with-parent") as rig:
        assert rig.stdout is not None
        address = rig.stdout.readline().split()[-1]
        before, begun_s = _used(rig.pid), time.monotonic()
        with _program(tree, RUN, *words, "--bus", f"socketcand:{address}", errors=subprocess.STDOUT) as run:
            assert run.stdout is not None
            told = run.stdout.read()
            _, status, usage = os.wait4(run.pid, 0)
            run.returncode = os.waitstatus_to_exitcode(status)
        wall_s, after = time.monotonic() - begun_s, _used(rig.pid)
        rig.terminate()
    if run.returncode:
        raise SystemExit(f"{tree}: the run ended with exit status {run.returncode}: {told}")
    samples = len(read_record(record))
    switches = usage.ru_nvcsw + usage.ru_nivcsw
    user_s, system_s, rig_switches = (b - a for a, b in zip(before, after, strict=True))
    return Times(wall_s, usage.ru_utime, usage.ru_stime, user_s, system_s, switches / samples, rig_switches / samples)


@contextmanager
def _program(tree: Path, code: str, *words: str, errors: int = subprocess.DEVNULL) -> Iterator[subprocess.Popen[str]]:
    path = os.pathsep.join([str(tree / "python"), str(tree), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, "-c", code, *words]
    with subprocess.Popen(
        command, env={**os.environ, "PYTHONPATH": path}, stdout=subprocess.PIPE, stderr=errors, text=True
    ) as process:
        try:
            yield process
        finally:
            if process.returncode is None:
                process.terminate()


def _used(pid: int) -> tuple[float, float, float]:
    """Return user and system time (s) and switches of a process so far."""
    words = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    tick = os.sysconf("SC_CLK_TCK")
    status = Path(f"/proc/{pid}/status").read_text().splitlines()
    switches = sum(int(line.split()[1]) for line in status if "ctxt_switches" in line)
    return int(words[11]) / tick, int(words[12]) / tick, float(switches)


def _differing(one: Path, other: Path) -> list[str]:
    """Return the columns in which two records differ."""
    a, b = (read_record(path).columns for path in (one, other))
    return [name for name in a if not np.array_equal(a[name], b[name])]


def _shown(name: str, times: Times) -> str:
    return f"| {name} | " + " | ".join(f"{value:.2f}" for value in astuple(times)) + " |"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--against", type=Path, help="another source tree")
    parser.add_argument("--plan", default="standard")
    parser.add_argument("--rate", type=float, default=20.0)
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    trees = {"before": options.against.resolve()} if options.against else {}
    trees["now"] = ROOT
    found: dict[str, list[Times]] = {name: [] for name in trees}
    print("| tree | " + " | ".join(each.name for each in fields(Times)) + " |", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(options.runs):
            for name, tree in trees.items():
                times = measured(tree, options.plan, options.rate, Path(folder) / f"{name}.parquet")
                found[name].append(times)
                print(_shown(name, times), flush=True)
            if options.against and (wrong := _differing(*(Path(folder) / f"{name}.parquet" for name in trees))):
                raise SystemExit(f"records differ in {', '.join(wrong)}")
    for name, runs in found.items():
        print(_shown(f"{name}, median", Times(*(median(each) for each in zip(*map(astuple, runs), strict=True)))))


if __name__ == "__main__":
    main()
