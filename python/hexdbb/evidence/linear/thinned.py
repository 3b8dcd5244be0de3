"""Some rows, evenly spread, on which questions of rank are asked of every hypothesis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.linear.marginal import log_evidences
from hexdbb.evidence.linear.readings import Linear, Readings
from hexdbb.evidence.linear.signatures import Signature, signature_of
from hexdbb.evidence.linear.sums import Sums
from hexdbb.learned import Learned
from hexdbb.threads.copies import in_copies

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
COLUMNS_AT_ONCE = 512
"""Columns of signatures that are multiplied at once: their copies, ten megabytes, are no more than a cache or two, and
more of them gain nothing."""
WORTH_A_COPY = 128
"""Hypotheses that take some ten times as long as the copy of a process that ranks them."""


class Thinned:
    """Some rows of all linearisations of the same readings; signatures made once are kept.

    Parameters
    ----------
    readings : Readings
    count : int
    roughness : float
        Of the prior with which learned functions are ranked.
    keeps : bool
        Whether signatures are kept. Where each serves once, copies of the process make them (`in_copies`).
    """

    def __init__(
        self,
        readings: Readings,
        count: int = DEFAULT.thinned_rows,
        roughness: float = DEFAULT.ranking_roughness,
        *,
        keeps: bool = True,
    ) -> None:
        self._roughness, self._keeps = roughness, keeps
        whole = len(readings)
        self.rows: Ints = np.unique(np.linspace(0, whole - 1, min(whole, count)).astype(np.intp))
        self.readings = Readings(
            readings.state.rows(self.rows),
            {name: numbers[self.rows] for name, numbers in readings.groups.items()},
            readings.noise_mm[self.rows],
            np.asfortranarray(readings.ports[self.rows]),
        )
        self._kept: dict[Learned, Signature] = {}
        self._priors: dict[Learned, tuple[Floats, Floats]] = {}

    def linear(self, linear: Linear) -> Linear:
        """Return the rows of a linearisation."""
        return replace(linear, residual=linear.residual[self.rows], own=linear.own[self.rows])

    def signature(self, hypothesis: Learned) -> Signature:
        """Return a hypothesis' signature on these rows."""
        if hypothesis not in self._kept:
            table = np.empty((len(self.rows), hypothesis.size), np.float32)
            self._kept[hypothesis] = signature_of(hypothesis, self.readings, table=table)
        return self._kept[hypothesis]

    def forget(self) -> None:
        """Release what can be made anew."""
        self._kept.clear()
        self._priors.clear()
        self.readings.state.forget()

    def without_own(self, linear: Linear) -> Floats:
        """Return [J L^-T y'] of the rows of a linearisation (`Training.without_own`)."""
        thin = self.linear(linear)
        return np.column_stack(Sums(thin, self.readings, ()).whole.without_own(thin))

    def scaled(self, hypothesis: Learned) -> Floats:
        """Return a hypothesis' signature times its prior's factor: its coefficients are then equally probable."""
        signature, ranked = self.signature(hypothesis), self._priors.get(hypothesis)
        factor = signature.prior_factor(self._roughness) if ranked is None else ranked[0]
        found: Floats = signature.table @ factor
        return found

    def log_evidences(self, hypotheses: Sequence[Learned], linear: Linear, sizes_mm: Floats, temper: float) -> Floats:
        """Return the log evidence of hypotheses on these rows, with one roughness each (`marginal.py`).

        Parameters
        ----------
        hypotheses : sequence of Learned
        linear : Linear
            Of all rows.
        sizes_mm : ndarray, shape (m,)
        temper : float
        """
        right = self.without_own(linear)

        def found(some: Sequence[Learned]) -> list[float]:
            return [*self._of_some(some, right, sizes_mm, temper)]

        return np.array(found(hypotheses) if self._keeps else in_copies(found, hypotheses, WORTH_A_COPY))

    def _of_some(self, hypotheses: Sequence[Learned], right: Floats, sizes_mm: Floats, temper: float) -> Floats:
        """Return the log evidence of hypotheses; `right`: [J L^-T y'] (`Training.without_own`)."""
        widths = np.array([each.size for each in hypotheses], np.intp)
        found = np.empty(len(hypotheses))
        for width in np.unique(widths):
            same, many = np.flatnonzero(widths == width), max(1, COLUMNS_AT_ONCE // int(width))
            for places in np.split(same, range(many, len(same), many)):
                evidence = self._of_one_width([hypotheses[place] for place in places], right, sizes_mm, temper)
                found[places] = evidence
        return found

    def _of_one_width(self, some: Sequence[Learned], right: Floats, sizes_mm: Floats, temper: float) -> Floats:
        """Return the log evidence of hypotheses of as many functions."""
        width = some[0].size
        tables = np.empty((len(self.rows), len(some) * width))
        parts = np.split(tables, range(width, tables.shape[1], width), axis=1)
        factors, squares = (np.stack(each) for each in zip(*map(self._written, some, parts), strict=True))
        cross = np.matmul(factors.transpose(0, 2, 1), (tables.T @ right).reshape(len(some), -1, right.shape[1]))
        half = cross[:, :, :-1]
        information = squares - np.matmul(half, half.transpose(0, 2, 1))
        return log_evidences(information, cross[:, :, -1], sizes_mm, temper)

    def _written(self, hypothesis: Learned, table: Floats) -> tuple[Floats, Floats]:
        """Write a hypothesis' signature W; return the prior factor T of its functions, and T'W'W T."""
        if not self._keeps:
            return self._prior(signature_of(hypothesis, self.readings, table=table), table)
        kept = self.signature(hypothesis)
        table[:] = kept.table
        if hypothesis not in self._priors:
            self._priors[hypothesis] = self._prior(kept, table)
        return self._priors[hypothesis]

    def _prior(self, signature: Signature, table: Floats) -> tuple[Floats, Floats]:
        factor = signature.prior_factor(self._roughness)
        return factor, factor.T @ (table.T @ table) @ factor
