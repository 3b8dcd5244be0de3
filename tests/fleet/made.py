"""Records of a fleet whose faults are known: machines of random geometry, some with play in their screws.

A third of the machines has screws of one batch, with play in slider 2; on one machine of another batch the play of
slider 5 grows from month to month. Cup and ball are set up anew for each record.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import cache
from pathlib import Path

import numpy as np

from hexdbb.machine import MachineFile
from hexdbb.model import Choice, Model, new_model, save_model
from hexdbb.plan import Plan, load_plan
from hexdbb.record import Record, write_record
from hexdbb.rig.mechanisms import MECHANISMS, MechanismTable
from hexdbb.rig.truth import Setup, random_truth
from hexdbb_truth.simulate import Pace, simulate

BATCHES = ("A", "B", "C")
WEAK_BATCH, WEAK_SLIDER, WEAK_UM = "B", 2, 9.0
GROWING_MACHINE, GROWING_SLIDER, GROWTH_UM_YEAR = 0, 5, 12.0
STEADY_UM = 2.0
FIRST_DAY = datetime(2025, 1, 3, 8, tzinfo=UTC)
YEAR = timedelta(days=364)
CIRCLES = 3
PACES = {"small": Pace(6.0, 10, 2.0), "standard": Pace(11.4, 10, 2.0)}
"""How finely each plan is sampled: some 450 readings, some 20,000."""


@dataclass(frozen=True)
class Fleet:
    """Records of some machines over a year.

    Attributes
    ----------
    machines, records : int
        Records are divided among the machines evenly.
    plan : str
        ``small`` or ``standard``.
    """

    machines: int
    records: int
    plan: str = "small"

    @property
    def each(self) -> int:
        """Records of a machine."""
        return -(-self.records // self.machines)

    def file(self, number: int) -> str:
        """Name of a record: a folder a machine, a file a test, in the order of time."""
        return f"m{number // self.each:03d}/{number % self.each:05d}.parquet"

    def record(self, number: int) -> Record:
        """Measure a record."""
        machine, test = divmod(number, self.each)
        passed = test / max(self.each - 1, 1)
        truth = random_truth(machine).model_copy(
            update={"setup": set_up(number), "mechanism": mechanisms(machine, passed)}
        )
        found = simulate(truth, plan_of(self.plan), seed=number, pace=PACES[self.plan])
        found.machine = found.machine.model_copy(update={"serial_number": f"{machine:03d}"})
        started = FIRST_DAY + passed * YEAR
        found.metadata = {"started": started.isoformat(), "plan": self.plan, "batch": batch_of(machine)}
        return found

    def write(self, folder: Path, number: int) -> None:
        """Measure a record and write it into a folder, where it is not yet."""
        path = folder / self.file(number)
        if not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            write_record(self.record(number), path, checked=True)


def batch_of(machine: int) -> str:
    return BATCHES[machine % len(BATCHES)]


def mechanisms(machine: int, passed: float) -> tuple[MechanismTable, ...]:
    """Play of two sliders, after a part of the year."""
    weak = WEAK_UM if batch_of(machine) == WEAK_BATCH else STEADY_UM
    grown = STEADY_UM + (GROWTH_UM_YEAR * passed if machine == GROWING_MACHINE else 0.0)
    play = MECHANISMS["backlash"]
    return tuple(
        play.model_validate({"slider": slider, "width_um": width})
        for slider, width in ((WEAK_SLIDER, weak), (GROWING_SLIDER, grown))
    )


def set_up(number: int) -> Setup:
    draw = np.random.default_rng([zlib.crc32(b"set-up"), number])
    cups, ball = draw.normal(0.0, 50.0, (1, 3)), draw.normal(0.0, 20.0, 3)
    return Setup(cup_error_um=np.round(cups, 3).tolist(), ball_offset_error_um=np.round(ball, 3).tolist())


@cache
def plan_of(name: str) -> Plan:
    """Return `standard`, or three circles of it, one lap in both directions at the higher feed."""
    plan = load_plan("standard")
    if name == "standard":
        return plan
    return plan.model_copy(
        update={"circles": plan.circles[:CIRCLES], "laps": 1, "feeds_mm_min": plan.feeds_mm_min[-1:]}
    )


def machine_file() -> MachineFile:
    return plan_of("small").machine_file()


def play_model() -> Model:
    """Geometric errors, and play of every slider."""
    return new_model(machine_file()).with_effect(Choice("backlash"))


def write_model(path: Path) -> Path:
    save_model(play_model(), path)
    return path
