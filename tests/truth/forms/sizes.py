"""How large a fault must be so that, geometry and set-up fitted, as much remains as a case asks for.

Model: remaining(size) is the root mean square of what `fit.remaining_mm` leaves of the noise-free readings of every
`THINNED`-th sample. It grows with the size, nearly in proportion while geometry does not bend, so that a secant on its
logarithm finds the size in two to six fits.
Accuracy: within `NEAR_ENOUGH` of the stated multiple on the thinned samples; what all samples give differs from that by
about 1 % (tests/python/test_truth_forms.py).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from tests.truth.forms.fit import remaining_mm
from tests.truth.forms.measure import Measured, Sized
from tests.truth.forms.ports import Action

from hexdbb.errors import HexdbbError

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
    size = start
    for _ in range(MAX_TRIALS):
        try:
            left = remaining_rms_mm([(action, size), *others], measured)
        except (HexdbbError, np.linalg.LinAlgError):
            # The machine falls apart, or the gauge is read outside a run: too large.
            limit = min(limit, size)
            size = math.sqrt(size * known[-1][0]) if known else 0.3 * size
            continue
        if abs(left / wanted - 1.0) < NEAR_ENOUGH:
            return size
        known.append((size, max(left, 1e-12)))
        size = min(_next(known, wanted), limit)
        if size >= limit and any(tried >= limit for tried, _ in known):
            break
    raise UnreachableSizeError(f"{times_noise:g} x noise is beyond {limit:g}")


def remaining_rms_mm(actions: Sequence[Sized], measured: Measured, thinned: int = THINNED) -> float:
    """Return the root mean square (mm) that geometry and set-up leave of the noise-free readings."""
    rows = measured.history.samples[::thinned]
    readings = measured.readings_mm(actions, rows)
    left = remaining_mm(readings, rows, measured.history, measured.truth.gauge.noise_um * 1e-3)
    return float(np.sqrt(np.mean(left**2)))


def _next(known: list[tuple[float, float]], wanted: float) -> float:
    """Return the size to try next, from those tried."""
    below = max((each for each in known if each[1] < wanted), default=None)
    above = min((each for each in known if each[1] >= wanted), default=None)
    if below is not None and above is not None and below[0] < above[0]:
        share = math.log(wanted / below[1]) / math.log(above[1] / below[1])
        return below[0] * (above[0] / below[0]) ** min(max(share, 0.05), 0.95)
    size, left = known[-1]
    return size * min(max(wanted / left, 0.05), 20.0)
