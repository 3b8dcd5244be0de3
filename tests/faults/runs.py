"""One run of `hexdbb-run` on the simulated rig with a fault between them or in the rig."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path

from tests.circle_plan import circle_plan
from tests.faults.bus_log import BusLog
from tests.faults.proxy import proxied
from tests.faults.transformations import Rule
from tests.rigs import rig_in_thread

from hexdbb.capture.realtime import FIFO_PRIORITY
from hexdbb.capture.simulated import simulated_rig
from hexdbb.cli.run import command
from hexdbb.errors import HexdbbError
from hexdbb.record import Record, read_record

RATE_HZ = 50.0
"""Cycles in a second: slow, so that a desktop's stalls of some 20 ms to 50 ms do not end a run in real time, and a run
in lockstep takes a second."""
RECORD = "run.parquet"
PLAN = circle_plan("noise_um = 0.1, resolution_um = 0.1")
"""One circle: 7 s of machine time, 209 samples at `RATE_HZ`. Fast, so that the reading and the positions differ from
one SYNC to the next by far more than the noise, and a sample that belongs to another SYNC is seen."""
TRUTH = """
schema = "hexdbb.truth/1"
gauge = {noise_um = 0.1, resolution_um = 0.1}
geometry = {leg_length_um = [60, -40, 90, -120, 30, 50], slider_offset_um = [-70, 20, 40, 0, -50, 80]}
setup = {cup_error_um = [[90, -60, 40]]}
start = {position_mm = [99, 0, 280]}
"""
"""A machine with errors of 0.1 mm: circular deviations of some 0.1 mm. It starts beside its circle, to save time."""
FIRST_SAMPLE_S, LAST_SAMPLE_S = 3.5, 7.2
"""Machine time since the drives were enabled between which the circle is captured, s, a little inside."""
DEADLINE_S = 40.0
"""Longest time of a run, s: real time needs 10 s, and lockstep with one answer in ten lost 15 s; a run that has not
ended after this has hung."""


@dataclass(frozen=True)
class Run:
    """What came of one run.

    Attributes
    ----------
    exit_status : int
        Of `hexdbb-run`; 0 only for a complete record.
    message : str
        Its message without ``error:``, empty if there was none.
    record : Record or None
        The record it wrote.
    log : BusLog
        What the nodes received and answered.
    fired : int
        Frames transformed.
    duration_s : float
        Wall-clock time, s.
    """

    exit_status: int
    message: str
    record: Record | None
    log: BusLog
    fired: int
    duration_s: float


def run(
    folder: Path,
    rules: Sequence[Rule] = (),
    rig_faults: Sequence[str] = (),
    *,
    lockstep: bool = True,
    seed: int = 0,
    plan: str = PLAN,
) -> Run:
    """Run the plan with faults.

    Parameters
    ----------
    folder : Path
        Receives plan, truth and record.
    rules : sequence of Rule
        Faults of the proxy.
    rig_faults : sequence of str
        Faults of the rig, as ``hexdbb rig --fault`` takes them.
    lockstep : bool
        In lockstep all is done in this process; in real time rig and controller are processes of their own.
    seed : int
        Seed of the gauge's noise and of random transformations.
    plan : str
        The plan.
    """
    truth, record = prepared(folder, plan), folder / RECORD
    begin_s = time.monotonic()
    rig = (rig_in_thread if lockstep else rig_in_process)(*rig_options(truth, rig_faults, seed))
    pace = nullcontext() if lockstep else never_waiting()
    with pace, rig as port, proxied(port, [rule.fresh(rule.at_s) for rule in rules], 1 / RATE_HZ, seed) as proxy:
        status, message = (_called if lockstep else _started)(options(folder, proxy.bus, lockstep))
        duration_s = time.monotonic() - begin_s
    found = read_record(record) if record.exists() else None
    return Run(status, message, found, proxy.log, proxy.fired, duration_s)


@contextmanager
def never_waiting() -> Iterator[None]:
    """Schedule this process, and what it starts, as the controller, where the system grants it.

    Real nodes and a real bus do not wait for the other programs of a computer.
    """
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(FIFO_PRIORITY))
    except PermissionError:
        yield
        return
    try:
        yield
    finally:
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def prepared(folder: Path, plan: str = PLAN) -> Path:
    """Write plan and truth into a folder and return the truth."""
    (folder / "plan.toml").write_text(plan)
    truth = folder / "truth.toml"
    truth.write_text(TRUTH)
    return truth


def options(folder: Path, bus: str, lockstep: bool) -> list[str]:
    """Return the options of ``hexdbb-run`` for the plan in a folder."""
    words = ["--plan", folder / "plan.toml", "-o", folder / RECORD, "--bus", bus, "--yes", "--rate", RATE_HZ]
    return [*map(str, words), "--lockstep" if lockstep else "--realtime"]


def command_line(words: Sequence[str]) -> list[str]:
    """Return the command line of ``hexdbb-run`` as a process of its own."""
    return [sys.executable, "-c", "from hexdbb.cli.run import main; main()", *words]


def rig_options(truth: Path, faults: Sequence[str], seed: int) -> list[str]:
    """Return the options of ``hexdbb rig``."""
    return ["--truth", str(truth), "--seed", str(seed), *(word for fault in faults for word in ("--fault", fault))]


@contextmanager
def rig_in_process(*options: str) -> Iterator[int]:
    """Serve a rig in a process of its own and yield its port."""
    with simulated_rig(options) as bus:
        yield int(bus.rpartition(":")[2])


def _called(words: list[str]) -> tuple[int, str]:
    """Call the command in this process; a run that hangs counts as exit status -1."""
    outcome: list[tuple[int, str]] = []

    def call() -> None:
        try:
            command.main(words, standalone_mode=False)
            outcome.append((0, ""))
        except HexdbbError as error:
            outcome.append((error.exit_status, str(error)))
        except BaseException as error:  # an exception that users would see as a traceback
            outcome.append((70, f"{type(error).__name__}: {error}"))

    thread = threading.Thread(target=call, name="hexdbb-run", daemon=True)
    thread.start()
    thread.join(DEADLINE_S)
    return outcome[0] if outcome else (-1, f"not ended after {DEADLINE_S:g} s")


def _started(words: list[str]) -> tuple[int, str]:
    """Start the command as a process of its own; a run that hangs counts as exit status -1."""
    try:
        done = subprocess.run(command_line(words), capture_output=True, text=True, timeout=DEADLINE_S)
    except subprocess.TimeoutExpired:
        return -1, f"not ended after {DEADLINE_S:g} s"
    said = done.stderr.strip().splitlines()
    begin = next((k for k, line in enumerate(said) if line.startswith("error: ")), None)
    if begin is not None:
        return done.returncode, "\n".join(said[begin:]).removeprefix("error: ")
    return done.returncode, said[-1] if done.returncode and said else ""
