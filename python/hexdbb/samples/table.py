"""The table of samples: what everything from prediction to verdict takes, together with a model.

Built once, from records alone. Every column has one name, with its unit in it: those of the engine's state
(`state.hpp`, `for_each_column`), and `record`, `set_up`, `mount` (places in `Samples.records`, `set_ups`, `mounts`),
`sliders_mm` and `reading_mm`. Columns of sliders and legs have shape (n, 6), those of a
position or rotation (n, 3), all others (n,).

Held-out circles, halves and single rows are views of the same table (`Samples.part`): nothing is derived or evaluated
again for them. For the engine the table takes the form of `block`: mounts are then numbered as a model numbers them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.files.frames import html_table, to_frame
from hexdbb.machine import MachineFile
from hexdbb.model import Model, MountKey, OwnEffect, Tabulated, is_shaped
from hexdbb.plan import CircleRun
from hexdbb.record import Record, rows_of_sweeps
from hexdbb.samples.memory import lingering
from hexdbb.samples.unmeasured import unmeasured_columns
from hexdbb.samples.whole import Columns, Whole, of_records, of_runs

Floats = NDArray[np.float64]
Column = NDArray[Any]

ENDINGS = {3: "xyz", 6: "123456"}
"""What the parts of a column of several numbers are called in frames, by how many there are."""
SHOWN_ROWS = 5
"""Rows shown in a notebook: enough to see the columns' kind."""
SHOWN = ("record", "circle", "sweep", "lap", "direction", "time_s", "angle_rad", "feed_mm_s", "reading_mm")
"""Columns shown in a notebook: those that say where a sample was taken."""


class Samples:
    """Samples of one or several records of one machine, as a table; or some rows of it.

    `Samples.of` makes one of records, `Samples.planned` of circles yet to be run, `part` chooses rows.

    Examples
    --------
    >>> samples = Samples.of([read_record("demo.parquet")])  # doctest: +SKIP
    >>> samples["velocity_mm_s"].shape  # doctest: +SKIP
    (20311, 6)
    """

    def __init__(self, whole: Whole, rows: NDArray[np.intp] | None = None) -> None:
        self._whole = whole
        self._rows = rows
        self._blocks: dict[tuple[MountKey, ...], tuple[frozenset[str], _core.Samples]] = {}
        self._sweeps: tuple[NDArray[np.intp], ...] | None = None

    @classmethod
    def of(cls, records: Sequence[Record]) -> Samples:
        """Build the table of some records, one after another.

        Raises
        ------
        InputError
            No record, or records of different machines.
        """
        return cls(of_records(records))

    @classmethod
    def planned(
        cls,
        machine: MachineFile,
        runs: Sequence[CircleRun],
        angle_rad: Floats,
        bar_length_mm: float,
        *,
        origin: str = "plan",
        warming_k: Floats | None = None,
    ) -> Samples:
        """Build the table of one lap of each of some runs, as the nominal machine would drive them; readings are nan.

        Parameters
        ----------
        machine : MachineFile
        runs : sequence of CircleRun
            Each is a set-up of its own; `record` is 0 everywhere.
        angle_rad : ndarray, shape (m,)
            Angles from a run's start, rising, the same for every run.
        bar_length_mm : float
        origin : str
            Names the plan in errors.
        warming_k : ndarray, shape (len(runs) m,), optional
            Temperature minus the first one; nan, not measured, where not given.

        Raises
        ------
        InputError
            Where the machine cannot follow a circle.
        """
        return cls(of_runs(machine, runs, angle_rad, bar_length_mm, origin, warming_k))

    def part(self, chosen: Column) -> Samples:
        """Return some of these samples, as a view of the same table.

        Parameters
        ----------
        chosen : ndarray
            Mask of bool, shape (n,), or numbers of rows.
        """
        which = np.flatnonzero(chosen) if chosen.dtype == np.bool_ else chosen
        return Samples(self._whole, which if self._rows is None else self._rows[which])

    def of_each_record(self) -> Iterator[tuple[Record, Samples]]:
        """Yield every record with those of its rows that are here, as a view."""
        for index, record in enumerate(self.records):
            yield record, self.part(self["record"] == index)

    def __len__(self) -> int:
        return len(self._whole) if self._rows is None else len(self._rows)

    def __getitem__(self, name: str) -> Column:
        """Return a column, shape (n,), (n, 3) or (n, 6).

        Raises
        ------
        KeyError
            A column that is not known, with those that are.
        """
        column = self._whole.column(name)
        if column is None:
            raise KeyError(f"samples have no column {name!r} (expected one of {', '.join(self.column_names)})")
        return column if self._rows is None else column[self._rows]

    if not TYPE_CHECKING:  # users' functions may write samples.angle_rad for samples["angle_rad"]; ours may not

        def __getattr__(self, name: str) -> Column:
            if name.startswith("_") or name not in self.column_names:
                raise AttributeError(f"'Samples' object has no attribute {name!r}")
            return self[name]

    @property
    def column_names(self) -> tuple[str, ...]:
        """Names of the columns that are known."""
        return self._whole.names

    @property
    def records(self) -> tuple[Record, ...]:
        """All records of the table; none where samples are planned."""
        return self._whole.records

    @property
    def name(self) -> str:
        """What errors call it: its records."""
        return self._whole.origin

    @property
    def machine(self) -> MachineFile:
        """Machine of the records."""
        return self._whole.machine

    @property
    def unmeasured(self) -> frozenset[str]:
        """Columns of the state that cannot be judged: some record computes what they follow from."""
        return unmeasured_columns(self.records)

    @property
    def set_ups(self) -> tuple[_core.SetUp, ...]:
        """Nominal cup, ball and bar of every set-up: one for each circle of each record."""
        return self._whole.set_ups

    @property
    def mounts(self) -> tuple[MountKey, ...]:
        """Every fixing of the cup in the table, in the order of the records."""
        return self._whole.mounts

    @property
    def reading_mm(self) -> Floats:
        """Ball-bar length minus nominal length, shape (n,)."""
        return self["reading_mm"]

    @property
    def row_numbers(self) -> NDArray[np.intp]:
        """Place of each of these samples in the whole table, shape (n,)."""
        return np.arange(len(self._whole)) if self._rows is None else self._rows

    def sweeps(self) -> list[NDArray[np.intp]]:
        """Return the rows of each uninterrupted capture, in the order in which the captures begin."""
        if self._sweeps is None:
            self._sweeps = tuple(rows_of_sweeps(self["sweep"]))
        return list(self._sweeps)

    def block(self, model: Model) -> _core.Samples:
        """Return the engine's form of these samples, mounts numbered as a model numbers them.

        A model that knows no mounts has every cup where it was planned.

        Raises
        ------
        InputError
            A machine that differs, or a mount that the model does not know.
        """
        for record in self.records:
            record.require_machine(model.machine, model.name)
        held, block = self._blocks.get(model.mounts, (frozenset(), None))
        if block is None or not model.needs <= held:
            if model.mounts:
                self._require_known(model)
            held, whole = self._whole.block(model.mounts, model.needs)
            block = whole if self._rows is None else whole.rows(self._rows)
            self._blocks[model.mounts] = held, block
        return block

    def engine(self, model: Model) -> _core.Model:
        """Return the engine's form of a model that is to predict these samples.

        Raises
        ------
        InputError
            An effect of the user's own that fails, with its file and line.
        """
        return model.engine(self.tabulated)

    def tabulated(self, effect: OwnEffect, values: Floats) -> Tabulated:
        """Return what a user's effect pushes in the whole table, of which the engine takes the rows it needs.

        Parameters
        ----------
        effect : OwnEffect
        values : ndarray, shape (size,)
            Of its parameters: shape parameters among them change the table.
        """
        known = self._whole.tabulated
        if not is_shaped(effect):
            if effect not in known:
                known[effect] = effect.tabulated(Samples(self._whole))
            return known[effect]
        at = values.tobytes()  # another fit's values need another table; the last one serves most calls
        before, found = self._whole.shaped.get(effect, (b"", None))
        if found is None or before != at:
            found = effect.tabulated_at(Samples(self._whole), values)
            self._whole.shaped[effect] = (at, found)
        return found

    def pushes_of(self, effect: OwnEffect, values: Floats) -> Floats:
        """Return what an effect that is not the engine's pushes at its values, (n, 55, size), mm per unit of one."""
        return self.tabulated(effect, values).pushes(self.row_numbers)

    def lingering(self, of: Callable[[Samples], Floats], constant_s: float, standing: Floats | None = None) -> Floats:
        """Return what functions of the samples do if it lingers: a first-order lag of them, with what came between.

        Parameters
        ----------
        of : callable
            Of all samples of the table: functions of them, shape (m,) or (m, k).
        constant_s : float
            Time constant.
        standing : ndarray, shape (k,), optional
            Those functions while the machine waits between two sweeps; as where the next run-up begins if not given.

        Returns
        -------
        ndarray, shape (n,) or (n, k)
            In these samples, wherever in the table they are.
        """
        whole = Samples(self._whole)
        found = lingering(of(whole), constant_s, standing, whole["time_s"], whole["sweep"], whole["angle_rad"])
        return found if self._rows is None else found[self._rows]

    def columns(self) -> Columns:
        """Return every column with shape (n,): ``velocity_mm_s_1`` of slider 1, ``position_mm_x``."""
        flat: Columns = {}
        for name in self.column_names:
            column = self[name]
            if column.ndim == 1:
                flat[name] = column
            else:
                flat |= {f"{name}_{each}": part for each, part in zip(ENDINGS[column.shape[1]], column.T, strict=True)}
        if self.records:
            flat["record"] = np.array([record.name for record in self.records], dtype=object)[self["record"]]
        return flat

    def to_frame(self) -> Any:
        """Return `columns` as a ``pandas.DataFrame``; `InputError` where pandas is not installed."""
        return to_frame(self.columns())

    def __repr__(self) -> str:
        of = "" if self._rows is None else f" of {len(self._whole)}"
        counts = f"{len(np.unique(self['set_up']))} set-ups, {len(np.unique(self['sweep']))} sweeps"
        return f"<Samples: {len(self)}{of} samples of {self.name}, {counts}, {len(self.column_names)} columns>"

    def _repr_html_(self) -> str:
        flat = self.columns()
        rows = [[_cell(flat[name][row]) for name in SHOWN] for row in range(min(SHOWN_ROWS, len(self)))]
        return f"<p>{len(self)} samples; columns {escape(', '.join(self.column_names))}</p>{html_table(SHOWN, rows)}"

    def _require_known(self, model: Model) -> None:
        for place in np.flatnonzero(np.bincount(self["mount"])):
            key = self.mounts[place]
            if key not in model.mounts:
                name = self.records[self["record"][self["mount"] == place][0]].name if self.records else self.name
                raise InputError(
                    f"{name}: mount {key.mount_id}: not known to the model"
                    " (expected a fitted one: hexdbb.diagnosis.fit_mounts finds where its cup stands)"
                )


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, (float, np.floating)) else str(value)
