"""CSV tables of `hexdbb compensate --poses`: poses read, slider coordinates written."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError

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
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read: {error} (expected a CSV table of poses)") from None
    header = [name.strip() for name in rows[0]] if rows else []
    missing = [name for name in POSE_COLUMNS if name not in header]
    if missing or len(set(header)) != len(header):
        raise InputError(f"{path}: columns {','.join(header)} (expected {','.join(POSE_COLUMNS)}, each once)")
    columns = [header.index(name) for name in POSE_COLUMNS]
    body = [(line, row) for line, row in enumerate(rows[1:], start=2) if row]
    if not body:
        raise InputError(f"{path}: no poses (expected at least one row)")
    return np.array([_pose(path, line, row, columns) for line, row in body])


def sliders_csv(sliders_mm: Floats) -> str:
    """Return slider coordinates (n, 6) in mm as CSV text, to 1 nm; the columns are `SLIDER_COLUMNS`."""
    lines = [",".join(SLIDER_COLUMNS), *(",".join(f"{each:.6f}" for each in row) for row in sliders_mm)]
    return "\n".join(lines) + "\n"


def _pose(path: Path, line: int, row: Sequence[str], columns: Sequence[int]) -> list[float]:
    values = []
    for name, column in zip(POSE_COLUMNS, columns, strict=True):
        text = row[column] if column < len(row) else ""
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InputError(f'{path}: line {line}: {name}: "{text}" (expected a finite number)')
        values.append(value)
    return values
