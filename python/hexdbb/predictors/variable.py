"""What a residual may depend on: each variable of the samples' state, and where the cause would push.

A variable's hypothesis: the residual is the sum of f(value) times a weight over its parts, f any function. The weight
is 1 where the cause would act on the reading itself, else the reading's derivative at the place where it would push
(`pushes.py`). A guideway has two parts, one for each of its sliders: both run over the same rail.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.predictors.columns import SLIDERS, Columns, FloatArray, codes
from hexdbb.predictors.pushes import Pushes

NEVER_S = 1e5
"""Times since a reversal beyond this stand for a reversal that never was."""
DIRECTIONS = ("cw", "ccw")
WAYS = ("moving down", "moving up")
BINS = 36
"""Ten degrees each for the angle."""
COARSE_BINS = 12
SETTLED = 4.0
"""What settles does so to e^-4 over the time of the samples."""
READING = "in the reading"
ALONG = "along the guideway"


@dataclass(frozen=True)
class Variable:
    """One variable of the samples, and where its cause would push.

    Attributes
    ----------
    subject : str
        What it belongs to: ``slider 4``; of several variables of one subject one is named.
    name : str
        In words: ``slider 4 position, each way``.
    unit : str
        Of the values; empty where they are classes.
    parts : tuple of (weight, values)
        Arrays of shape (n,); values are nan where not known.
    pushes : str
        Where, in words.
    apart : (n,) int array or None
        Samples of different numbers are averaged apart: directions, ways of moving.
    names : tuple of str
        What the numbers of `apart` stand for, from 0, where there is something to say.
    bins : int
        So many means at most.
    is_place : bool
        Whether something may sit at one place of a few millimetres: bins are equally wide, and many.
    is_time : bool
        Whether values follow the order of the samples, so that laps do not repeat them.
    signs : tuple of str, optional
        What a positive and a negative push are called.
    """

    subject: str
    name: str
    unit: str
    parts: tuple[tuple[FloatArray, FloatArray], ...]
    pushes: str = READING
    apart: NDArray[np.intp] | None = None
    names: tuple[str, ...] = ()
    bins: int = BINS
    is_place: bool = False
    is_time: bool = False
    signs: tuple[str, str] | None = None


def variables(columns: Columns, pushes: Pushes | None = None) -> Iterator[Variable]:
    """Yield the variables the columns have; one that stands still says nothing and is left out.

    Parameters
    ----------
    columns : dict of str to (n,) arrays
        As `sample_columns` gives them.
    pushes : Pushes, optional
        Without them all act on the reading, and guideways and legs are left out.
    """
    moving = [_of_reading(columns)]
    moving += [_of_slider(columns, k, pushes) for k in SLIDERS]
    if pushes is not None:
        moving += [_of_guideway(columns, g, pushes) for g in range(1, 4)]
        moving += [_of_leg(columns, k, pushes) for k in SLIDERS]
    return (each for group in moving for each in group if _varies(each))


def _varies(variable: Variable) -> bool:
    return any(len(np.unique(values[np.isfinite(values)])) > 1 for _, values in variable.parts)


def _of_reading(columns: Columns) -> Iterator[Variable]:
    one = np.ones(len(columns["t_s"]))
    angle_deg, way = columns["angle_deg"] % 360.0, (columns["direction"] > 0).astype(np.intp)
    circle = circles(columns)

    def read(name: str, unit: str, values: FloatArray) -> Variable:
        return Variable(name, name, unit, ((one, values),))

    yield read("angle", "deg", angle_deg)
    yield Variable("angle", "angle, each direction", "deg", ((one, angle_deg),), apart=way, names=DIRECTIONS)
    yield Variable("angle", "angle, each circle", "deg", ((one, angle_deg),), apart=circle)
    yield read("direction", "", columns["direction"].astype(np.float64))
    yield read("circle", "", circle.astype(np.float64))
    yield read("feed", "mm/min", columns["feed_mm_min"])
    yield Variable("time", "time", "s", ((one, columns["t_s"]),), is_time=True)
    if "temperature_c" in columns:
        yield Variable("temperature", "temperature", "°C", ((one, columns["temperature_c"]),), is_time=True)


def _of_slider(columns: Columns, k: int, pushes: Pushes | None) -> Iterator[Variable]:
    subject, position_mm = f"slider {k}", columns[f"s{k}_mm"]
    weight = np.ones(len(position_mm)) if pushes is None else pushes.slider[:, k - 1]
    where = READING if pushes is None else ALONG
    yield Variable(subject, f"{subject} position", "mm", ((weight, position_mm),), where, is_place=True)
    if f"side{k}" in columns:
        side = columns[f"side{k}"].astype(np.float64)
        way, parts = (side > 0.0).astype(np.intp), ((weight, position_mm),)
        yield Variable(subject, f"{subject} position, each way", "mm", parts, where, way, WAYS)
        yield Variable(subject, f"{subject} way of moving", "", ((weight, side),), where)
        timed = ((weight * side, columns["t_s"]),)
        yield Variable(subject, f"{subject} way of moving, over time", "s", timed, where, is_time=True)
    if f"v{k}_mm_s" in columns:
        yield Variable(subject, f"{subject} velocity", "mm/s", ((weight, columns[f"v{k}_mm_s"]),), where)
    if f"since_reversal{k}_s" in columns:
        since_s = columns[f"since_reversal{k}_s"]
        # Before the first reversal of a sweep nothing is known of the time since one.
        known = np.where(since_s < NEVER_S, since_s, np.nan)
        # What a reversal leaves behind points the other way after the next one.
        turning = weight * columns[f"side{k}"] if f"side{k}" in columns else weight
        yield Variable(subject, f"time since {subject} reversed", "s", ((turning, known),), where)


def _of_guideway(columns: Columns, g: int, pushes: Pushes) -> Iterator[Variable]:
    subject, both = f"guideway {g}", (2 * g - 1, 2 * g)
    passed = (columns["t_s"] - columns["t_s"].min()) / max(float(np.ptp(columns["t_s"])), 1e-9)
    courses = {"growing": passed, "settling": -np.exp(-SETTLED * passed)}
    for way, signs, weights in (
        ("vertical", ("up", "down"), pushes.vertical),
        ("lateral", ("outward", "inward"), pushes.lateral),
    ):
        where = " or ".join(signs)
        parts = tuple((weights[:, k - 1], columns[f"s{k}_mm"]) for k in both)
        place = f"{subject} position ({way})"
        yield Variable(subject, place, "mm", parts, where, is_place=True, signs=signs)
        for course, later in courses.items():
            timed = tuple((weight * (later - later.mean()), values) for weight, values in parts)
            yield Variable(subject, f"{place}, {course} with time", "mm", timed, where, bins=COARSE_BINS)


def _of_leg(columns: Columns, k: int, pushes: Pushes) -> Iterator[Variable]:
    weight, subject = pushes.leg[:, k - 1], f"leg {k}"
    parts = ((weight, columns["t_s"]),)
    yield Variable(subject, f"{subject} length, over time", "s", parts, "in the leg's length", is_time=True)


def circles(columns: Columns) -> NDArray[np.intp]:
    """Number the circles of all records from 0."""
    keys = np.column_stack([codes(columns["record"]), columns["circle"]])
    return np.unique(keys, axis=0, return_inverse=True)[1].ravel()
