"""A fault tried: one run, judged against the fault-free run of the same seed and against what the fault requires."""

from __future__ import annotations

import random
import re
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from tests.faults.catalogue import FAULTS, Fault
from tests.faults.judging import wrong_samples
from tests.faults.runs import FIRST_SAMPLE_S, LAST_SAMPLE_S, RATE_HZ, Run, run

ATTEMPTS = 3
"""Runs in real time until one reaches the fault: a desktop stalls the simulated rig now and then for longer than the
three SYNCs that a node may leave unanswered, which says nothing about the fault."""
STALLED = "this computer stalled every run"
BLAMES_COMPUTER = "this computer: was "
"""Beginning of the message of a run that this computer has ended by being late (`hexdbb.capture.blame`)."""
TRACEBACK = 70
LONGEST_STOP_MS = 5000.0
"""Wall-clock time from a fault to the quick stop, ms: in lockstep a node is silent after three waits of 0.25 s, and the
computer may be busy."""


@dataclass(frozen=True)
class Trial:
    """What came of a fault, or of several at once.

    Attributes
    ----------
    names : tuple of str
        Faults.
    lockstep : bool
    when, how_often : str
    exit_status : int
    message : str
    kept : int
        Samples in the record.
    lost : int
        Samples missing: of the whole plan if the run ended complete, else of those before the fault.
    wrong : int
        Samples kept that are wrong.
    stop_cycles, stop_ms : float or None
        From the fault to the quick stop of all six drives; None if they did not receive one.
    attempts : int
        Runs that it took, see `ATTEMPTS`.
    unmet : tuple of str
        What was required and is not so.
    """

    names: tuple[str, ...]
    lockstep: bool
    when: str
    how_often: str
    exit_status: int
    message: str
    kept: int
    lost: int
    wrong: int
    stop_cycles: float | None
    stop_ms: float | None
    attempts: int
    unmet: tuple[str, ...]


@cache
def reference(seed: int) -> Run:
    """Return the fault-free run of a seed, in lockstep; real time gives the same samples.

    Raises
    ------
    RuntimeError
        Even without a fault the run did not succeed.
    """
    with tempfile.TemporaryDirectory() as folder:
        clean = run(Path(folder), seed=seed)
    if clean.exit_status or clean.record is None:
        raise RuntimeError(f"the run without a fault ended with {clean.exit_status}: {clean.message}")
    return clean


def try_faults(faults: Sequence[Fault], *, lockstep: bool, seed: int) -> Trial:
    """Run with faults and judge the outcome."""
    attempts = 0
    while True:
        attempts += 1
        with tempfile.TemporaryDirectory() as folder:
            rules = [rule for fault in faults for rule in fault.rules(lockstep)]
            rig_faults = [spec for fault in faults for spec in fault.rig]
            done = run(Path(folder), rules, rig_faults, lockstep=lockstep, seed=seed)
        done = replace(done, message=done.message.replace(folder, ""))
        if lockstep or _reached(faults, done) or attempts == ATTEMPTS:
            return judged(faults, done, lockstep, seed, attempts)


def _reached(faults: Sequence[Fault], done: Run) -> bool:
    """Return whether a run lasted until the moment of its faults, and was not ended by this computer."""
    cycles = done.log.since_enabled or 0
    return not done.message.startswith(BLAMES_COMPUTER) and all(
        fault.begins_s == 0.0
        # The SYNC in which a connection ends does not reach the proxy's log.
        or (cycles + fault.cuts_off) / RATE_HZ >= fault.begins_s
        for fault in faults
    )


def judged(faults: Sequence[Fault], done: Run, lockstep: bool, seed: int, attempts: int = 1) -> Trial:
    """Return the trial that a run was."""
    clean = reference(seed).record
    assert clean is not None
    begins_s = min(fault.begins_s for fault in faults)
    wrong = wrong_samples(done.record, clean, done.log if any(fault.moves_machine for fault in faults) else None)
    kept = 0 if done.record is None else len(done.record)
    due = len(clean) if done.exit_status == 0 else int((clean.columns["t_s"] < begins_s - 2 / RATE_HZ).sum())
    stop = done.log.time_to_stop(begins_s, 1 / RATE_HZ) if done.exit_status else None
    stop_ms = 1e3 * stop[1] if stop else None
    return Trial(
        names=tuple(fault.name for fault in faults),
        lockstep=lockstep,
        when="; ".join(fault.when for fault in faults),
        how_often="; ".join(fault.how_often for fault in faults),
        exit_status=done.exit_status,
        message=done.message,
        kept=kept,
        lost=max(due - kept, 0),
        wrong=len(wrong),
        stop_cycles=stop[0] if stop else None,
        stop_ms=stop_ms,
        attempts=attempts,
        unmet=tuple(_unmet(faults, done, lockstep, len(wrong), len(clean), stop_ms)),
    )


def _unmet(
    faults: Sequence[Fault], done: Run, lockstep: bool, wrong: int, planned: int, stop_ms: float | None
) -> list[str]:
    """Return what was required and is not so."""
    if not lockstep and not _reached(faults, done):
        return [STALLED]
    unmet = []
    if wrong:
        unmet.append(f"{wrong} wrong samples kept")
    if done.exit_status == -1:
        unmet.append("the run hung")
    if done.exit_status == TRACEBACK or "Traceback" in done.message:
        unmet.append("traceback")
    if "\n" in done.message:
        unmet.append("message of several lines")
    if len(faults) == 1 and faults[0].rules(lockstep) and not done.fired:
        unmet.append("the fault did not act")
    if done.exit_status == 0:
        if not all(fault.may_pass or fault.must_pass for fault in faults):
            unmet.append("the fault went unnoticed")
        if done.record is None or not done.record.complete:
            unmet.append("no complete record")
        elif len(done.record) < 0.95 * planned:
            unmet.append("many samples are missing from a record said to be complete")
    else:
        if all(fault.must_pass for fault in faults):
            unmet.append("the run need not have ended")
        if not any(re.match(fault.cause, done.message) for fault in faults):
            unmet.append("the message does not begin with the cause")
        if done.log.enabled_at is not None and not any(fault.cuts_off for fault in faults):
            if done.log.stopped_at is None and not done.log.disabled:
                unmet.append("the drives received no quick stop")
            elif stop_ms is not None and stop_ms > LONGEST_STOP_MS:
                unmet.append(f"the quick stop came after {stop_ms:.0f} ms")
            elif not done.log.standing():
                unmet.append("an axis still moved at the end")
        if done.record is not None and done.record.complete:
            unmet.append("the record is marked complete")
    return unmet


def random_pairs(count: int, seed: int) -> list[tuple[Fault, Fault]]:
    """Return pairs of faults drawn at random, each fault at a random moment of the capture."""
    rng = random.Random(seed)
    pairs = []
    for _ in range(count):
        first, second = rng.sample(FAULTS, 2)
        pairs.append((first.at(_moment(rng)), second.at(_moment(rng))))
    return pairs


def _moment(rng: random.Random) -> float:
    return round(rng.uniform(FIRST_SAMPLE_S, LAST_SAMPLE_S), 2)
