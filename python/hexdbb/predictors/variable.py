"""Variables a residual may depend on: each column of the samples' state, and where the cause would push.

A variable's hypothesis: the residual is the sum of f(value) times a weight over its parts, f any function. The weight
is 1 where the cause would act on the reading itself, else the reading's derivative with respect to a push at the place
where it would act (`pushes.py`). A guideway has two parts, one for each of its sliders: both run on the same rail.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.predictors.pushes import Pushes
from hexdbb.samples import Samples
from hexdbb.samples.distinct import distinct_rows

FloatArray = NDArray[np.float64]

SLIDERS = range(1, 7)
TRAVEL_DIRECTION = "travel_direction"
"""Column of the direction in which each slider last moved, +1 or -1; 0 where it never moved."""
SECONDS_PER_MINUTE = 60.0
NEVER_S = 1e5
"""Times since a reversal beyond this stand for a reversal that never was: the engine writes 1e6 s there."""
DIRECTIONS = ("cw", "ccw")
TRAVEL_NAMES = ("moving down", "moving up")
BINS = 36
"""Means at most over a variable: ten degrees each for the angle, in which a low harmonic is nearly straight."""
COARSE_BINS = 12
"""The same for what also changes with time: its means are determined by differences alone."""
SETTLED = 4.0
"""Time constants in the time of the samples, of what settles: 2 % are left at the end."""
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
        In words: ``slider 4 position, each direction of travel``.
    unit : str
        Of the values; empty where they are classes.
    parts : tuple of (weight, values)
        Arrays of shape (n,); values are nan where not known.
    pushes : str
        Where, in words.
    apart : (n,) int array or None
        Samples of different numbers are averaged apart: directions, directions of travel.
    names : tuple of str
        What the numbers of `apart` stand for, from 0, where there is something to say.
    bins : int
        Largest number of means.
    is_place : bool
        Whether something may sit at one place of a few millimetres: bins are equally wide, and many.
    is_time : bool
        Whether values follow the order of the samples, so that laps do not repeat them.
    signs : tuple of str, optional
        Words for a positive and a negative push.
    classes : tuple of (value, name)
        Names of values that are classes, where they have some.
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
    classes: tuple[tuple[float, str], ...] = ()
    needs: str = ""
    """Column of the samples that must have been measured; one that follows time (`is_time`) needs `time_s`."""

    def is_judged(self, unmeasured: frozenset[str]) -> bool:
        """Return whether it needs none of the columns that were not measured (`Samples.unmeasured`)."""
        return self.needs not in unmeasured and not (self.is_time and "time_s" in unmeasured)


def variables(samples: Samples, pushes: Pushes | None = None) -> Iterator[Variable]:
    """Yield the variables of some samples that were measured; one that is constant predicts nothing and is left out.

    Parameters
    ----------
    samples : Samples
    pushes : Pushes, optional
        Without them every cause acts on the reading, and guideways and legs are left out.
    """
    moving = [_of_reading(samples)]
    moving += [_of_slider(samples, k, pushes) for k in SLIDERS]
    if pushes is not None:
        moving += [_of_guideway(samples, g, pushes) for g in range(1, 4)]
        moving += [_of_leg(samples, k, pushes) for k in SLIDERS]
    unmeasured = samples.unmeasured
    return (each for group in moving for each in group if each.is_judged(unmeasured) and _varies(each))


def _varies(variable: Variable) -> bool:
    known = (values[np.isfinite(values)] for _, values in variable.parts)
    return any(len(each) and each.min() < each.max() for each in known)


def _of_reading(samples: Samples) -> Iterator[Variable]:
    one = np.ones(len(samples))
    angle_deg, ccw = np.degrees(samples["angle_rad"]) % 360.0, (samples["direction"] > 0).astype(np.intp)
    circle = circles(samples)

    def read(name: str, unit: str, values: FloatArray) -> Variable:
        return Variable(name, name, unit, ((one, values),))

    yield read("angle", "deg", angle_deg)
    yield Variable("angle", "angle, each direction", "deg", ((one, angle_deg),), apart=ccw, names=DIRECTIONS)
    yield Variable("angle", "angle, each circle", "deg", ((one, angle_deg),), apart=circle)
    senses = ((-1.0, DIRECTIONS[0]), (1.0, DIRECTIONS[1]))
    yield Variable("direction", "direction", "", ((one, samples["direction"]),), classes=senses)
    yield read("circle", "", circle.astype(np.float64))
    yield read("feed", "mm/min", SECONDS_PER_MINUTE * samples["feed_mm_s"])
    yield Variable("time", "time", "s", ((one, samples["time_s"]),), is_time=True)
    yield Variable("temperature", "temperature", "°C", ((one, samples["temperature_c"]),), is_time=True)


def _of_slider(samples: Samples, k: int, pushes: Pushes | None) -> Iterator[Variable]:
    subject, of = f"slider {k}", k - 1
    position_mm, travel = samples["sliders_mm"][:, of], samples[TRAVEL_DIRECTION][:, of]
    weight = np.ones(len(position_mm)) if pushes is None else pushes.slider[:, of]
    where = READING if pushes is None else ALONG
    yield Variable(subject, f"{subject} position", "mm", ((weight, position_mm),), where, is_place=True)
    up, parts = (travel > 0.0).astype(np.intp), ((weight, position_mm),)
    yield Variable(subject, f"{subject} position, each direction of travel", "mm", parts, where, up, TRAVEL_NAMES)
    senses = ((-1.0, "down"), (1.0, "up"))
    yield Variable(subject, f"{subject} direction of travel", "", ((weight, travel),), where, classes=senses)
    timed = ((weight * travel, samples["time_s"]),)
    yield Variable(subject, f"{subject} direction of travel, over time", "s", timed, where, is_time=True)
    moving = ((weight, samples["velocity_mm_s"][:, of]),)
    yield Variable(subject, f"{subject} velocity", "mm/s", moving, where, needs="velocity_mm_s")
    since_s = samples["since_reversal_s"][:, of]
    # Before the first reversal of a sweep nothing is known of the time since one.
    known = np.where(since_s < NEVER_S, since_s, np.nan)
    # What a reversal leaves behind acts the other way after the next one.
    since = ((weight * travel, known),)
    yield Variable(subject, f"time since {subject} reversed", "s", since, where, needs="since_reversal_s")


def _of_guideway(samples: Samples, g: int, pushes: Pushes) -> Iterator[Variable]:
    subject, both = f"guideway {g}", (2 * g - 2, 2 * g - 1)
    time_s, sliders_mm = samples["time_s"], samples["sliders_mm"]
    passed = (time_s - time_s.min()) / max(float(np.ptp(time_s)), 1e-9)
    courses = {"growing": passed, "settling": -np.exp(-SETTLED * passed)}
    for sense, signs, weights in (
        ("vertical", ("up", "down"), pushes.vertical),
        ("lateral", ("outward", "inward"), pushes.lateral),
    ):
        where = " or ".join(signs)
        parts = tuple((weights[:, of], sliders_mm[:, of]) for of in both)
        place = f"{subject} position ({sense})"
        yield Variable(subject, place, "mm", parts, where, is_place=True, signs=signs)
        for course, later in courses.items():
            timed = tuple((weight * (later - later.mean()), values) for weight, values in parts)
            name = f"{place}, {course} with time"
            yield Variable(subject, name, "mm", timed, where, bins=COARSE_BINS, needs="time_s")


def _of_leg(samples: Samples, k: int, pushes: Pushes) -> Iterator[Variable]:
    weight, subject = pushes.leg[:, k - 1], f"leg {k}"
    parts = ((weight, samples["time_s"]),)
    yield Variable(subject, f"{subject} length, over time", "s", parts, "in the leg's length", is_time=True)


def circles(samples: Samples) -> NDArray[np.intp]:
    """Return the number of each sample's circle among those of all records, counted from 0; shape (n,)."""
    return distinct_rows(samples["record"], samples["circle"])[1]
