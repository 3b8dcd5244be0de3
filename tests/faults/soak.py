"""Runs in real time without any fault, while this computer compiles: does the controller stop itself?

Every run should end with a complete record. One that does not is put down to its cause: the controller's own message,
beside how late this computer wakes a process that sleeps, measured meanwhile.
"""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from tests.faults.runs import DEADLINE_S, PLAN, RECORD, command_line, prepared

ROOT = Path(__file__).parents[2]
RATES_HZ = (50, 250)
SLEEP_S = 0.004
"""Period of the sleeper that measures the lateness: a cycle at 250 Hz."""
CONFIGURE = ("-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DHEXDBB_TESTS=ON")
"""The engine with its tests, as `make test` compiles it."""

HEAD = """# Runs in real time without a fault, on a computer that compiles

Made by `python -m tests.faults --soak {runs} --table docs/soak.md`; nothing here is written by hand.
One circle of {duration_s:.0f} s of machine time, {runs} times at each rate, controller and simulated rig each a process
of its own, on {computer}, {cores} cores, **while the engine is compiled by {cores} processes**; load average
{load_begin:.1f} before the compilation, {load_end:.1f} at the end (a core fully used is 1). Every run should end
complete: without a fault the controller has no reason to stop.

*Lateness* is how much later than asked a process wakes that sleeps 4 ms, measured during the runs: the median, the
99th percentile and the worst of all. It is what the computer does to any program, hexdbb not involved. A cycle
lasts 20 ms at 50 Hz and 4 ms at 250 Hz. *Missed* are SYNCs that the controller left out because it was late.

| rate | complete | stopped by the controller | samples missing in complete records: median, worst | lateness: median | 99 % | worst |
|---|---|---|---|---|---|---|
"""


@dataclass(frozen=True)
class Soaked:
    """One run.

    Attributes
    ----------
    rate_hz : int
    exit_status : int
    message : str
        Last line on stderr of a run that did not succeed, else of stdout: samples and missed cycles.
    missed : int or None
        Missed cycles of a complete record.
    late_ms : ndarray
        Lateness of a sleeping process, ms.
    """

    rate_hz: int
    exit_status: int
    message: str
    late_ms: np.ndarray

    def __str__(self) -> str:
        median, most, worst = np.percentile(self.late_ms, [50.0, 99.0, 100.0])
        return f"{self.rate_hz} Hz: {self.message} (lateness {median:.1f}, {most:.1f}, {worst:.1f} ms)"


@contextmanager
def compiling() -> Iterator[None]:
    """Compile the engine into a scratch directory, again and again, one process a core."""
    end = threading.Event()
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run(["cmake", "-S", str(ROOT), "-B", scratch, *CONFIGURE], check=True, capture_output=True)
        build = ["cmake", "--build", scratch, "--parallel", str(os.cpu_count()), "--clean-first"]

        def compile_again() -> None:
            while not end.is_set():
                with subprocess.Popen(build, stdout=subprocess.DEVNULL, start_new_session=True) as process:
                    while process.poll() is None and not end.wait(0.2):
                        pass
                    if end.is_set():
                        os.killpg(process.pid, 15)
                    elif process.returncode:
                        raise RuntimeError("the engine does not compile")

        thread = threading.Thread(target=compile_again)
        thread.start()
        try:
            yield
        finally:
            end.set()
            thread.join()
            shutil.rmtree(scratch, ignore_errors=True)
            Path(scratch).mkdir(exist_ok=True)
