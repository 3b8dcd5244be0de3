"""Runs in real time without any fault, while this computer compiles: does the controller stop itself?

Every run should end with a complete record. One that does not is put down to its cause: the controller's own message,
beside how late this computer wakes a process that sleeps, measured meanwhile.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tests.faults.runs import PLAN, RECORD, prepared

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "cpp" / "src" / "identifiability.cpp"
RATES_HZ = (50, 250)
SLEEP_S = 0.004
"""Period of the sleeper that measures the lateness: a cycle at 250 Hz."""


@dataclass(frozen=True)
class Soaked:
    """One run: its rate, exit status, last message, and the lateness of this computer, ms: median, 99 %, largest."""

    rate_hz: int
    exit_status: int
    message: str
    late_ms: tuple[float, float, float]


@contextmanager
def compiling() -> Iterator[None]:
    """Compile a source of the engine again and again, one process a core, for the length of the context."""
    end = threading.Event()
    command = ["c++", "-std=c++20", "-O2", f"-I{ROOT / 'cpp' / 'include'}", "-I/usr/include/eigen3", "-c", str(SOURCE)]

    def compile_again() -> None:
        while not end.is_set():
            subprocess.run([*command, "-o", os.devnull], check=False, capture_output=True)

    threads = [threading.Thread(target=compile_again, daemon=True) for _ in range(os.cpu_count() or 1)]
    for each in threads:
        each.start()
    try:
        yield
    finally:
        end.set()
        for each in threads:
            each.join()


def soak(runs: int) -> Iterator[Soaked]:
    """Yield the outcome of `runs` runs at each rate."""
    with tempfile.TemporaryDirectory() as name, compiling():
        folder = Path(name)
        for number in range(runs):
            for rate_hz in RATES_HZ:
                yield _one(folder, rate_hz, number)


def _one(folder: Path, rate_hz: int, seed: int) -> Soaked:
    truth = prepared(folder, PLAN)
    late: list[float] = []
    end = threading.Event()
    sleeper = threading.Thread(target=_measure, args=(end, late), daemon=True)
    sleeper.start()
    words = ["--plan", str(folder / "plan.toml"), "--truth", str(truth)]
    words += ["--seed", str(seed), "--rate", str(rate_hz), "--realtime", "--overwrite", "-o", str(folder / RECORD)]
    program = "import sys; from hexdbb.cli.run import main; sys.argv[0] = 'hexdbb-run'; main()"
    done = subprocess.run([sys.executable, "-c", program, *words], capture_output=True, text=True, check=False)
    end.set()
    sleeper.join()
    lines = done.stderr.strip().splitlines()
    late_ms = 1e3 * np.percentile(late, [50.0, 99.0, 100.0])
    return Soaked(rate_hz, done.returncode, lines[-1] if lines and done.returncode else "", tuple(map(float, late_ms)))


def _measure(end: threading.Event, late: list[float]) -> None:
    while not end.is_set():
        due_s = time.monotonic() + SLEEP_S
        time.sleep(SLEEP_S)
        late.append(time.monotonic() - due_s)


def report(runs: int) -> int:
    """Run, print every run and a summary; return the number of runs without a complete record."""
    found = []
    for each in soak(runs):
        found.append(each)
        late = ", ".join(f"{value:.1f}" for value in each.late_ms)
        outcome = "complete" if each.exit_status == 0 else each.message
        print(
            f"{each.rate_hz} Hz: {outcome} (this computer wakes late by {late} ms: median, 99 %, largest)", flush=True
        )
    for rate_hz in RATES_HZ:
        counts = Counter(each.exit_status == 0 for each in found if each.rate_hz == rate_hz)
        print(f"{rate_hz} Hz: {counts[True]} of {counts.total()} runs complete")
    return sum(each.exit_status != 0 for each in found)
