"""How large a fault must be so that, geometry and set-up fitted, as much remains as a case asks for.

Model: remaining(size) is the root mean square of what `fit.fitted` leaves of the noise-free readings of every
`THINNED`-th sample. It grows with the size, nearly in proportion while geometry does not bend, so that a secant on its
logarithm finds the size in two to six fits.
Accuracy: within `NEAR_ENOUGH` of the stated multiple on the thinned samples; what all samples give differs from that by
about 1 % (tests/python/test_truth_forms.py).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from tests.truth.forms.deviation import Formed
from tests.truth.forms.fit import Fitted, fitted, true_values
from tests.truth.forms.measure import Measured, Sized
from tests.truth.forms.ports import Action

from hexdbb.errors import HexdbbError
from hexdbb.rig.geometry import Array

THINNED = 7
"""Every seventh sample: prime to the samples of a lap, so that no place is left out; 1,400 of 10,000 readings."""
NEAR_ENOUGH = 0.01
"""Relative error of the remaining RMS at which the search ends: far below what separates the sizes of a trial."""
MAX_TRIALS = 14


class UnreachableSizeError(Exception):
    """A fault would have to be larger than any machine in use has it, or geometry absorbs it."""


def size_of(
    action: Action, measured: Measured, times_noise: float, start: float, limit: float, others: Sequence[Sized] = ()
) -> float:
    """Return the size at which the remaining RMS is `times_noise` times the gauge's noise.

    Parameters
    ----------
    action : Action
    measured : Measured
        The machine and the plan.
    times_noise : float
    start, limit : float
        Where the search begins, and the largest size that is physical.
    others : sequence of (Action, float)
        Faults that are there as well and are taken as known: their readings are not counted.

    Raises
    ------
    UnreachableSizeError
        Beyond `limit`.
    """
    wanted = times_noise * measured.truth.gauge.noise_um * 1e-3
    known: list[tuple[float, float]] = []
    size, begin, usual = start, None, true_values(measured.truth, len(measured.history.plan.mounts))
    for _ in range(MAX_TRIALS):
        try:
            fit = remaining([(action, size), *others], measured, begin=begin)
        except (HexdbbError, np.linalg.LinAlgError):
            # The machine falls apart, or the gauge is read outside a run: too large.
            limit = min(limit, size)
            size = math.sqrt(size * known[-1][0]) if known else 0.3 * size
            continue
        left = fit.rms_mm
        if abs(left / wanted - 1.0) < NEAR_ENOUGH:
            return size
        known.append((size, max(left, 1e-12)))
        size = min(_next(known, wanted), limit)
        # Geometry bends about in proportion to the fault.
        begin = usual + size / known[-1][0] * (fit.value - usual)
        if size >= limit and any(tried >= limit for tried, _ in known):
            break
    raise UnreachableSizeError(f"{times_noise:g} x noise is beyond {limit:g}")


def remaining(
    actions: Sequence[Sized], measured: Measured, thinned: int = THINNED, begin: Array | None = None
) -> Fitted:
    """Return the fit of the noise-free readings of every `thinned`-th sample by geometry and set-up.

    `begin` has the values to begin with; the machine's own where none are given.
    """
    rows = measured.history.samples[::thinned]
    readings = measured.readings_mm(actions, rows)
    begin = true_values(measured.truth, len(measured.history.plan.mounts)) if begin is None else begin
    return fitted(readings, rows, measured.history, measured.truth.gauge.noise_um * 1e-3, begin)


def shown_deviation(formed: Formed, measured: Measured, size: float) -> float:
    """Return the share of what a fault leaves in the readings that its catalogue formula does not explain.

    To first order about the fit of geometry and set-up, which is taken along. Where geometry absorbs most of the
    formula (straightness, lead) but not of the strange part, it exceeds the deviation at the port.
    """
    rows = measured.history.samples[::THINNED]
    fit, before = remaining([(formed.action(), size)], measured), measured.readings_mm([], rows)
    formulas = (formed.exact, *formed.others)
    columns = []
    for formula in formulas:
        action = Action(formed.port, formed.elements, formula)
        columns.append(measured.readings_mm([(action, size)], rows) - before)
    return fit.rms_with_mm(np.stack(columns, axis=1)) / fit.rms_mm


def _next(known: list[tuple[float, float]], wanted: float) -> float:
    """Return the size to try next, from those tried."""
    below = max((each for each in known if each[1] < wanted), default=None)
    above = min((each for each in known if each[1] >= wanted), default=None)
    if below is not None and above is not None and below[0] < above[0]:
        share = math.log(wanted / below[1]) / math.log(above[1] / below[1])
        return below[0] * (above[0] / below[0]) ** min(max(share, 0.05), 0.95)
    size, left = known[-1]
    return size * min(max(wanted / left, 0.05), 20.0)
