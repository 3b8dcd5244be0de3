"""How large a fault must be so that, geometry and set-up fitted, as much remains as a case asks for.

Model: remaining(size) is the root mean square of what `fit.fitted` leaves of the noise-free readings of every
`THINNED`-th sample. It grows with the size, nearly in proportion while geometry does not bend, so that a secant on its
logarithm finds the size in two to six fits.
Accuracy: within 2 %, at most 5 %, of the stated multiple, RMS of all samples with geometry as fitted to the thinned
ones. `hexdbb diagnose` leaves the same within 3 % for most faults; where geometry bends far (bar_drift, joint_offset,
leg_slips: rotations at their bounds) the two differ by up to 10 %.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from hexdbb.errors import HexdbbError
from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.deviation import Formed
from hexdbb_truth.forms.fit import Fitted, fitted, geometry_readings_mm, true_values
from hexdbb_truth.forms.measure import Measured, Sized
from hexdbb_truth.forms.ports import Action

THINNED = 7
"""Every seventh sample: prime to the samples of a lap, so that no place is left out; 1,400 of 10,000 readings."""
NEAR_ENOUGH, ACCEPTED = 0.02, 0.05
"""Relative error of the remaining RMS at which the search ends, and which is accepted where it does not end: the fit's
own accuracy in a bent valley is 1 %, and sizes of a trial stand apart by factors of 2 and more."""
MAX_TRIALS = 12


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
    usual = true_values(measured.truth, len(measured.history.plan.mounts))
    known: list[tuple[float, float]] = []
    size, begin = start, usual
    for _ in range(MAX_TRIALS):
        actions = [(action, size), *others]
        try:
            fit = remaining(actions, measured, begin=begin)
            left = _rms_of_all(fit, actions, measured)
        except (HexdbbError, np.linalg.LinAlgError):
            # The machine falls apart, or the gauge is read outside a run: too large.
            limit = min(limit, size)
            size, begin = (math.sqrt(size * known[-1][0]) if known else 0.3 * size), usual
            continue
        known.append((size, max(left, 1e-12)))
        if abs(left / wanted - 1.0) < NEAR_ENOUGH or size >= limit:
            break
        size = min(_next(known, wanted), limit)
        # Geometry bends about in proportion to the fault.
        begin = usual + size / known[-1][0] * (fit.value - usual)
    best = min(known, key=lambda each: abs(math.log(each[1] / wanted)), default=(limit, 1e-12))
    if abs(best[1] / wanted - 1.0) > ACCEPTED:
        raise UnreachableSizeError(f"{times_noise:g} x noise is beyond {limit:g}: {best[1] / wanted:.2g} of it")
    return best[0]


def _rms_of_all(fit: Fitted, actions: Sequence[Sized], measured: Measured) -> float:
    """Return what remains of all samples where geometry and set-up are as fitted to some: narrow faults need all."""
    history = measured.history
    readings = measured.readings_mm(actions)
    left = readings - geometry_readings_mm(fit.value, history.samples, history)
    return float(np.sqrt(np.mean(left**2)))


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
        return float(below[0] * (above[0] / below[0]) ** min(max(share, 0.05), 0.95))
    size, left = known[-1]
    return size * min(max(wanted / left, 0.05), 20.0)
