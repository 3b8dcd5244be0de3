"""Runs in real time without any fault, while this computer compiles: does the controller stop itself?

Every run should end with a complete record. One that does not is put down to its cause: the controller's own message,
beside how late this computer woke threads that slept on each of its processors at that very time.
"""

from __future__ import annotations

import os
import platform
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tests.faults.runs import RECORD, command_line, prepared

from hexdbb.capture.realtime import FIFO_PRIORITY
from hexdbb.files.atomic_file import write_text

ROOT = Path(__file__).parents[2]
RATES_HZ = (50, 250)
SLEEP_S = 0.004
"""Period of the sleeper that measures the lateness: a cycle at 250 Hz."""
CONFIGURE = ("-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DHEXDBB_TESTS=ON")
"""The engine with its tests, as `make test` compiles it."""

LONGEST_S = 120.0
"""Longest time of a run, s: it takes 13 s, and its start, which nobody schedules in real time, many times as long where
other programs wait too."""
STOPS = "stopping all axes"
"""Stage that `hexdbb-run` prints when a fault has been found."""
SHOWN_S = 0.15
"""Time after which a stage is printed at the latest, s: the display looks ten times a second."""
LOOKED_BACK_S = 0.1
"""Time before a fault in which a delay of this computer may be its cause, s, beside the SYNCs that it takes to be
found: drives stop on their own after so long without targets."""
SYNCS_TO_FIND = 4
"""SYNCs from a cause to its fault: three unanswered ones, and the one before them."""
COST_SYNCS = 3
"""Samples that a delay costs beside its own cycles: the SYNC whose answers were incomplete, one left out to wait for
them, one left out later for those still owed."""

SUMMARY = re.compile(r"(\d+) of (\d+) samples, .*, (\d+) missed cycles")
"""What `hexdbb-run` prints at the end of a complete run."""

HEAD = """# Real time while the computer compiles

Made by `python -m tests.faults --soak {runs} --table docs/soak.md`; nothing here is written by hand.
Without a fault the controller has no reason to stop: every run should end complete. One circle is driven {runs} times
at each rate, in real time, on {computer} with {cores} cores, **while {cores} processes compile the engine**.
The controller requests real-time scheduling (SCHED_FIFO) for itself, and is given it here for the simulated rig too, a
process of its own: real nodes do not wait for a compiler ({granted}).
Load average {before:.1f} before the compilation began, {after:.1f} at the end: what is above {cores} is work that
waits, that of others on this computer included.

- *Lateness*: how much later than asked a thread of the same scheduling wakes that sleeps 4 ms, one bound to each
  processor, measured during all runs of a rate. It is what this computer does to any program. A cycle lasts 20 ms at
  50 Hz and 4 ms at 250 Hz; a SYNC later than half a cycle is left out and counted as *missed*.
- *Missing*: samples planned and not in a record said to be complete, at most 1 %.
- *Put down to this computer*: of the runs that did not end complete, those in which one of these threads was late by
  more than half a cycle **at the time of the fault** (the {looked_back:.0f} ms and {syncs} SYNCs before the controller
  said that it stopped), or late so often while the axes moved that this explains every sample missing from a short
  record (a delay of n cycles costs at most n + {cost}). Otherwise the run is *unexplained*.
- *Short*: driven to its end, but more than 1 % of the samples are missing, and the record says so. *Stopped*: the
  controller stopped the axes.

"""


COLUMNS = (
    "rate",
    "complete",
    "short",
    "stopped",
    "put down to this computer",
    "**unexplained**",
    "missing: median, worst",
    "missed: median, worst",
    "lateness: median",
    "99 %",
    "worst",
)


@dataclass(frozen=True)
class Soaked:
    """One run.

    Attributes
    ----------
    rate_hz : int
    exit_status : int or None
        None of a run that did not end.
    message : str
        Error of a run that did not succeed, else samples and missed cycles.
    missing, missed : int
        Samples missing from a complete record, and SYNCs left out.
    woken : ndarray
        When sleeping threads of this process, one a processor, woke (monotonic, s) and how late (s), shape (n, 2).
    lines : tuple of (float, str)
        What the controller printed on stderr, each line with its time (monotonic, s).
    """

    rate_hz: int
    exit_status: int | None
    message: str
    missing: int
    missed: int
    woken: NDArray[np.float64]
    lines: tuple[tuple[float, str], ...] = ()

    @property
    def late_ms(self) -> NDArray[np.float64]:
        """Lateness during the run, ms."""
        return 1e3 * self.woken[:, 1]

    @property
    def late_at_fault_ms(self) -> float:
        """Largest lateness at the time of the fault, ms."""
        said_s = next((at_s for at_s, line in self.lines if STOPS in line), None)
        if said_s is None:
            said_s = next((at_s for at_s, line in self.lines if line.startswith("error: ")), self.woken[-1, 0])
        since_s = said_s - SHOWN_S - LOOKED_BACK_S - SYNCS_TO_FIND / self.rate_hz
        # A thread that wakes late within the window was kept waiting until then.
        return 1e3 * float(self._late_between(since_s, said_s).max(initial=0.0))

    @property
    def is_explained(self) -> bool:
        """Whether lateness of this computer explains that the run did not end complete."""
        if not self.is_short:
            return self.late_at_fault_ms >= 500.0 / self.rate_hz
        moving = [at_s for at_s, line in self.lines if " ms/cycle, " in line]
        late_s = self._late_between(moving[0], self.lines[-1][0]) if moving else np.empty(0)
        delays = np.ceil(late_s[late_s >= 0.5 / self.rate_hz] * self.rate_hz)
        lost = re.search(r"(\d+) of \d+ planned samples are missing", self.message)
        return lost is not None and int(lost[1]) <= float((delays + COST_SYNCS).sum())

    def _late_between(self, since_s: float, until_s: float) -> NDArray[np.float64]:
        at_s, late_s = self.woken.T
        late: NDArray[np.float64] = late_s[(at_s >= since_s) & (at_s - late_s <= until_s)]
        return late

    @property
    def is_short(self) -> bool:
        """Whether the run was driven to its end, but its record lacks too many samples."""
        return self.exit_status == 1 and "planned samples are missing" in self.message

    def __str__(self) -> str:
        median, most, worst = np.percentile(self.late_ms, [50.0, 99.0, 100.0])
        return f"{self.rate_hz} Hz: {self.message} (lateness {median:.1f}, {most:.1f}, {worst:.1f} ms)"


@contextmanager
def compiling() -> Iterator[None]:
    """Compile the engine into a scratch directory, again and again, one process a core."""
    end = threading.Event()
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run(["cmake", "-S", str(ROOT), "-B", scratch, *CONFIGURE], check=True, capture_output=True)
        build = ["cmake", "--build", scratch, "--parallel", str(cores()), "--clean-first"]

        def compile_again() -> None:
            while not end.is_set():
                with subprocess.Popen(build, stdout=subprocess.DEVNULL, start_new_session=True) as process:
                    while process.poll() is None and not end.wait(0.2):
                        pass
                    if process.poll() is None:
                        os.killpg(process.pid, signal.SIGTERM)

        thread = threading.Thread(target=compile_again)
        thread.start()
        try:
            yield
        finally:
            end.set()
            thread.join()


def cores() -> int:
    """Return the number of processors of this computer that may be used."""
    return len(os.sched_getaffinity(0))


def soak(runs: int) -> Iterator[Soaked]:
    """Yield the outcome of `runs` runs at each rate."""
    with tempfile.TemporaryDirectory() as name:
        for number in range(runs):
            for rate_hz in RATES_HZ:
                yield _one(Path(name), rate_hz, number)


def _one(folder: Path, rate_hz: int, seed: int) -> Soaked:
    truth, record = prepared(folder), folder / RECORD
    with _rig_that_never_waits(truth, seed) as bus, _lateness() as late_s:
        words = ["--plan", str(folder / "plan.toml"), "--bus", bus, "--yes", "--rate", str(rate_hz)]
        words += ["--realtime", "--overwrite", "-o", str(record)]
        status, out, lines = _run_and_listen(command_line(words))
    woken = np.array(late_s).reshape(-1, 2)
    if status is None:
        last = f", last heard: {lines[-1][1]}" if lines else ", before its first line"
        return Soaked(rate_hz, None, f"not ended after {LONGEST_S:g} s{last}", 0, 0, woken, lines)
    if status:
        message = (lines[-1][1] if lines else "").replace(f"{folder}/", "").removeprefix("error: ")
        return Soaked(rate_hz, status, message, 0, 0, woken, lines)
    said = SUMMARY.search(out)
    if said is None:
        raise RuntimeError(f"hexdbb-run printed: {out}")
    kept, planned, missed = map(int, said.groups())
    return Soaked(rate_hz, 0, said[0], planned - kept, missed, woken, lines)


def _run_and_listen(words: Sequence[str]) -> tuple[int | None, str, tuple[tuple[float, str], ...]]:
    """Run the command; return its exit status, what it printed, and every line of stderr with its time (s)."""
    lines: list[tuple[float, str]] = []
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        stderr = process.stderr
        listening = threading.Thread(
            target=lambda: lines.extend((time.monotonic(), line.rstrip()) for line in stderr), daemon=True
        )
        listening.start()
        timer = threading.Timer(LONGEST_S, process.kill)
        timer.start()
        out = process.stdout.read()
        status = process.wait()
        ended = timer.is_alive()
        timer.cancel()
        listening.join()
    return status if ended else None, out, tuple(lines)


@contextmanager
def _rig_that_never_waits(truth: Path, seed: int) -> Iterator[str]:
    """Serve a rig that no compiler keeps waiting: real nodes have processors of their own. Yield its bus."""
    command = [sys.executable, "-m", "hexdbb.cli", "rig", "--exit-with-parent", "--truth", str(truth)]
    with subprocess.Popen(
        [*command, "--seed", str(seed)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as process:
        try:
            assert process.stdout is not None
            address = process.stdout.readline().split()[-1]
            with suppress(PermissionError):
                _real_time(process.pid)
            yield f"socketcand:{address}"
        finally:
            process.terminate()


def _real_time(pid: int) -> None:
    """Set for a process, or this thread (0), the scheduling that the controller requests for itself."""
    os.sched_setscheduler(pid, os.SCHED_FIFO, os.sched_param(FIFO_PRIORITY))


@contextmanager
def _lateness() -> Iterator[list[tuple[float, float]]]:
    """Measure on every processor when a thread wakes and how late, s, for the length of the context.

    A hypervisor suspends processors one by one: a thread that may move says nothing of the one that the rig waits for.
    """
    end, late_s = threading.Event(), list[tuple[float, float]]()

    def measure(processor: int) -> None:
        os.sched_setaffinity(0, {processor})
        with suppress(PermissionError):
            _real_time(0)
        while not end.is_set():
            due_s = time.monotonic() + SLEEP_S
            time.sleep(SLEEP_S)
            now_s = time.monotonic()
            late_s.append((now_s, now_s - due_s))

    threads = [threading.Thread(target=measure, args=(each,), daemon=True) for each in os.sched_getaffinity(0)]
    for thread in threads:
        thread.start()
    try:
        yield late_s
    finally:
        end.set()
        for thread in threads:
            thread.join()


def report(runs: int, table: Path | None) -> int:
    """Run, print every run, write the page; return the number of runs without a complete record."""
    before, found = os.getloadavg()[0], list[Soaked]()
    with compiling():
        for each in soak(runs):
            found.append(each)
            print(each, flush=True)
        after = os.getloadavg()[0]
    text = page(found, runs, before, after)
    print(text)
    if table is not None:
        write_text(table, text)
    return sum(each.exit_status != 0 for each in found)


def page(found: Sequence[Soaked], runs: int, load_before: float, load_after: float) -> str:
    """Return the page of the soak."""
    computer = f"{platform.machine()}, {platform.system()}"
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(FIFO_PRIORITY))
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
        granted = "granted"
    except PermissionError:
        granted = "not granted on this computer"
    rule = {"looked_back": 1e3 * LOOKED_BACK_S, "syncs": SYNCS_TO_FIND, "cost": COST_SYNCS}
    head = {**rule, "runs": runs, "computer": computer, "cores": cores(), "granted": granted}
    lines = [HEAD.format(before=load_before, after=load_after, **head)]
    lines.append(f"| {' | '.join(COLUMNS)} |\n|{'---|' * len(COLUMNS)}\n")
    for rate_hz in RATES_HZ:
        of_rate = [each for each in found if each.rate_hz == rate_hz]
        complete = [each for each in of_rate if each.exit_status == 0]
        median, most, worst = np.percentile(np.concatenate([each.late_ms for each in of_rate]), [50.0, 99.0, 100.0])
        cells = (
            f"{rate_hz} Hz",
            f"{len(complete)} of {len(of_rate)}",
            str(sum(each.is_short for each in of_rate)),
            str(sum(each.exit_status != 0 and not each.is_short for each in of_rate)),
            str(sum(each.exit_status != 0 and each.is_explained for each in of_rate)),
            f"**{sum(each.exit_status != 0 and not each.is_explained for each in of_rate)}**",
            _middle_and_worst([each.missing for each in complete]),
            _middle_and_worst([each.missed for each in complete]),
            f"{median:.2f} ms",
            f"{most:.1f} ms",
            f"{worst:.0f} ms",
        )
        lines.append(f"| {' | '.join(cells)} |\n")
    stopped = [each for each in found if each.exit_status != 0]
    if stopped:
        lines.append(
            "\n## Runs that did not end complete\n\nLateness in the run: 99 %, worst; at the time of the fault: worst."
            "\n\n| rate | lateness in this run | at the fault | put down to | message |\n|---|---|---|---|---|\n"
        )
        for each in stopped:
            most, worst = np.percentile(each.late_ms, [99.0, 100.0])
            at_fault = "–" if each.is_short else f"{each.late_at_fault_ms:.0f} ms"
            cause = "this computer" if each.is_explained else "**unexplained**"
            message = each.message.replace("|", "\\|")
            lines.append(f"| {each.rate_hz} Hz | {most:.1f}, {worst:.0f} ms | {at_fault} | {cause} | {message} |\n")
    return "".join(lines)


def _middle_and_worst(counts: Sequence[int]) -> str:
    return f"{np.median(counts):.0f}, {max(counts)}" if counts else "–"
