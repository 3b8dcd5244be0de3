"""Some rows, evenly spread, on which questions of rank are asked of every hypothesis."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.readings import Linear, Readings
from hexdbb.evidence.signatures import Signature, signature_of
from hexdbb.evidence.sums import Block, Sums
from hexdbb.learned import Learned

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]


class Thinned:
    """Some rows of all linearisations of the same readings; signatures made once are kept.

    Parameters
    ----------
    readings : Readings
    count : int
    """

    def __init__(self, readings: Readings, count: int = DEFAULT.thinned_rows) -> None:
        whole = len(readings)
        self.rows: Ints = np.unique(np.linspace(0, whole - 1, min(whole, count)).astype(np.intp))
        self.readings = Readings(
            readings.state.rows(self.rows),
            {name: numbers[self.rows] for name, numbers in readings.groups.items()},
            readings.noise_mm[self.rows],
            readings.ports[self.rows],
        )
        self._kept: dict[Learned, Signature] = {}
        self._squares: dict[Learned, Floats] = {}

    def linear(self, linear: Linear) -> Linear:
        """Return the rows of a linearisation."""
        return replace(linear, residual=linear.residual[self.rows], own=linear.own[self.rows])

    def signature(self, hypothesis: Learned) -> Signature:
        """Return a hypothesis' signature on these rows."""
        if hypothesis not in self._kept:
            found = signature_of(hypothesis, self.readings)
            self._kept[hypothesis] = replace(found, table=found.table.astype(np.float32))
        return self._kept[hypothesis]

    def block(self, hypothesis: Learned, sums: Sums) -> Block:
        """Return the sums of a hypothesis' signature with a linearisation of these rows; those with itself are kept."""
        table = self.signature(hypothesis).table.astype(np.float64)
        if hypothesis not in self._squares:
            self._squares[hypothesis] = table.T @ table
        return Block(self._squares[hypothesis][None], sums.cross(table))
