"""Record in memory: samples by column, with the gauge, mounts, circles and machine they refer to."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.files.frames import to_frame
from hexdbb.files.validation import FileModel, dump_toml, format_value
from hexdbb.machine import MachineFile
from hexdbb.plan import Circle, Conditions, Gauge, Mount
from hexdbb.record.columns import REQUIRED_COLUMNS, SLIDER_COLUMNS, Columns, RowSource, normalise
from hexdbb.record.conditions import conditions_in
from hexdbb.record.measurement import Measurement
from hexdbb.record.not_measured import NotMeasured, not_measured_in
from hexdbb.record.summary import summary_html, summary_line
from hexdbb.record.sweep_rows import rows_of_sweeps

DIMENSIONS = ("base", "platform", "legs", "sliders")
"""Sections of a machine file that identify a machine; its name and CAN set-up do not."""


@dataclass(repr=False)
class Record:
    """Samples of one or more circular tests of one machine.

    Columns are cast to their types (`hexdbb.record.columns`) on construction; their values are checked on reading and
    on writing. A notebook shows a record as a table of its sweeps.

    Raises
    ------
    InputError
        A column is missing, has another length than `t_s`, or holds a value that its type cannot represent.
    """

    columns: Columns
    """Samples, each of shape (n,), by name."""
    gauge: Gauge
    mounts: tuple[Mount, ...]
    circles: tuple[Circle, ...]
    machine: MachineFile
    metadata: dict[str, Any] = field(default_factory=dict)
    """Further facts that JSON can represent: software version, CAN set-up, why a capture stopped."""
    path: Path | None = None
    """The file it was read from or written to."""
    complete: bool = True
    """False where the capture was interrupted."""
    whole_hash: str | None = None
    """Content hash of the whole record that this one is a part of; None for a whole record."""
    origin: tuple[float, float] | None = None
    """Zero of drift: time (s) and temperature (°C, nan where not measured) of the whole record's first sample; kept by
    `part`."""

    def __post_init__(self) -> None:
        self.columns = normalise(self.columns, RowSource(self.name))
        if self.origin is None:
            self.origin = _first_time_and_temperature(self.columns)

    def __len__(self) -> int:
        return len(self.columns["t_s"])

    def __repr__(self) -> str:
        return summary_line(self)

    def _repr_html_(self) -> str:
        return summary_html(self)

    @property
    def name(self) -> str:
        """Name in error messages: the path, or ``record`` for a record in memory only."""
        return str(self.path) if self.path is not None else "record"

    @property
    def sliders_mm(self) -> NDArray[np.float64]:
        """Slider coordinates as the encoders report them, mm, shape (n, 6)."""
        return np.array([self.columns[name] for name in SLIDER_COLUMNS]).T  # column by column, as the engine has them

    @property
    def reading_mm(self) -> NDArray[np.float64]:
        """Ball-bar length minus nominal length, mm, shape (n,)."""
        reading_mm: NDArray[np.float64] = self.columns["reading_um"] / 1000.0
        return reading_mm

    def circle(self, identity: int) -> Circle:
        """Return the circle with this id."""
        return next(circle for circle in self.circles if circle.id == identity)

    def mount(self, identity: int) -> Mount:
        """Return the mount with this id."""
        return next(mount for mount in self.mounts if mount.id == identity)

    def to_frame(self) -> Any:
        """Return the samples as a ``pandas.DataFrame`` of n rows, its columns those of the record's file.

        Its ``attrs`` hold the rest as plain values: ``measurement`` (gauge, mounts, circles), ``machine``,
        ``metadata`` and ``complete``.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        frame = to_frame(self.columns)
        frame.attrs = {
            "measurement": self.measurement("machine").model_dump(mode="json", by_alias=True, exclude_none=True),
            "machine": self.machine.model_dump(mode="json", by_alias=True, exclude_none=True),
            "metadata": self.metadata,
            "complete": self.complete,
        }
        return frame

    def sweeps(self) -> list[NDArray[np.intp]]:
        """Return the rows of each sweep (uninterrupted capture), in the order in which the sweeps begin."""
        return rows_of_sweeps(self.columns["sweep"])

    @property
    def conditions(self) -> Conditions:
        """Conditions of the test as far as they are recorded; values of another kind count as not recorded."""
        return conditions_in(self.metadata)

    @property
    def not_measured(self) -> NotMeasured:
        """What was computed instead of measured, and from what; empty for a record of `hexdbb-run`."""
        return not_measured_in(self.metadata)

    def measurement(self, machine: str) -> Measurement:
        """Return gauge, mounts and circles as a measurement file that names its machine `machine`."""
        complete = None if self.complete else False
        return Measurement(machine=machine, complete=complete, gauge=self.gauge, mount=self.mounts, circle=self.circles)

    def of_fixing(self, name: str) -> Record:
        """Return the record with its mounts named as those of one fixing of the cup (`hexdbb.plan.Mount.fixing`)."""
        return replace(self, mounts=tuple(mount.model_copy(update={"fixing": name}) for mount in self.mounts))

    def part(self, rows: NDArray[np.bool_]) -> Record:
        """Return the samples selected by a mask of shape (n,) as a record with the identity of the whole one.

        Its `content_hash` and its `origin` are those of the whole record, so a model knows its set-ups.
        """
        columns = {name: column[rows] for name, column in self.columns.items()}
        return replace(self, columns=columns, whole_hash=self.content_hash())

    def content_hash(self) -> str:
        """Return the SHA-256 (hex) of required columns, gauge, mounts, circles and machine; equal in every format.

        What only reports show (conditions, serial numbers, calibration, limits) is not in it, nor the names of
        fixings: a note corrected later leaves a record what it was.
        """
        return self.whole_hash if self.whole_hash is not None else self._own_hash

    @cached_property
    def _own_hash(self) -> str:
        digest = hashlib.sha256()
        for name, kind in REQUIRED_COLUMNS.items():
            digest.update(name.encode())
            digest.update(np.ascontiguousarray(self.columns[name], dtype=np.dtype(kind).newbyteorder("<")).data)
        nameless = self.gauge.model_copy(update={"serial_number": None, "calibrated": None})
        # Which records share a fixing is stated about a record, and may be stated later.
        mounts = tuple(mount.model_copy(update={"fixing": None}) for mount in self.mounts)
        digest.update(
            _toml(_Stated(self.measurement("machine").model_copy(update={"gauge": nameless, "mounts": mounts})))
        )
        described: dict[str, Any] = {"serial_number": None, "tolerance": None, "watch": None}
        digest.update(_toml(_Stated(self.machine.model_copy(update=described))))
        return digest.hexdigest()

    def require_machine(self, machine: MachineFile, origin: str) -> None:
        """Check that a machine has the dimensions of the record's own machine.

        Parameters
        ----------
        machine : MachineFile
            For example the machine of a model.
        origin : str
            File that the machine was read from, for the error.

        Raises
        ------
        InputError
            Naming the first dimension that differs, with both values.
        """
        require_dimensions(self.machine, self.name, machine, origin)


def require_dimensions(machine: MachineFile, named: str, other: MachineFile, origin: str) -> None:
    """Check that two machine files have the same dimensions.

    Parameters
    ----------
    machine : MachineFile
        What is expected.
    named : str
        The file that it was read from, for the error.
    other : MachineFile
    origin : str
        The file that `other` was read from.

    Raises
    ------
    InputError
        Naming the first dimension that differs, with both values.
    """
    for section in DIMENSIONS:
        if getattr(machine, section) == getattr(other, section):
            continue
        own, found = getattr(machine, section).model_dump(), getattr(other, section).model_dump()
        for key, value in own.items():
            if found[key] != value:
                raise InputError(
                    f"{origin}: {section}.{key}: {format_value(found[key])}"
                    f" (expected {format_value(value)}, as in {named}: they do not belong together)"
                )


def _first_time_and_temperature(columns: Columns) -> tuple[float, float]:
    """Return the time of the first sample, s, and the first measured temperature, °C, nan where there is none."""
    if len(columns["t_s"]) == 0:
        return 0.0, math.nan
    temperature = columns.get("temperature_c", np.full(1, np.nan))
    measured = temperature[np.isfinite(temperature)]
    return float(columns["t_s"][0]), float(measured[0]) if len(measured) else math.nan


class _Stated:
    """A file's model that is known by its values."""

    def __init__(self, model: FileModel) -> None:
        self.model, self._values = model, model.model_dump_json(by_alias=True)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Stated) and self._values == other._values

    def __hash__(self) -> int:
        return hash(self._values)


@lru_cache(maxsize=64)
def _toml(stated: _Stated) -> bytes:
    """Return a file's model as TOML; it takes some ms to write, and records of one machine and plan have the same."""
    return dump_toml(stated.model).encode()
