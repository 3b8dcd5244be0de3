"""A record in memory: samples by column, and all that is needed to understand them."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.files.validation import dump_toml, format_value
from hexdbb.machine import MachineFile
from hexdbb.plan import Circle, Gauge, Mount
from hexdbb.record.columns import REQUIRED_COLUMNS, SLIDER_COLUMNS, Columns, Origin, normalise
from hexdbb.record.measurement import Measurement

DIMENSIONS = ("base", "platform", "legs", "sliders")
"""Sections of a machine file that make it this machine and no other."""


@dataclass
class Record:
    """Samples of one or more circular tests of one machine.

    Columns are cast to their types (`hexdbb.record.columns`) when a record is made; their values are checked when it is
    read or written.

    Raises
    ------
    InputError
        A column is missing or of another length, or a value has no place in its column.
    """

    columns: Columns
    """Samples, each of shape (n,), by name."""
    gauge: Gauge
    mounts: tuple[Mount, ...]
    circles: tuple[Circle, ...]
    machine: MachineFile
    metadata: dict[str, Any] = field(default_factory=dict)
    """What else is known, as JSON can hold it: software version, CAN set-up, why a capture stopped."""
    path: Path | None = None
    """The file it was read from or written to."""
    complete: bool = True
    """False where the capture was interrupted."""
    whole_hash: str | None = None
    """Content hash of the record that this is a part of; None for a whole one."""
    origin: tuple[float, float] | None = None
    """Time, s, and temperature, °C (nan where not measured), from which drift counts: those of the first sample, which
    a part of a record keeps (`part`)."""

    def __post_init__(self) -> None:
        self.columns = normalise(self.columns, Origin(self.name))
        if self.origin is None:
            self.origin = _first_time_and_temperature(self.columns)

    def __len__(self) -> int:
        return len(self.columns["t_s"])

    @property
    def name(self) -> str:
        """What errors call it: its path, or ``record`` for one that is in memory only."""
        return str(self.path) if self.path is not None else "record"

    @property
    def sliders_mm(self) -> NDArray[np.float64]:
        """Slider coordinates as the encoders report them, shape (n, 6)."""
        return np.column_stack([self.columns[name] for name in SLIDER_COLUMNS])

    @property
    def reading_mm(self) -> NDArray[np.float64]:
        """Ball-bar length minus nominal length, shape (n,)."""
        reading_mm: NDArray[np.float64] = self.columns["reading_um"] / 1000.0
        return reading_mm

    def circle(self, identity: int) -> Circle:
        """Give the circle of an id."""
        return next(circle for circle in self.circles if circle.id == identity)

    def mount(self, identity: int) -> Mount:
        """Give the mount of an id."""
        return next(mount for mount in self.mounts if mount.id == identity)

    def sweeps(self) -> list[NDArray[np.intp]]:
        """Give the rows of each uninterrupted capture, in the order in which the captures begin."""
        _, first, member = np.unique(self.columns["sweep"], return_index=True, return_inverse=True)
        return [np.flatnonzero(member == which) for which in np.argsort(first)]

    def measurement(self, machine: str) -> Measurement:
        """Give gauge, mounts and circles as the file that names its machine `machine`."""
        complete = None if self.complete else False
        return Measurement(machine=machine, complete=complete, gauge=self.gauge, mount=self.mounts, circle=self.circles)

    def part(self, rows: NDArray[np.bool_]) -> Record:
        """Give some of the samples, rows of shape (n,), as a record that counts as the same one: its set-ups are known.

        Its `content_hash` is that of the whole record.
        """
        columns = {name: column[rows] for name, column in self.columns.items()}
        return replace(self, columns=columns, whole_hash=self.content_hash())

    def content_hash(self) -> str:
        """SHA-256 of required columns, gauge, mounts, circles and machine; the same in every form of the record."""
        return self.whole_hash if self.whole_hash is not None else self._own_hash

    @cached_property
    def _own_hash(self) -> str:
        digest = hashlib.sha256()
        for name, kind in REQUIRED_COLUMNS.items():
            digest.update(name.encode())
            digest.update(np.ascontiguousarray(self.columns[name], dtype=np.dtype(kind).newbyteorder("<")).tobytes())
        digest.update(dump_toml(self.measurement("machine")).encode())
        digest.update(dump_toml(self.machine).encode())
        return digest.hexdigest()

    def require_machine(self, machine: MachineFile, origin: str) -> None:
        """Refuse a machine of other dimensions than the record's own.

        Parameters
        ----------
        machine : MachineFile
            For example the machine of a model.
        origin : str
            File the machine comes from, for the error.

        Raises
        ------
        InputError
            Naming the first dimension that differs, with both values.
        """
        for section in DIMENSIONS:
            own, other = getattr(self.machine, section).model_dump(), getattr(machine, section).model_dump()
            for key, value in own.items():
                if other[key] != value:
                    raise InputError(
                        f"{origin}: {section}.{key}: {format_value(other[key])}"
                        f" (expected {format_value(value)}, as in {self.name}: they do not belong together)"
                    )


def _first_time_and_temperature(columns: Columns) -> tuple[float, float]:
    """Time of the first sample; first measured temperature, nan where there is none."""
    if len(columns["t_s"]) == 0:
        return 0.0, math.nan
    temperature = columns.get("temperature_c", np.full(1, np.nan))
    measured = temperature[np.isfinite(temperature)]
    return float(columns["t_s"][0]), float(measured[0]) if len(measured) else math.nan
