"""`hexdbb-run` killed (SIGKILL) at random moments of a run in lockstep: what is left, and how much is missing.

Required: at most one second of samples is lost, `hexdbb recover` makes a record of what is left, or the same command
runs again, without anything done by hand; every sample equals the same sample of a run that was not killed.
"""

from __future__ import annotations

import random
import subprocess
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tests.faults.bus_log import BusLog
from tests.faults.judging import wrong_samples
from tests.faults.proxy import proxied
from tests.faults.runs import PLAN, RATE_HZ, RECORD, Run, command_line, options, prepared, rig_options, run
from tests.rigs import rig_in_thread

from hexdbb.cli.recover import command as recover_command
from hexdbb.errors import HexdbbError
from hexdbb.record import Record, journal_path, read_record

LONG_PLAN = PLAN.replace("laps = 1", "laps = 8")
"""Eight laps: 1676 samples in some 3 s, of which at most one second may be lost."""
MOST_LOST_S = 1.0
"""Captured samples that a kill may cost, s of wall-clock time: the requirement of the journal."""
LONGEST_RUN_S = 60.0
"""Time after which a run is killed in any case, s: it takes 4 s, more on a busy computer."""
ATTEMPTS = 3
"""Runs until one without a kill succeeds: with a dozen other processes waiting for two cores, enabling takes longer
than its 2 s now and then."""
MARGIN = 1.05
"""Latest moment of a kill, as a share of the SYNCs of a run that is not killed: some come too late."""


@dataclass(frozen=True)
class Kill:
    """What a kill left.

    Attributes
    ----------
    share : float
        Moment of the kill, as a share of the run.
    captured, kept : int
        Samples answered by the nodes until `MOST_LOST_S` before the kill, and samples in the record.
    wrong : int
        Samples kept that differ from the run that was not killed.
    way : str
        How the record was come by: ``recovered``, ``complete``, ``nothing captured``, ``run again``.
    unmet : tuple of str
        What was required and is not so.
    """

    share: float
    captured: int
    kept: int
    wrong: int
    way: str
    unmet: tuple[str, ...]

    def __str__(self) -> str:
        verdict = ", ".join(self.unmet) or "as required"
        counts = f"{self.captured} samples older than {MOST_LOST_S:g} s, {self.kept} kept, {self.wrong} wrong"
        return f"killed at {self.share:.0%}: {self.way}, {counts}: {verdict}"


def random_shares(count: int, seed: int) -> list[float]:
    """Return random moments of kills, as shares of a run."""
    rng = random.Random(seed)
    return [MARGIN * rng.random() for _ in range(count)]


def kill(share: float, seed: int, *, with_journal: bool = False) -> Kill:
    """Kill a run and judge what is left.

    Parameters
    ----------
    share : float
        Moment of the kill, as a share of the SYNCs of a run that is not killed.
    seed : int
        Seed of the gauge's noise.
    with_journal : bool
        Whether to wait for the journal to be there first, which then holds nothing yet.
    """
    whole = whole_run(seed)
    assert whole.record is not None
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        truth = prepared(folder, LONG_PLAN)
        with rig_in_thread(*rig_options(truth, (), seed)) as port, proxied(port, (), 1 / RATE_HZ) as proxy:
            journal, syncs = journal_path(folder / RECORD), share * len(whole.log.cycles)
            due = journal.exists if with_journal else lambda: len(proxy.log.cycles) >= syncs
            killed_s = _run_and_kill(options(folder, proxy.bus, True), due)
            captured = _captured(whole.record, proxy.log, killed_s - MOST_LOST_S)
        way, record, problem = _saved(folder, truth, seed)
    kept = 0 if record is None else len(record)
    wrong = len(wrong_samples(record, whole.record))
    unmet = [problem] if problem else []
    if wrong:
        unmet.append(f"{wrong} wrong samples")
    if way != "run again" and kept < captured:
        unmet.append(f"{captured - kept} samples lost that were older than {MOST_LOST_S:g} s")
    return Kill(share, captured, kept, wrong, way, tuple(unmet))


@cache
def whole_run(seed: int) -> Run:
    """Return the run that is not killed; a computer busy enough may stop it twice."""
    for _ in range(ATTEMPTS):
        with tempfile.TemporaryDirectory() as folder:
            whole = run(Path(folder), seed=seed, plan=LONG_PLAN)
        if whole.exit_status == 0 and whole.record is not None:
            return whole
    raise RuntimeError(f"the run without a fault ended with {whole.exit_status}: {whole.message}")


def _run_and_kill(words: list[str], due: Callable[[], bool]) -> float:
    """Start the command, kill it when that is due, and return when that was (monotonic, s)."""
    process = subprocess.Popen(command_line(words), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline_s = time.monotonic() + LONGEST_RUN_S
    while not due() and process.poll() is None and time.monotonic() < deadline_s:
        time.sleep(0.001)
    process.kill()
    killed_s = time.monotonic()
    process.wait()
    return killed_s


def _captured(whole: Record, log: BusLog, until_s: float) -> int:
    """Return the number of samples that the nodes had answered until a time.

    The first SYNC after the drives have answered that they are enabled is the beginning of motion, from which a
    sample's time is counted.
    """
    if log.enabled_at is None:
        return 0
    answered = sum(cycle.time_s <= until_s for cycle in log.cycles[log.enabled_at :])
    return int((whole.columns["t_s"] * RATE_HZ < answered - 0.5).sum())


def _saved(folder: Path, truth: Path, seed: int) -> tuple[str, Record | None, str]:
    """Return how a record was come by, the record, and what went wrong."""
    path = folder / RECORD
    if path.exists():
        return "complete", read_record(path), ""
    journal = journal_path(path)
    if not journal.exists():
        return "nothing captured", None, _leftovers(folder)
    try:
        recover_command.main([str(journal)], standalone_mode=False)
        return "recovered", read_record(path), ""
    except HexdbbError as error:
        refused = str(error)
    with rig_in_thread(*rig_options(truth, (), seed)) as port, proxied(port, (), 1 / RATE_HZ) as proxy:
        process = subprocess.run(command_line(options(folder, proxy.bus, True)), capture_output=True, text=True)
    if process.returncode:
        last = (process.stderr.strip().splitlines() or [""])[-1]
        return "no way", None, f"recovery refused ({refused}), run refused ({last})".replace(str(folder), "")
    return "run again", read_record(path), ""


def _leftovers(folder: Path) -> str:
    left = sorted(path.name for path in folder.iterdir() if path.name not in ("plan.toml", "truth.toml"))
    return f"files left behind: {', '.join(left)}" if left else ""
