"""Circular tests as G-code: LinuxCNC's own arcs, in both directions, with the compensation off and then on.

Model: the ball is at position + R ball_offset, so that a circle of the ball about the cup is a circle of the position
about cup - R ball_offset in the same plane. An arc covers one and a half turns from angle pi: the evaluated turn with a
quarter turn of overshoot before and after it.
The program ends with short moves, each after a stop: LinuxCNC then requests the joints of an end point near the present
one, which must not be mistaken for motion.
Tags: analogue output 0 holds the number of the arc while it is driven, otherwise 0.
Units: mm, deg; feed mm/min.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.rig.geometry import rotation_rpy

FEED_MM_MIN = 9000.0
BALL_OFFSET_MM = (0.0, 0.0, 60.0)
SHORT_MOVES_TAG = 100
SHORT_MOVE_MM = 0.5
SHORT_MOVES_FEED_MM_MIN = 60.0
SETTLE_S = 0.8
"""Pause for the compensation to fade in, s: 500 servo periods of 1 ms and a margin."""


@dataclass(frozen=True)
class Circle:
    """A horizontal circle of the ball about a cup, with the platform held at an orientation."""

    name: str
    cup_mm: tuple[float, float, float]
    radius_mm: float
    platform_rpy_deg: tuple[float, float, float]

    @property
    def rotation(self) -> NDArray[np.float64]:
        """Rotation of the platform, shape (3, 3)."""
        return rotation_rpy(*np.radians(self.platform_rpy_deg))

    @property
    def centre_mm(self) -> NDArray[np.float64]:
        """Centre of the circle of the platform position, mm, shape (3,)."""
        return np.array(self.cup_mm) - self.rotation @ np.array(BALL_OFFSET_MM)


@dataclass(frozen=True)
class Arc:
    """One arc of the program; `tag` is its number, `direction` +1 counter-clockwise."""

    tag: int
    circle: Circle
    direction: int
    is_compensated: bool


STANDARD = Circle("standard, level", (0.0, 0.0, 340.0), 100.0, (0.0, 0.0, 0.0))
UNSEEN = Circle("unseen: lower, smaller, tilted", (5.0, -5.0, 330.0), 90.0, (6.0, -4.0, -8.0))
CIRCLES = (STANDARD, UNSEEN)


def arcs() -> list[Arc]:
    """Return the arcs in the order in which they are driven."""
    kinds = [(circle, way, on) for on in (False, True) for circle in CIRCLES for way in (1, -1)]
    return [Arc(tag, *kind) for tag, kind in enumerate(kinds, start=1)]


def program() -> str:
    """Return the whole program; it ends with the compensation on and the platform on the last circle."""
    lines = ["G21 G90 G17 G94 G61 G40 G49 G80", "M65 P0", "M68 E0 Q0", f"F{FEED_MM_MIN:g}"]
    is_on = False
    for arc in arcs():
        if arc.is_compensated != is_on:
            is_on = arc.is_compensated
            lines += ["M64 P0", f"G4 P{SETTLE_S:g}"]
        lines += _arc_lines(arc)
    return "\n".join([*lines, *_short_moves(), "G4 P0.1", "M2", ""])


def _arc_lines(arc: Arc) -> Iterator[str]:
    x, y, z = arc.circle.centre_mm
    a, b, c = arc.circle.platform_rpy_deg
    radius = arc.circle.radius_mm
    yield f"(arc {arc.tag}: {arc.circle.name}, {arc.direction:+d})"
    yield f"G0 X{x - radius:.9f} Y{y:.9f} Z{z:.9f} A{a:g} B{b:g} C{c:g}"
    yield "G4 P0.2"
    yield f"M68 E0 Q{arc.tag}"
    # P2: end at the second crossing of the end point, after one and a half turns.
    yield f"{'G3' if arc.direction > 0 else 'G2'} X{x + radius:.9f} Y{y:.9f} I{radius:.9f} J0 P2"
    yield "M68 E0 Q0"


def _short_moves() -> Iterator[str]:
    yield f"M68 E0 Q{SHORT_MOVES_TAG}"
    for _ in range(6):
        yield f"G91 G1 F{SHORT_MOVES_FEED_MM_MIN:g} Y{SHORT_MOVE_MM:g}"
        yield "G4 P0.05"
    yield "G90"
    yield "M68 E0 Q0"
