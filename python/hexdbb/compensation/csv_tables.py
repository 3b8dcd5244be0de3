"""CSV tables of `hexdbb compensate --poses`: poses read, slider coordinates written."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.files.delimited import read_rows, require_cells
from hexdbb.files.validation import format_name, format_value

Floats = NDArray[np.float64]

POSE_COLUMNS = ("x_mm", "y_mm", "z_mm", "roll_deg", "pitch_deg", "yaw_deg")
SLIDER_COLUMNS = tuple(f"s{k}_mm" for k in range(1, 7))


def read_poses(path: Path) -> Floats:
    """Read a table of poses, in order of motion.

    Parameters
    ----------
    path : Path
        CSV with the columns of `POSE_COLUMNS`, in any order; further columns are ignored.

    Returns
    -------
    ndarray, shape (n, 6)
        Columns in the order of `POSE_COLUMNS`, mm and deg.

    Raises
    ------
    InputError
        Naming file, line and column.
    """
    rows = list(read_rows(path))
    header = [name.strip() for name in rows[0][1]] if rows else []
    missing = [name for name in POSE_COLUMNS if name not in header]
    if missing or len(set(header)) != len(header):
        raise InputError(
            f"{path}: columns {','.join(map(format_name, header))} (expected {','.join(POSE_COLUMNS)}, each once)"
        )
    columns = [header.index(name) for name in POSE_COLUMNS]
    body = rows[1:]
    if not body:
        raise InputError(f"{path}: no poses (expected at least one row)")
    for line, row in body:
        require_cells(path, line, row, len(header))
    return np.array([_pose(path, line, row, columns) for line, row in body])


def sliders_csv(sliders_mm: Floats) -> str:
    """Return slider coordinates (n, 6) in mm as CSV text, to 1 nm; the columns are `SLIDER_COLUMNS`."""
    lines = [",".join(SLIDER_COLUMNS), *(",".join(f"{each:.6f}" for each in row) for row in sliders_mm)]
    return "\n".join(lines) + "\n"


def _pose(path: Path, line: int, row: Sequence[str], columns: Sequence[int]) -> list[float]:
    values = []
    for name, column in zip(POSE_COLUMNS, columns, strict=True):
        text = row[column]
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InputError(f"{path}: line {line}: {name}: {format_value(text)} (expected a finite number)")
        values.append(value)
    return values
