"""Table of targets: in memory as columns, or in a temporary file of which parts are read.

A file keeps what was checked, so that the same rows are driven, and memory does not grow with the length of a run: the
targets of an hour at 250 Hz take 60 MB of disk. It has no name and disappears with the program, however that ends.
"""

from __future__ import annotations

import os
import tempfile
import weakref
from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import RunError
from hexdbb.trajectory.poses import Array

ROW = np.dtype(
    [("sliders_mm", "<f8", 6), ("phase", "i1"), ("run", "<i4"), ("angle_deg", "<f8"), ("lap", "<i4"), ("capture", "?")]
)
"""One row of the file, 66 bytes."""
BLOCK_ROWS = 4096
"""Rows computed and checked at a time: 16 s at 250 Hz. Some megabytes while they are computed; fewer rows would pay the
overhead of a call more often."""


@dataclass(frozen=True)
class Table:
    """Columns of targets, one row per cycle.

    Attributes
    ----------
    sliders_mm : (n, 6) slider targets, mm
    phase : (n,) `Phase`
    run : (n,) index into the programme's runs, -1 for none
    angle_deg : (n,) commanded polar angle, 0 <= angle < 360, NaN off the circle
    lap : (n,) turns completed inside the capture, -1 outside it
    capture : (n,) bool
    """

    sliders_mm: Array
    phase: NDArray[np.int64]
    run: NDArray[np.int64]
    angle_deg: Array
    lap: NDArray[np.int64]
    capture: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.capture)

    def then(self, other: Table) -> Table:
        """Return this table followed by another."""
        return Table(*(np.concatenate([getattr(self, f.name), getattr(other, f.name)]) for f in fields(Table)))

    def part(self, first: int, last: int) -> Table:
        """Return rows `first` to `last`, the last one left out."""
        return Table(*(getattr(self, f.name)[first:last] for f in fields(Table)))


class TableFile:
    """A table in a temporary file without a name.

    Raises
    ------
    RunError
        The file cannot be made, written or read: names folder and reason.
    """

    def __init__(self) -> None:
        self._rows = 0
        try:
            with tempfile.TemporaryFile(prefix="hexdbb-targets-") as file:
                self._file = os.dup(file.fileno())
        except OSError as error:
            raise _failed("written", error) from None
        weakref.finalize(self, os.close, self._file)

    def __len__(self) -> int:
        return self._rows

    def append(self, table: Table) -> None:
        """Write further rows."""
        rows = np.empty(len(table), ROW)
        for name in ROW.names or ():
            rows[name] = getattr(table, name)
        data, at = rows.tobytes(), self._rows * ROW.itemsize
        try:
            while data:
                written = os.pwrite(self._file, data, at)
                data, at = data[written:], at + written
        except OSError as error:
            raise _failed("written", error) from None
        self._rows += len(table)

    def part(self, first: int, last: int) -> Table:
        """Read rows `first` to `last`, the last one left out; from any thread."""
        last = min(last, self._rows)
        size, at, data = max(last - first, 0) * ROW.itemsize, first * ROW.itemsize, b""
        try:
            while len(data) < size:
                read = os.pread(self._file, size - len(data), at + len(data))
                if not read:
                    raise OSError(0, "the file ends too early")
                data += read
        except OSError as error:
            raise _failed("read", error) from None
        rows = np.frombuffer(data, ROW)
        return Table(
            np.ascontiguousarray(rows["sliders_mm"]),
            rows["phase"].astype(np.int64),
            rows["run"].astype(np.int64),
            rows["angle_deg"].copy(),
            rows["lap"].astype(np.int64),
            rows["capture"].copy(),
        )

    def blocks(self, first: int = 0, last: int | None = None) -> Iterator[Table]:
        """Read rows `first` to `last` block by block; by default all."""
        last = self._rows if last is None else last
        for at in range(first, last, BLOCK_ROWS):
            yield self.part(at, min(at + BLOCK_ROWS, last))


def _failed(what: str, error: OSError) -> RunError:
    folder = tempfile.gettempdir()
    return RunError(
        f"targets: cannot be {what} in {folder}: {error.strerror} "
        f"(expected {ROW.itemsize} bytes a cycle; TMPDIR names another folder)"
    )
