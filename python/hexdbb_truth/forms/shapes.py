"""Shapes that a function of a state may have, drawn: over a range from -1 to 1, or over a turn; RMS about 1."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.family import Draw, signed, waves

Shape = Callable[[Array], Array]


def _bump(draw: Draw) -> Shape:
    at, width, sign = float(draw.uniform(-0.6, 0.6)), float(draw.uniform(0.1, 0.5)), signed(draw)
    return lambda x: np.asarray(2.0 * sign / np.cosh((x - at) / width) ** 2)


def _flank(draw: Draw) -> Shape:
    at, width, sign = float(draw.uniform(-0.5, 0.5)), float(draw.uniform(0.05, 0.4)), signed(draw)
    return lambda x: np.asarray(sign * np.arctan((x - at) / width) * 2.0 / math.pi)


def _kink(draw: Draw) -> Shape:
    at, sign, bend = float(draw.uniform(-0.5, 0.5)), signed(draw), float(draw.uniform(0.3, 2.0))
    return lambda x: np.asarray(sign * (np.maximum(x - at, 0.0) * (1.0 + bend) + bend * np.minimum(x - at, 0.0)))


def _dead_band(draw: Draw) -> Shape:
    half, sign = float(draw.uniform(0.15, 0.5)), signed(draw)
    return lambda x: np.asarray(2.0 * sign * np.sign(x) * np.maximum(np.abs(x) - half, 0.0))


def _polynomial(draw: Draw) -> Shape:
    square, cube, sign = float(draw.uniform(0.4, 1.2)), float(draw.uniform(-1.5, 1.5)), signed(draw)
    return lambda x: np.asarray(sign * (2.0 * square * x**2 + 2.0 * cube * x**3))


def _dying(draw: Draw) -> Shape:
    part, sign = float(draw.uniform(0.15, 0.8)), signed(draw)
    return lambda x: np.asarray(2.0 * sign * np.exp(-(x + 1.0) / part))


def _wave(draw: Draw) -> Shape:
    return waves(draw, 0.5, 2.0)


SHAPES = (_bump, _flank, _kink, _dead_band, _polynomial, _dying, _wave)


def shape_of(draw: Draw) -> Shape:
    """Draw a function over a range."""
    return SHAPES[int(draw.integers(len(SHAPES)))](draw)


def shape_of_turn(draw: Draw) -> Shape:
    """Draw a function of an angle: a narrow dip, or waves of several orders from the third on.

    The first two orders are those of ball, cup and squareness, which a machine's geometry has.
    """
    if draw.uniform() < 0.5:
        at, width, sign = float(draw.uniform(0.0, 2.0 * math.pi)), float(draw.uniform(0.1, 0.5)), signed(draw)
        return lambda angle: np.asarray(3.0 * sign * np.exp((np.cos(angle - at) - 1.0) / width**2))
    orders, phases = draw.integers(3, 9, 2), draw.uniform(0.0, 2.0 * math.pi, 2)
    return lambda angle: np.asarray(sum(np.cos(n * angle + p) for n, p in zip(orders, phases, strict=True)))
