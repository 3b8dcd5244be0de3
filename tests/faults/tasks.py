"""Trials made in a few processes: what a process is told, and what it must not print."""

from __future__ import annotations

import multiprocessing
import os
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from tests.faults.catalogue import fault_named
from tests.faults.kills import Kill, kill, random_shares
from tests.faults.page import line
from tests.faults.trials import Trial, random_pairs, try_faults


@dataclass(frozen=True)
class Task:
    """A trial to be made; faults are given by name, or by the number of a random pair."""

    name: str | None
    pair: int
    lockstep: bool
    seed: int

    def trial(self) -> Trial:
        """Make the trial."""
        if self.name is not None:
            return try_faults([fault_named(self.name)], lockstep=self.lockstep, seed=self.seed)
        return try_faults(random_pairs(self.pair + 1, self.seed)[-1], lockstep=self.lockstep, seed=self.seed)


def made(tasks: Sequence[Task], jobs: int) -> list[Trial]:
    """Make trials in a few processes, in the order of the tasks."""
    trials = []
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, context, initializer=_silence) as pool:
        for trial in pool.map(Task.trial, tasks):
            print(line(trial), flush=True)
            trials.append(trial)
    return trials


def killed(count: int, seed: int, jobs: int) -> list[Kill]:
    """Kill runs at random moments, in a few processes."""
    kills = []
    with ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn"), initializer=_silence) as pool:
        for made_kill in pool.map(kill, random_shares(count, seed), [seed] * count):
            print(made_kill, flush=True)
            kills.append(made_kill)
    return kills


def _silence() -> None:
    """Drop what the runs of this process print."""
    sys.stdout = sys.stderr = Path(os.devnull).open("w")  # noqa: SIM115
