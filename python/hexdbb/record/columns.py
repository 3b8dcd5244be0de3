"""Columns of a record: names, types and units, and the cast of a file's columns to them.

The names end in their unit. Columns that are not in this table are kept as they are.

| column | type | meaning |
|---|---|---|
| `t_s` | float64 | time of the sample |
| `circle`, `sweep`, `lap` | int32 | id of the circle; number of the uninterrupted capture; turn inside it |
| `direction` | int8 | +1 counter-clockwise seen from above the circle's plane, -1 clockwise |
| `angle_deg` | float64 | commanded polar angle; 0 <= angle < 360 if written by hexdbb, any turns are read |
| `feed_mm_min` | float64 | commanded feed |
| `s1_mm` ... `s6_mm` | float64 | slider coordinates as the encoders report them |
| `reading_um` | float64 | ball-bar length minus nominal length |
| `temperature_c` | float64 | optional |
| `target1_mm` ... `target6_mm` | float64 | optional: slider coordinates as commanded |
| `status` | int32 | optional: state of the capture at the sample |
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.files.validation import format_name, format_value, without_unit

Columns = dict[str, NDArray[Any]]

SLIDER_COLUMNS = tuple(f"s{k}_mm" for k in range(1, 7))
TARGET_COLUMNS = tuple(f"target{k}_mm" for k in range(1, 7))
REQUIRED_COLUMNS: dict[str, type[np.generic]] = {
    "t_s": np.float64,
    "circle": np.int32,
    "sweep": np.int32,
    "direction": np.int8,
    "lap": np.int32,
    "angle_deg": np.float64,
    "feed_mm_min": np.float64,
    **dict.fromkeys(SLIDER_COLUMNS, np.float64),
    "reading_um": np.float64,
}
COLUMN_TYPES: dict[str, type[np.generic]] = {
    **REQUIRED_COLUMNS,
    "temperature_c": np.float64,
    **dict.fromkeys(TARGET_COLUMNS, np.float64),
    "status": np.int32,
}


class BadRowError(InputError):
    """Raised for the first wrong sample of a record.

    Parameters
    ----------
    message : str
        Names the file, the row (from 1), the column, the value and what was expected.
    row : int
        Row of the sample, from 0.
    """

    def __init__(self, message: str, row: int) -> None:
        super().__init__(message)
        self.row = row


@dataclass(frozen=True)
class RowSource:
    """The file that rows were read from, for error messages that a reader of the file can follow."""

    name: str
    """Path of the file."""
    line_of: Callable[[int], int] | None = None
    """Line of the file that holds a row (from 0); None for files without lines."""

    def bad_row(self, row: int, column: str, value: object, expected: str) -> BadRowError:
        """Return the error of one cell: row from 0, the value found and what was expected."""
        line = f" (line {self.line_of(row)})" if self.line_of is not None else ""
        shown = value if isinstance(value, str) else format_value(value)
        return BadRowError(f"{self.name}: row {row + 1}{line}: {column}: {shown} (expected {expected})", row)


def joined(parts: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """Return parts one after another; a single one as it is, not copied."""
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def normalise(columns: Mapping[str, Any], source: RowSource) -> Columns:
    """Cast columns to the types of a record: known columns first, in the order of `COLUMN_TYPES`, then the others.

    Parameters
    ----------
    columns : mapping of str to array_like, each of shape (n,)
    source : RowSource
        Names the file in errors.

    Returns
    -------
    dict of str to ndarray, each of shape (n,)

    Raises
    ------
    InputError
        A required column is missing, a column has another length, or a value cannot be represented in its column.
    """
    missing = [name for name in REQUIRED_COLUMNS if name not in columns]
    if missing:
        for present in columns:
            if present not in COLUMN_TYPES and without_unit(present) == without_unit(missing[0]):
                expected = f"expected {missing[0]}: the unit is part of the name"
                raise InputError(f"{source.name}: column {format_name(present)} ({expected})")
        present = ", ".join(map(format_name, columns)) or "none"
        raise InputError(f"{source.name}: missing column {', '.join(missing)} (columns present: {present})")
    ordered = [*(name for name in COLUMN_TYPES if name in columns), *(n for n in columns if n not in COLUMN_TYPES)]
    arrays = {name: np.atleast_1d(np.asarray(columns[name])) for name in ordered}
    count = len(arrays["t_s"])
    for name, values in arrays.items():
        if values.shape != (count,):
            raise InputError(
                f"{source.name}: column {format_name(name)}: shape {values.shape} (expected ({count},), as t_s has)"
            )
    return {name: _cast(name, values, source) for name, values in arrays.items()}


def _cast(name: str, values: NDArray[Any], source: RowSource) -> NDArray[Any]:
    kind = COLUMN_TYPES.get(name)
    if kind is None or values.dtype == kind:
        return values
    if not (np.issubdtype(values.dtype, np.number) or values.dtype == np.bool_):
        raise InputError(f"{source.name}: column {name}: of type {values.dtype} (expected numbers)")
    if np.issubdtype(kind, np.integer):
        _check_whole(name, values, np.iinfo(kind), source)
    return values.astype(kind)


def _check_whole(name: str, values: NDArray[Any], limits: np.iinfo[Any], source: RowSource) -> None:
    wrong = ~(np.isfinite(values) & (values >= limits.min) & (values <= limits.max))
    wrong[~wrong] = values[~wrong] != np.round(values[~wrong])
    if wrong.any():
        row = int(np.argmax(wrong))
        raise source.bad_row(row, name, values[row].item(), f"a whole number from {limits.min} to {limits.max}")
