"""Redundancies that follow from the machine's structure, whatever is measured: known directions with a name.

A move is a direction in the space of the model's values that changes no reading to first order (docs of the geometry:
three translations along a guideway, three rotations about the base centre, six rigid motions of base and cup). Its
`moves` are prescribed; what `follows` is whatever completes it (where the cups stand, how far a midpoint moves): so
the table needs no dimension of the machine. A move counts only where it lies in the null space found, never because
it stands here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from hexdbb.model import Parameter

Floats = NDArray[np.float64]
Key = tuple[str, str, str]
"""Effect, element, name of a value."""

GUIDEWAYS = ("1", "2", "3")
TOLERANCE = 0.02
"""Largest part of a move that may lie outside the null space: a machine with errors turns it by that little."""


@dataclass(frozen=True)
class Redundancy:
    """One move that changes no reading, mm and rad."""

    sentence: str
    moves: Mapping[Key, float]
    follows: frozenset[str | Key] = frozenset()
    """Effects, or single values, that take what value completes the move."""

    def completed_by(self, key: Key) -> bool:
        """Return whether a value may take what value completes the move."""
        return key in self.follows or key[0] in self.follows


def _along_itself(guideway: str) -> Redundancy:
    first, second = str(2 * int(guideway) - 1), str(2 * int(guideway))
    return Redundancy(
        f"translation of guideway {guideway} along itself (y) = common offset of sliders {first} and {second}",
        {
            ("guideway_translation", guideway, "y"): 1.0,
            ("slider_offset", first, "offset"): 1.0,
            ("slider_offset", second, "offset"): 1.0,
        },
    )


def _about_centre(guideway: str) -> Redundancy:
    return Redundancy(
        f"rotation of guideway {guideway} about the base centre"
        " = rotation about its midpoint and a translation along itself (y)",
        {("guideway_rotation_centre", guideway, "angle"): 1.0, ("guideway_rotation_xy", guideway, "angle"): -1.0},
        frozenset({("guideway_translation", guideway, "y")}),
    )


def _local(guideway: str, axis: str) -> Mapping[str, float]:
    """Return the components of a base axis along a guideway's own axes: x outward, y along itself, z up."""
    turn = 2.0 * pi / 3.0 * (int(guideway) - 1)
    return {
        "x": {"x": cos(turn), "y": -sin(turn), "z": 0.0},
        "y": {"x": sin(turn), "y": cos(turn), "z": 0.0},
        "z": {"x": 0.0, "y": 0.0, "z": 1.0},
    }[axis]


def _shift(axis: str) -> Redundancy:
    moves = {
        ("guideway_translation", guideway, name): part
        for guideway in GUIDEWAYS
        for name, part in _local(guideway, axis).items()
    }
    return Redundancy(f"a rigid shift of base and cup along {axis}", moves, frozenset({"cup_position"}))


def _turn(axis: str) -> Redundancy:
    # A turn about the guideway's own line (its y) changes nothing and has no parameter.
    local = {"guideway_rotation_yz": "x", "guideway_rotation_xy": "z"}
    moves = {
        (effect, guideway, "angle"): _local(guideway, axis)[own]
        for guideway in GUIDEWAYS
        for effect, own in local.items()
    }
    follows = frozenset({"cup_position", "guideway_translation"})
    return Redundancy(f"a rigid turn of base and cup about {axis}", moves, follows)


KNOWN: tuple[Redundancy, ...] = (
    *map(_along_itself, GUIDEWAYS),
    *map(_about_centre, GUIDEWAYS),
    *map(_shift, "xyz"),
    *map(_turn, "xyz"),
)


def named_moves(null: Floats, parameters: Sequence[Parameter], levers_mm: Floats) -> list[tuple[Redundancy, Floats]]:
    """Find the known redundancies in a null space.

    Parameters
    ----------
    null : ndarray, shape (values, k)
        Null space as columns, lengths in mm, angles in mm at their lever arm.
    parameters : sequence of Parameter
        The values.
    levers_mm : ndarray, shape (values,)
        Lever arm of an angle, 1 of a length.

    Returns
    -------
    list of (Redundancy, ndarray of shape (values,))
        Those that lie in it, each with its completed move, linearly independent.
    """
    keys = [(each.effect, each.element, each.name) for each in parameters]
    basis, _ = np.linalg.qr(null)
    found: list[tuple[Redundancy, Floats]] = []
    for each in KNOWN:
        move = _completed(each, basis, keys, levers_mm)
        if move is not None and _is_new(move, [vector for _, vector in found]):
            found.append((each, move))
    return found


def _completed(redundancy: Redundancy, basis: Floats, keys: Sequence[Key], levers_mm: Floats) -> Floats | None:
    """Complete a move within the null space; None where it does not lie in it."""
    if any(part and key not in keys for key, part in redundancy.moves.items()):
        return None
    wanted = np.array([redundancy.moves.get(key, 0.0) for key in keys]) * levers_mm
    prescribed = np.array([not redundancy.completed_by(key) for key in keys])
    mix = np.linalg.lstsq(basis[prescribed], wanted[prescribed], rcond=TOLERANCE**2)[0]
    if np.linalg.norm(basis[prescribed] @ mix - wanted[prescribed]) > TOLERANCE * np.linalg.norm(wanted):
        return None
    move: Floats = basis @ mix
    return move


def _is_new(move: Floats, others: Sequence[Floats]) -> bool:
    if not others:
        return True
    stack = np.column_stack(others)
    rest = move - stack @ np.linalg.lstsq(stack, move, rcond=None)[0]
    return bool(np.linalg.norm(rest) > TOLERANCE * np.linalg.norm(move))
