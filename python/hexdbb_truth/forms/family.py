"""What a family of forms is: how the catalogue's formula is drawn, and the strange parts in their two halves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.ports import Values

Draw = np.random.Generator


@dataclass(frozen=True, eq=False)
class Exact:
    """A catalogue effect at one element, as drawn.

    Attributes
    ----------
    port : str
    elements : tuple of int
        From 0; () for the whole machine at a port of one element.
    formula : Values
    others : tuple of Values
        What more the formula's free parameters can do.
    known : dict
        What strange parts of the same case need: time constants, phases.
    """

    port: str
    elements: tuple[int, ...]
    formula: Values
    others: tuple[Values, ...] = ()
    known: dict[str, float] | None = None


Strange = Callable[[Draw, Exact], Values]
"""Draws a strange part for an effect as drawn."""


@dataclass(frozen=True, eq=False)
class Family:
    """The forms of one effect.

    Attributes
    ----------
    unit : str
        Of size.
    start : float
        A size with which the search for a size begins.
    limit : float
        Largest size that a machine in use has: cases beyond it are not made.
    exact : callable
        Draws the effect.
    calibrate, judge : tuple of callables
        Strange parts: those on which criteria are set, and those on which they are judged.
    plan : str
        The plan that can see it.
    """

    unit: str
    start: float
    limit: float
    exact: Callable[[Draw], Exact]
    calibrate: tuple[Strange, ...]
    judge: tuple[Strange, ...]
    plan: str = "standard"


def slider(draw: Draw) -> int:
    """Draw a slider or leg, from 0."""
    return int(draw.integers(0, 6))


def signed(draw: Draw) -> float:
    """Draw a sign."""
    return float(draw.choice([-1.0, 1.0]))


def unit_vector(draw: Draw, size: int = 3) -> Array:
    """Draw a direction."""
    vector = draw.normal(size=size)
    return np.asarray(vector / np.linalg.norm(vector))


def column(values: Array) -> Array:
    """Return values of one element as a port wants them, shape (n, 1)."""
    return np.asarray(values)[:, None]


def bumpless(draw: Draw, degrees: tuple[int, ...]) -> Callable[[Array], Array]:
    """Draw a low-order Legendre polynomial over -1 to 1, RMS about 1."""
    weights = np.zeros(max(degrees) + 1)
    weights[list(degrees)] = draw.normal(size=len(degrees)) * np.sqrt(2.0 * np.array(degrees) + 1.0)
    weights /= np.sqrt(np.sum(weights**2 / (2.0 * np.arange(len(weights)) + 1.0)))
    return lambda at: np.asarray(np.polynomial.legendre.legval(np.clip(at, -1.3, 1.3), weights), dtype=np.float64)


def waves(draw: Draw, shortest: float, longest: float, terms: int = 2) -> Callable[[Array], Array]:
    """Draw a sum of sine waves of periods in between, RMS about 1, in the argument's unit."""
    periods = np.exp(draw.uniform(np.log(shortest), np.log(longest), terms))
    phases, heights = draw.uniform(0.0, 2.0 * np.pi, terms), unit_vector(draw, terms) * np.sqrt(2.0)

    def sum_of(at: Array) -> Array:
        total = np.zeros_like(at)
        for period, phase, height in zip(periods, phases, heights, strict=True):
            total += height * np.sin(2.0 * np.pi * at / period + phase)
        return total

    return sum_of
