"""Directions of the unknowns that no reading can tell, as sentences.

A basis of the unidentifiable directions is brought to reduced row echelon form, so that each direction reads "this one
= that combination of others". Unknowns are in units of their expected sizes, coefficients below `SMALL` are left out of
the sentence.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb.model import Parameter

Floats = NDArray[np.float64]

LEVER_MM = 300.0
"""Lever arm by which an angle is compared with a length: about half a guideway."""
SMALL = 0.02
"""Coefficients below this part of a row's largest are left out of its sentence."""
MOST_NAMED = 4


def echelon(directions: Floats) -> tuple[Floats, list[int]]:
    """Reduced row echelon form of directions.

    Parameters
    ----------
    directions : ndarray, shape (unknowns, k)
        Linearly independent columns.

    Returns
    -------
    rows : ndarray, shape (k, unknowns)
        Each with a one at its own pivot and zeros at the others' pivots.
    pivots : list of int
        The unknown of each pivot: the largest entry left, later unknowns first among equals, so that what the thesis
        lists last is explained by what it lists first.
    """
    rows = directions.T.copy()
    pivots: list[int] = []
    for index in range(len(rows)):
        size = np.abs(rows[index:]).max(axis=0)
        size[pivots] = 0.0
        pivot = int(np.flatnonzero(size > 0.9 * size.max())[-1])
        best = index + int(np.argmax(np.abs(rows[index:, pivot])))
        rows[[index, best]] = rows[[best, index]]
        rows[index] /= rows[index, pivot]
        others = np.arange(len(rows)) != index
        rows[others] -= np.outer(rows[others, pivot], rows[index])
        pivots.append(pivot)
    return rows, pivots


def sentences(directions: Floats, parameters: Sequence[Parameter]) -> list[str]:
    """Say in words what cannot be told apart.

    Parameters
    ----------
    directions : ndarray, shape (unknowns, k)
        Unidentifiable directions as columns, unknowns in units of their prior sigma.
    parameters : sequence of Parameter
        The unknowns.
    """
    levers = np.array([LEVER_MM if each.unit == "rad" else 1.0 for each in parameters])
    moves = levers * np.array([each.prior_sigma for each in parameters])
    labels = [each.label for each in parameters]
    rows, pivots = echelon(directions * moves[:, None])
    said = []
    for row, pivot in sorted(zip(rows, pivots, strict=True), key=lambda each: each[1]):
        others = [int(j) for j in np.argsort(-np.abs(row)) if j != pivot and abs(row[j]) > SMALL * np.abs(row).max()]
        if not others:
            said.append(f"{labels[pivot]} changes no reading")
            continue
        named = ", ".join(labels[j] for j in others[:MOST_NAMED])
        more = f" and {len(others) - MOST_NAMED} more" if len(others) > MOST_NAMED else ""
        said.append(f"{labels[pivot]} cannot be told from a combination of {named}{more}")
    return said
