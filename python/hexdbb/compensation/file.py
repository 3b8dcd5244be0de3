"""Compensation for motion controllers: what of a model they can correct, the file they load, slider targets of a path.

The engine does it all (`compensation.hpp`): which effects can be corrected, the format of the file, the targets. This
module gives it models and tables and turns its refusals into `InputError`.
"""

from __future__ import annotations

import csv
import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import replacing
from hexdbb.kinematics import engine_machine, status_name
from hexdbb.machine import MachineFile
from hexdbb.model import Model
from hexdbb.record import Record

Floats = NDArray[np.float64]

SUFFIX = ".hexcomp"
POSE_COLUMNS = ("x_mm", "y_mm", "z_mm", "roll_deg", "pitch_deg", "yaw_deg")
SLIDER_COLUMNS = tuple(f"s{k}_mm" for k in range(1, 7))
MAX_CORRECTION_MM = 1.0
REVERSAL_TRAVEL_MM = 0.01
UNHURRIED_S = 1e6
"""Time between the poses of a path without times: they have an order, hence directions, and next to no speed."""


@dataclass(frozen=True)
class PathTargets:
    """Where the sliders must stand along a path."""

    sliders_mm: Floats
    """Shape (n, 6)."""
    correction_mm: Floats
    """What they have beyond the nominal coordinates, shape (n, 6)."""


def make_compensation(
    model: Model,
    *,
    max_correction_mm: float = MAX_CORRECTION_MM,
    reversal_travel_mm: float = REVERSAL_TRAVEL_MM,
    reference_temperature_c: float | None = None,
) -> _core.CompensationData:
    """Take from a model what a controller can correct.

    Parameters
    ----------
    model : Model
        Its effects of the user's own are left out, as what only the program that fitted them knows.
    max_correction_mm : float
        Largest correction of one slider; a controller refuses poses that need more.
    reversal_travel_mm : float
        Travel of a slider over which what depends on its direction goes from one side to the other.
    reference_temperature_c : float, optional
        Temperature at the first sample of the record that thermal growth was fitted to; without it growth is left out.

    Returns
    -------
    CompensationData
        `effects` it corrects, `left_out` with reasons.
    """
    content = model.path.read_bytes() if model.path is not None and model.path.is_file() else b""
    unknown = [term.effect for term in model.terms if term.effect in model.own_effects]
    known = replace(model, terms=tuple(term for term in model.terms if term.effect not in unknown))
    return _core.compensation_of(
        known.engine(),
        name=model.machine.name,
        model_sha256=hashlib.sha256(content).hexdigest() if content else "",
        max_correction_mm=max_correction_mm,
        reversal_travel_mm=reversal_travel_mm,
        reference_temperature_c=math.nan if reference_temperature_c is None else reference_temperature_c,
        unknown=unknown,
    )


def fitted_temperature_c(model: Model, record: Record) -> float:
    """Give the temperature from which a model's growth counts: the first one of the record it was fitted to.

    Raises
    ------
    InputError
        The model was not fitted to this record, or no temperature was measured in it.
    """
    if record.content_hash() not in {each for step in model.ledger for each in step.record_hashes}:
        raise InputError(f"{record.name}: the model was not fitted to it (expected a record that its history names)")
    _, temperature_c = record.origin if record.origin is not None else (0.0, math.nan)
    if math.isnan(temperature_c):
        raise InputError(f"{record.name}: temperature_c: not measured (expected a record with a temperature)")
    return temperature_c


def write_text(text: str, path: Path) -> None:
    """Write a compensation file, a header or a table, whole or not at all.

    Raises
    ------
    RunError
        Where it cannot be written.
    """
    with replacing(path) as temporary:
        temporary.write_bytes(text.encode())


def read_compensation(path: Path, machine: MachineFile | None = None) -> _core.CompensationData:
    """Read a compensation file.

    Parameters
    ----------
    path : Path
    machine : MachineFile, optional
        The machine to be driven; a file of another one is refused.

    Raises
    ------
    InputError
        Cannot be read, malformed, truncated, altered, of a later version, of another machine, an unknown effect.
    """
    try:
        data = _core.read_compensation(str(path))
        if machine is not None:
            _core.require_machine(data.machine, engine_machine(machine), str(path))
    except _core.CompensationError as error:
        raise InputError(str(error)) from None
    return data


def path_targets(
    data: _core.CompensationData,
    position_mm: ArrayLike,
    rpy_rad: ArrayLike,
    *,
    time_s: ArrayLike | None = None,
    temperature_c: float = math.nan,
    name: str = "the path",
) -> PathTargets:
    """Slider targets along a path, in order of motion.

    Parameters
    ----------
    data : CompensationData
    position_mm : array_like, shape (n, 3)
    rpy_rad : array_like, shape (n, 3) or (3,)
    time_s : array_like, shape (n,), optional
        When each pose is reached, from which velocities follow; without it only the directions are known.
    temperature_c : float
        Measured; nan where it is not.
    name : str
        How errors name the path.

    Raises
    ------
    InputError
        Naming the first pose without targets and why.
    """
    position = np.ascontiguousarray(position_mm, dtype=np.float64)
    rpy = np.ascontiguousarray(np.broadcast_to(np.asarray(rpy_rad, dtype=np.float64), position.shape))
    count = len(position)
    times = UNHURRIED_S * np.arange(count) if time_s is None else np.asarray(time_s, dtype=np.float64)
    compensator = _core.Compensator(data, name)
    sliders, correction, status, slider = compensator.sliders_along(
        position, rpy, times, np.full(count, temperature_c, dtype=np.float64)
    )
    wrong = np.flatnonzero(status)
    if wrong.size:
        row = int(wrong[0])
        raise InputError(f"{name}: row {row + 1}: slider {slider[row] + 1}: {status_name(int(status[row]))}")
    return PathTargets(sliders, correction)


def read_poses(path: Path) -> Floats:
    """Read a table of poses, in order of motion.

    Parameters
    ----------
    path : Path
        CSV with the columns x_mm, y_mm, z_mm, roll_deg, pitch_deg, yaw_deg, in any order.

    Returns
    -------
    ndarray, shape (n, 6)
        In the order of the columns above.

    Raises
    ------
    InputError
        Naming file, row and column.
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
    places = [header.index(name) for name in POSE_COLUMNS]
    body = [(number, row) for number, row in enumerate(rows[1:], start=2) if row]
    if not body:
        raise InputError(f"{path}: no poses (expected at least one row)")
    return np.array([_pose(path, number, row, places) for number, row in body])


def sliders_csv(sliders_mm: Floats) -> str:
    """Table of slider coordinates as text, to 1 nm."""
    lines = [",".join(SLIDER_COLUMNS), *(",".join(f"{each:.6f}" for each in row) for row in sliders_mm)]
    return "\n".join(lines) + "\n"


def _pose(path: Path, number: int, row: Sequence[str], places: Sequence[int]) -> list[float]:
    values = []
    for name, place in zip(POSE_COLUMNS, places, strict=True):
        text = row[place] if place < len(row) else ""
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InputError(f'{path}: line {number}: {name}: "{text}" (expected a finite number)')
        values.append(value)
    return values
