"""How a table of samples is made: of records, or of circles yet to be run."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.kinematics import engine_machine, inverse, status_name
from hexdbb.kinematics.screw import TURN, TURN_FROM, turns
from hexdbb.machine import MachineFile
from hexdbb.model import MountKey, OwnEffect, Tabulated
from hexdbb.plan import CircleRun
from hexdbb.record import Record
from hexdbb.record.columns import joined
from hexdbb.samples.course import COURSES, COURSES_FROM, courses
from hexdbb.samples.deflection import (
    DEFLECTION,
    DIRECTION_AND_TRAVEL,
    LEAST_TURN_MM,
    SCALE,
    TURNING,
    deflection_mm,
    scale_mm,
)
from hexdbb.samples.distinct import distinct_rows
from hexdbb.samples.feed import FEED_RATIOS, FEED_RATIOS_FROM, feed_ratios
from hexdbb.samples.fixings import mount_key, require_agreement
from hexdbb.samples.gap import GAPS, between
from hexdbb.samples.lean import LEANS, LEANS_FROM, leans
from hexdbb.samples.leg_columns import OF_LEGS, OF_LEGS_FROM, leg_columns
from hexdbb.samples.loads import LOADS, LOADS_FROM, load_columns
from hexdbb.samples.memory import remembered_column, remembered_of
from hexdbb.samples.neighbours import NEIGHBOURS, of_neighbours
from hexdbb.samples.power import POWER, POWER_FROM, power_mm2_s3
from hexdbb.samples.radius import RADIUS, RADIUS_FROM, radii_mm
from hexdbb.samples.reaction import REACTION, REACTION_FROM, carriages_acceleration_mm_s2
from hexdbb.samples.since_turn import TURNS_OF_LOADS, direction_and_travel, turns_of_load
from hexdbb.samples.state import Make, planned_columns, state_columns
from hexdbb.samples.swing import DERIVED, DERIVED_FROM, derived_columns
from hexdbb.samples.two_states import relay_column, relay_of

Floats = NDArray[np.float64]
Columns = dict[str, NDArray[Any]]

STATE = tuple(column.name for column in _core.state_columns() if column.name not in ("sliders_mm", "row"))
"""Columns of the engine's state that a table may have; the engine itself numbers the rows of a part."""
GIVEN = ("time_s", "sweep", "angle_rad")
"""Columns of the state from which, with the sliders, all that the engine derives follows."""
OF_GAUGE = (DEFLECTION, SCALE, *DIRECTION_AND_TRAVEL, TURNING)
"""Columns of the gauge."""
PLANNED = "planned"
"""Takes the place of a record's hash in the mounts of a plan, of which no record exists."""


@dataclass(eq=False)
class Whole:
    """All samples of a table: their columns by name, and what was computed from them already.

    Columns of the engine's state are made, or derived from others, when first asked for: a prediction of geometry needs
    none of them.
    """

    machine: MachineFile
    records: tuple[Record, ...]
    set_ups: tuple[_core.SetUp, ...]
    mounts: tuple[MountKey, ...]
    columns: Columns
    origin: str
    """What errors call it."""
    pending: dict[str, Make] = field(default_factory=dict)
    """Columns of the engine's state that records hold and that were not asked for yet."""
    tabulated: dict[OwnEffect, Tabulated] = field(default_factory=dict)
    shaped: dict[OwnEffect, tuple[bytes, Tabulated]] = field(default_factory=dict)
    """Effects with shape parameters, evaluated at the values of which these are the bytes."""
    blocks: dict[tuple[MountKey, ...], tuple[frozenset[str], _core.Samples]] = field(default_factory=dict)
    """The engine's form by the mounts' numbering, with the columns of the state that it holds."""

    def __len__(self) -> int:
        return len(self.columns["set_up"])

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all columns, derived already or not."""
        later = (
            *STATE,
            *DERIVED,
            *LOADS,
            *TURNS_OF_LOADS,
            *OF_LEGS,
            REACTION,
            *COURSES,
            *LEANS,
            *GAPS,
            POWER,
            *FEED_RATIOS,
            RADIUS,
            *NEIGHBOURS,
            *TURN,
            *OF_GAUGE,
        )
        # A copy: another thread may add a column meanwhile.
        return (*(name for name in tuple(self.columns) if name not in later), *later)

    def column(self, name: str) -> NDArray[Any] | None:
        """Return a column, None where there is no such; threads that ask at once both derive the same."""
        if name not in self.columns:
            # There are as many columns that remember as numbers in their names: none is kept.
            if (how := remembered_of(name)) is not None:
                return self._remembered(how["column"], how["how"], float(how["constant"]))
            if (relay := relay_of(name)) is not None:
                return self._relay(relay["column"], float(relay["low"]), float(relay["high"]))
            self._make(name)
        return self.columns.get(name)

    def _make(self, name: str) -> None:
        make = self.pending.get(name)
        if make is not None:
            self.columns[name] = make()
            self.pending.pop(name, None)
        elif name in STATE:
            self.columns |= self._derived_state(name)
        elif name in DERIVED:
            given = {each: column for each in DERIVED_FROM if (column := self.column(each)) is not None}
            self.columns |= derived_columns(self.machine, given, self.set_ups)
        elif name in LOADS:
            self.columns |= load_columns(*self._known(*LOADS_FROM))
        elif name in OF_LEGS:
            self.columns |= leg_columns(self.machine, *self._known(*OF_LEGS_FROM))
        elif name in TURNS_OF_LOADS:
            load = TURNS_OF_LOADS[name]
            self.columns |= turns_of_load(load, *self._known(load, "time_s", "sweep", "angle_rad"))
        elif name in COURSES:
            self.columns |= courses(*self._known(*COURSES_FROM))
        elif name in LEANS:
            self.columns |= leans(*self._known(*LEANS_FROM))
        elif name == REACTION:
            (acceleration,) = self._known(REACTION_FROM)
            self.columns[name] = carriages_acceleration_mm_s2(engine_machine(self.machine), acceleration)
        elif name in GAPS:
            self.columns[name] = between(*self._known(GAPS[name]))
        elif name == POWER:
            self.columns[name] = power_mm2_s3(*self._known(*POWER_FROM))
        elif name in FEED_RATIOS:
            self.columns |= feed_ratios(*self._known(FEED_RATIOS_FROM))
        elif name == RADIUS:
            self.columns[name] = radii_mm(*self._known(RADIUS_FROM))
        elif name in NEIGHBOURS:
            (own,) = self._known(NEIGHBOURS[name])
            self.columns[name] = of_neighbours(own)
        elif name in TURN:
            (sliders_mm,) = self._known(TURN_FROM)
            self.columns |= turns(sliders_mm, self.machine.sliders.screw_lead_mm)
        elif name == DEFLECTION:
            self.columns[name] = self._deflection_mm()
        elif name == SCALE:
            self.columns[name] = scale_mm(*self._known("reading_mm", "nominal_reading_mm"))
        elif name == TURNING:
            deflection_mm, direction = self._known(DEFLECTION, DIRECTION_AND_TRAVEL[0])
            self.columns[name] = deflection_mm * direction
        elif name in DIRECTION_AND_TRAVEL:
            deflection_mm, time_s, sweep, angle_rad = self._known(DEFLECTION, "time_s", "sweep", "angle_rad")
            found = direction_and_travel(deflection_mm, time_s, sweep, angle_rad, LEAST_TURN_MM)
            self.columns |= dict(zip(DIRECTION_AND_TRAVEL, found, strict=True))

    def _remembered(self, name: str, how: str, constant: float) -> Floats | None:
        if name not in self.names:
            return None
        return remembered_column(how, constant, *self._known(name, "time_s", "sweep", "angle_rad"))

    def _relay(self, name: str, low: float, high: float) -> Floats | None:
        if self.column(name) is None:
            return None
        return relay_column(low, high, *self._known(name, "time_s", "sweep", "angle_rad"))

    def block(self, mounts: tuple[MountKey, ...], needs: frozenset[str]) -> tuple[frozenset[str], _core.Samples]:
        """Return the engine's form with at least some columns of the state, and the names of those that it holds.

        Mounts are numbered as in `mounts`; those not among them count as the first. The engine copies what it is
        given, so it is given what a model needs.
        """
        held, block = self.blocks.get(mounts, (frozenset(), None))
        if block is None or not needs <= held:
            held = held | needs
            block = self._engine(mounts, held)
            self.blocks[mounts] = held, block  # another thread may put its own there
        return held, block

    def _engine(self, mounts: tuple[MountKey, ...], names: Iterable[str]) -> _core.Samples:
        """Return the engine's form; those of the columns that follow from others are derived in it, not copied there.

        Other columns that are found on the way are kept.
        """
        derived = [name for name in names if name in STATE and name not in self.columns and name not in self.pending]
        given = {*names, *GIVEN}.difference(derived) if derived else names
        place = {key: index for index, key in enumerate(mounts)}
        number = np.array([place.get(key, 0) for key in self.mounts], np.int32)
        block = _core.Samples(
            sliders_mm=self.columns["sliders_mm"],
            set_up=self.columns["set_up"],
            mount=number[self.columns["mount"]],
            set_ups=list(self.set_ups),
            state={name: column for name in given if (column := self.column(name)) is not None},
        )
        if derived:
            block.derive(engine_machine(self.machine), derived)
            for each in block.known:
                if each not in self.columns:
                    self.pending[each] = partial(block.column, each)
        return block

    def _known(self, *names: str) -> list[NDArray[Any]]:
        """Return columns that every table has."""
        return [column for each in names if (column := self.column(each)) is not None]

    def _deflection_mm(self) -> Floats:
        nominal_mm = self.column("nominal_reading_mm")
        assert nominal_mm is not None  # the engine derives it for every table
        _, block = self.block(self.mounts, frozenset())
        return deflection_mm(self.machine, self.mounts, block, self.columns["reading_mm"], nominal_mm)

    def _derived_state(self, name: str) -> Columns:
        """Return a column of the engine's state that follows from the given ones."""
        column = self._engine(self.mounts, (name,)).column(name)
        self.pending.pop(name, None)
        return {name: column}


def of_records(records: Sequence[Record]) -> Whole:
    """Build the table of some records, one after another.

    Raises
    ------
    InputError
        No record, one without samples, records of different machines, or of one fixing of the cup with different cups
        or bars.
    """
    if not records:
        raise InputError("no record (expected at least one)")
    for record in records:
        if not len(record):
            raise InputError(f"{record.name}: no samples (expected at least one)")
    for record in records[1:]:
        record.require_machine(records[0].machine, records[0].name)
    require_agreement(records)
    set_ups: list[_core.SetUp] = []
    keys: list[MountKey] = []
    set_up_rows, record_rows = [], []
    for index, record in enumerate(records):
        first, member = distinct_rows(record.columns["circle"])
        set_up_rows.append((len(set_ups) + member).astype(np.int32))
        record_rows.append(np.full(len(record), index, np.int32))
        for circle in (record.circle(int(each)) for each in record.columns["circle"][first]):
            keys.append(mount_key(record, circle.mount))
            cup_mm = record.mount(circle.mount).cup_mm
            set_ups.append(_set_up(cup_mm, circle.ball_offset_mm, record.gauge.bar_length_mm))
    columns: Columns = {
        "record": joined(record_rows),
        "set_up": joined(set_up_rows),
        "sliders_mm": joined([record.sliders_mm for record in records]),
        "reading_mm": joined([record.reading_mm for record in records]),
    }
    origin = ", ".join(record.name for record in records)
    found = _completed(records[0].machine, tuple(records), set_ups, keys, columns, origin)
    found.pending = state_columns(records)
    return found


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
        "record": np.zeros(count, np.int32),
        "set_up": np.repeat(np.arange(len(runs), dtype=np.int32), len(angle_rad)),
        "sliders_mm": np.vstack([_sliders_mm(machine, run, angle_rad, origin) for run in runs]),
        "reading_mm": np.full(count, np.nan),
    }
    set_ups = [_set_up(run.mount.cup_mm, run.circle.ball_offset_mm, bar_length_mm) for run in runs]
    state = planned_columns(runs, angle_rad)
    if warming_k is not None:
        state["warming_k"] = warming_k
    keys = [MountKey(PLANNED, run.mount.id) for run in runs]
    return _completed(machine, (), set_ups, keys, columns | state, origin)


def _completed(
    machine: MachineFile,
    records: tuple[Record, ...],
    set_ups: Sequence[_core.SetUp],
    keys: Sequence[MountKey],
    columns: Columns,
    origin: str,
) -> Whole:
    """Complete the table by its mounts; `keys` are those of the set-ups."""
    mounts = tuple(dict.fromkeys(keys))
    of_set_up = np.array([mounts.index(key) for key in keys], np.int32)
    columns["mount"] = of_set_up[columns["set_up"]]
    return Whole(machine, records, tuple(set_ups), mounts, columns, origin)


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


def of_its_own(block: _core.Samples) -> _core.Samples:
    """Return a part of a record for the engine as if there were no others: tables of effects have its rows alone."""
    return _core.Samples(
        sliders_mm=block.sliders_mm,
        set_up=block.set_up,
        mount=block.mount,
        set_ups=block.set_ups,
        state={name: column for name, column in block.state.items() if name != "row"},
    )
