"""How a table of samples is made: of records, or of circles yet to be run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.kinematics import engine_machine, inverse, status_name
from hexdbb.machine import MachineFile
from hexdbb.model import MountKey, OwnEffect, Tabulated
from hexdbb.plan import CircleRun
from hexdbb.record import Record
from hexdbb.samples.state import planned_columns, state_columns
from hexdbb.samples.swing import DERIVED, derived_columns

Floats = NDArray[np.float64]
Columns = dict[str, NDArray[Any]]

PLANNED = "planned"
"""Takes the place of a record's hash in the mounts of a plan, of which no record exists."""


@dataclass(eq=False)
class Whole:
    """All samples of a table: their columns by name, and what was computed from them already."""

    machine: MachineFile
    records: tuple[Record, ...]
    set_ups: tuple[_core.SetUp, ...]
    mounts: tuple[MountKey, ...]
    columns: Columns
    state: Columns
    """Those of the columns that belong to the engine's state."""
    origin: str
    """What errors call it."""
    tabulated: dict[OwnEffect, Tabulated] = field(default_factory=dict)
    shaped: dict[OwnEffect, tuple[bytes, Tabulated]] = field(default_factory=dict)
    """Effects with shape parameters, evaluated at the values of which these are the bytes."""
    blocks: dict[tuple[MountKey, ...], _core.Samples] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.columns["set_up"])

    def column(self, name: str) -> NDArray[Any] | None:
        """Return a column, None where there is no such; those of `DERIVED` are computed when first asked for."""
        if name in DERIVED and name not in self.columns:
            self.columns |= derived_columns(self.machine, self.columns)
        return self.columns.get(name)

    def block(self, mounts: tuple[MountKey, ...]) -> _core.Samples:
        """Return the engine's form, mounts numbered as in `mounts`; those not among them count as the first."""
        if mounts not in self.blocks:
            place = {key: index for index, key in enumerate(mounts)}
            number = np.array([place.get(key, 0) for key in self.mounts], np.int32)
            self.blocks[mounts] = _core.Samples(
                sliders_mm=self.columns["sliders_mm"],
                set_up=self.columns["set_up"],
                mount=number[self.columns["mount"]],
                set_ups=list(self.set_ups),
                state=self.state,
            )
        return self.blocks[mounts]


def of_records(records: Sequence[Record]) -> Whole:
    """Build the table of some records, one after another.

    Raises
    ------
    InputError
        No record, one without samples, or records of different machines.
    """
    if not records:
        raise InputError("no record (expected at least one)")
    for record in records:
        if not len(record):
            raise InputError(f"{record.name}: no samples (expected at least one)")
    for record in records[1:]:
        record.require_machine(records[0].machine, records[0].name)
    set_ups: list[_core.SetUp] = []
    keys: list[MountKey] = []
    set_up_rows, record_rows = [], []
    for index, record in enumerate(records):
        circle_ids, member = np.unique(record.columns["circle"], return_inverse=True)
        set_up_rows.append(len(set_ups) + member)
        record_rows.append(np.full(len(record), index))
        content = record.content_hash()
        for circle in (record.circle(int(each)) for each in circle_ids):
            keys.append(MountKey(content, circle.mount))
            cup_mm = record.mount(circle.mount).cup_mm
            set_ups.append(_set_up(cup_mm, circle.ball_offset_mm, record.gauge.bar_length_mm))
    columns: Columns = {
        "record": np.concatenate(record_rows),
        "set_up": np.concatenate(set_up_rows),
        "sliders_mm": np.vstack([record.sliders_mm for record in records]),
        "reading_mm": np.concatenate([record.reading_mm for record in records]),
    }
    origin = ", ".join(record.name for record in records)
    return _completed(records[0].machine, tuple(records), set_ups, keys, columns, state_columns(records), origin)


def of_runs(
    machine: MachineFile,
    runs: Sequence[CircleRun],
    angle_rad: Floats,
    bar_length_mm: float,
    origin: str = "plan",
    warming_k: Floats | None = None,
) -> Whole:
    """Build the table of one lap of each of some runs, as the nominal machine would drive them (`Samples.planned`)."""
    count = len(angle_rad) * len(runs)
    columns: Columns = {
        "record": np.zeros(count, np.int64),
        "set_up": np.repeat(np.arange(len(runs)), len(angle_rad)),
        "sliders_mm": np.vstack([_sliders_mm(machine, run, angle_rad, origin) for run in runs]),
        "reading_mm": np.full(count, np.nan),
    }
    set_ups = [_set_up(run.mount.cup_mm, run.circle.ball_offset_mm, bar_length_mm) for run in runs]
    state = planned_columns(runs, angle_rad)
    if warming_k is not None:
        state["warming_k"] = warming_k
    keys = [MountKey(PLANNED, run.mount.id) for run in runs]
    return _completed(machine, (), set_ups, keys, columns, state, origin)


def _completed(
    machine: MachineFile,
    records: tuple[Record, ...],
    set_ups: Sequence[_core.SetUp],
    keys: Sequence[MountKey],
    columns: Columns,
    state: Columns,
    origin: str,
) -> Whole:
    """Complete the columns: mounts (`keys` are those of the set-ups), and all that follows from the motion."""
    mounts = tuple(dict.fromkeys(keys))
    of_set_up = np.array([mounts.index(key) for key in keys])
    columns["set_up"] = columns["set_up"].astype(np.int32)
    columns["mount"] = of_set_up[columns["set_up"]].astype(np.int32)
    block = _core.Samples(
        sliders_mm=columns["sliders_mm"],
        set_up=columns["set_up"],
        mount=columns["mount"],
        set_ups=list(set_ups),
        state=state,
    )
    block.derive(engine_machine(machine))
    derived: Columns = block.state
    return Whole(
        machine, records, tuple(set_ups), mounts, {**columns, **derived}, derived, origin, blocks={mounts: block}
    )


def _sliders_mm(machine: MachineFile, run: CircleRun, angle_rad: Floats, origin: str) -> Floats:
    circle, along = run.circle, run.direction * angle_rad
    sliders_mm, status = inverse(machine, circle.poses(along, run.mount.cup_mm), circle.platform_rpy_rad)
    if status.any():
        row = int(np.flatnonzero(status)[0])
        place = f"{origin}: circle {circle.id} at {np.degrees(along[row]) % 360.0:.0f} deg"
        raise InputError(f"{place}: {status_name(int(status[row]))} (expected a circle within reach)")
    return sliders_mm


def _set_up(cup_mm: Sequence[float], ball_offset_mm: Sequence[float], bar_length_mm: float) -> _core.SetUp:
    return _core.SetUp(cup_mm=np.array(cup_mm), ball_offset_mm=np.array(ball_offset_mm), bar_length_mm=bar_length_mm)
