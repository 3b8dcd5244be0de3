"""Learned functions as tables that a controller evaluates: linear between the knots, held beyond them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.compensation.probe import ranges
from hexdbb.kinematics.screw import TURN, turns
from hexdbb.machine import MachineFile
from hexdbb.model import Term

Floats = NDArray[np.float64]

TOLERANCE_MM = 1e-5
"""Largest deviation of a table from its function half-way between two knots: a tenth of an encoder count, below what a
drive can follow."""
MOST_HALVINGS = 6
"""Bound on the size of a file: the knots of a learned function lie at least three to a spline, where six halvings leave
less than a thousandth of what a cubic bends between two of them."""
SWITCHED_PART = 0.1
"""Part of a drive's largest velocity, or a joint's, over which a smoothed change of sign may extend: a table switches
it, so that slower motion is corrected too much."""
KNOTS_PER_TURN = 16
"""Knots for each turn of a screw, before intervals are halved: straight lines between 16 of them deviate from a sine by
at most 2 % of its amplitude, so that no halving sees equal values at both ends and the middle of a whole turn."""


class NoTableError(Exception):
    """An effect that is no table; the message is the reason, as a compensation file states it."""


def learned_tables(term: Term, machine: MachineFile) -> list[_core.CompensationTable]:
    """Return the tables of a learned effect's term, one a function, knots close enough for `TOLERANCE_MM`.

    Raises
    ------
    NoTableError
        Where a smoothed change of sign extends over rates at which the machine moves.
    """
    effect = term.learned
    assert effect is not None
    space, tables = effect.space, effect.tables(term.values, machine)
    fastest = ranges(machine)
    for each in tables:
        if each.rate and each.turns_over > SWITCHED_PART * fastest[each.rate][1]:
            raise NoTableError(f"changes its sign over {each.turns_over:g} of {each.rate}, too gradually for a table")
    parts = effect.coefficients(term.values).reshape(len(tables), -1)

    times, lead_mm = tables[-1].times, machine.sliders.screw_lead_mm

    def values_mm(at: Floats) -> Floats:
        found: Floats = space.functions(at) @ parts.T
        # A screw's turn follows from the slider's position: a controller needs no column of it.
        return found * turns(at, lead_mm)[times][:, None] if times in TURN else found

    # What multiplies makes the error between two knots as much larger as it is itself.
    largest = max(map(abs, fastest.get(times, (1.0, 1.0))))
    first = np.array(tables[0].knots)
    knots = halved(_with_turns(first, lead_mm) if times in TURN else first, values_mm, TOLERANCE_MM / largest)
    return [
        _core.CompensationTable(
            effect=effect.name,
            port=table.port,
            variable=table.column,
            times="" if times in TURN else table.times,
            period=table.period,
            pushes=within_port(table.port, table.pushes),
            knots=knots.tolist(),
            values_mm=column.tolist(),
        )
        for table, column in zip(tables, values_mm(knots).T, strict=True)
    ]


def _with_turns(knots: Floats, lead_mm: float) -> Floats:
    """Return so many knots that no turn of a screw is missed.

    A screw turns on where its function is held: they go on by a turn, which no correction exceeds.
    """
    first, last = knots[0] - lead_mm, knots[-1] + lead_mm
    return np.linspace(first, last, 1 + int(np.ceil(KNOTS_PER_TURN * (last - first) / lead_mm)))


def within_port(port: str, pushes: Sequence[tuple[int, Sequence[tuple[int, float]]]]) -> list[tuple[int, int, float]]:
    """Return element, column counted within the port, and weight of every push."""
    first = _core.PORTS[port][0]
    return [(element, column - first, weight) for element, columns in pushes for column, weight in columns]


def halved(knots: Floats, values_mm: Callable[[Floats], Floats], tolerance: float = TOLERANCE_MM) -> Floats:
    """Return the knots with all intervals halved until lines between them are close enough; equal ones stay equal.

    Parameters
    ----------
    knots : ndarray, shape (m,)
    values_mm : callable
        The functions at some places, shape (m, functions).
    tolerance : float
        Largest deviation half-way between two knots, in their unit.
    """
    for _ in range(MOST_HALVINGS if len(knots) > 1 else 0):
        middle, ends = 0.5 * (knots[1:] + knots[:-1]), values_mm(knots)
        if np.abs(values_mm(middle) - 0.5 * (ends[1:] + ends[:-1])).max() <= tolerance:
            break
        knots = np.sort(np.concatenate([knots, middle]))
    return knots
