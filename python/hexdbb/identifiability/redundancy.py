"""Redundant combinations of the unknowns, which change no reading, as sentences.

Those that follow from the machine's structure are named as such (`structure`). A basis of the directions that remain
is brought to reduced row echelon form, so that each reads "this one = that combination of others". Unknowns are in
units of their prior sigma, coefficients below `SMALL` are left out of the sentence.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb.identifiability.structure import Displacements, redundancies
from hexdbb.model import Parameter

Floats = NDArray[np.float64]

KNOWN_PART = 0.2
"""Posterior over prior standard deviation up to which a value is identifiable: the prior's weight is then under 4 %."""
LEVER_MM = 300.0
"""Lever arm by which an angle is compared with a length: about half a guideway, whose end an angle moves so."""
SMALL = 0.02
"""Coefficients below this part of a row's largest are left out of its sentence: they stem from the
machine's errors."""
MAX_NAMED = 4
"""Values named in a sentence, the others are counted: more are not read."""


def echelon(directions: Floats) -> tuple[Floats, list[int]]:
    """Compute the reduced row echelon form of directions.

    Parameters
    ----------
    directions : ndarray, shape (unknowns, k)
        Linearly independent columns.

    Returns
    -------
    rows : ndarray, shape (k, unknowns)
        Each with a one at its own pivot and zeros at the others' pivots.
    pivots : list of int
        The unknown of each pivot: the one that the directions left move most, later unknowns first among near equals,
        so that what the thesis lists last is explained by what it lists first. How much they move an unknown does not
        depend on the basis that spans them, hence neither does the choice.
    """
    rows = directions.T
    left: Floats = np.linalg.qr(directions)[0]
    pivots: list[int] = []
    for _ in range(len(rows)):
        size = np.linalg.norm(left, axis=1)
        size[pivots] = 0.0
        pivot = int(np.flatnonzero(size > 0.9 * size.max())[-1])
        unit = left[pivot] / size[pivot]
        left -= (left @ unit)[:, None] * unit
        pivots.append(pivot)
    reduced = np.linalg.solve(rows[:, pivots], rows)
    return reduced.astype(np.float64), pivots


def sentences(directions: Floats, parameters: Sequence[Parameter], displaced: Displacements) -> list[str]:
    """Return in words what is not identifiable, what follows from the machine's structure first.

    Parameters
    ----------
    directions : ndarray, shape (unknowns, k)
        Unidentifiable directions as columns, unknowns in units of their prior sigma.
    parameters : sequence of Parameter
        The unknowns.
    displaced : Displacements
        What they displace.
    """
    levers = np.array([LEVER_MM if each.unit == "rad" else 1.0 for each in parameters])
    moves_mm = directions * (levers * np.array([each.prior_sigma for each in parameters]))[:, None]
    named = redundancies(moves_mm, parameters, levers, displaced) if directions.size else []
    said = [each.sentence for each in named]
    machine = np.array([not each.is_set_up for each in parameters])
    rest = _beside(moves_mm, [each.move * machine for each in named])
    return said + (_generic(rest, [each.label for each in parameters]) if rest.shape[1] else [])


def _beside(moves_mm: Floats, named: Sequence[Floats]) -> Floats:
    """Return the directions that remain, free of one value of the machine in each named move: none is named twice.

    Returns
    -------
    ndarray, shape (unknowns, k - named)
    """
    if not named:
        return moves_mm
    _, own = echelon(np.column_stack(named))
    _, _, mixes = np.linalg.svd(moves_mm[own])
    rest: Floats = moves_mm @ mixes[len(own) :].T
    return rest


def _generic(moves_mm: Floats, labels: Sequence[str]) -> list[str]:
    rows, pivots = echelon(moves_mm)
    said = []
    for row, pivot in sorted(zip(rows, pivots, strict=True), key=lambda each: each[1]):
        amounts = np.abs(row) / np.abs(row).max()
        # Equal amounts of a symmetric machine differ by rounding only: then in the order of the model.
        largest = np.argsort(-amounts.round(6), kind="stable")
        others = [int(j) for j in largest if j != pivot and amounts[j] > SMALL]
        if not others:
            said.append(f"{labels[pivot]} changes no reading")
            continue
        named = ", ".join(labels[j] for j in others[:MAX_NAMED])
        more = f" and {len(others) - MAX_NAMED} more" if len(others) > MAX_NAMED else ""
        said.append(f"{labels[pivot]} is confounded with a combination of {named}{more}")
    return said
