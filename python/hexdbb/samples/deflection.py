"""Deflection of the gauge as geometry predicts it: what errors of the gauge that depend on its reading depend on.

The measured reading is no variable of a cause: a function of it explains whatever is missing, unless it repeats within
so little of the gauge's scale that what is missing does not (`scale_mm`: a scale's lines, its interpolation). The
nominal one is constant on circles of the nominal radius, where errors of geometry and set-up deflect the gauge by
tenths of a millimetre. So the readings are predicted by the machine with its geometry and set-up fitted to them by
steps of Gauss and Newton from the nominal machine. A gauge whose scale bends would bend geometry instead: from the
second step on, polynomials of the deflection are fitted beside it, and only what geometry predicts is the deflection.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.polynomial import Legendre
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.machine import MachineFile
from hexdbb.model import Model, MountKey, new_model

Floats = NDArray[np.float64]

DEFLECTION = "deflection_mm"
SCALE = "gauge_scale_mm"
DIRECTION_AND_TRAVEL = ("deflection_direction", "deflection_since_turn_mm")
TURNING = "deflection_turning_mm"
"""The deflection times the sense in which it changes: what a gauge hangs behind, where it does the more drawn out."""
FITTED_ROWS = 3000
"""Readings that the step is taken from: some tens for each value of geometry and set-up, as in `Criteria.fit_rows`."""
STEPS = 5
"""Steps with polynomials beside: each halves what a gauge that bends by a tenth of its range bends geometry."""
DEGREES = (2, 3, 4, 5)
"""Degrees of the polynomials: enough for a gauge that bends, that saturates, or whose gain differs by its direction."""
BEND_MM = 0.1
"""Prior standard deviation of their coefficients: as large as the deflections that geometry makes."""
LEAST_TURN_MM = 5e-4
"""Way back from which a gauge has turned: several counts of the encoders, far below any deflection."""
NOISE_MM = 1e-3
"""Against which priors count: of tenths of a millimetre, they are the same beside the noise of any gauge."""


def scale_mm(reading_mm: Floats, nominal_mm: Floats) -> Floats:
    """Return where the gauge stood on its scale, shape (n,): as measured, or nominal where samples are planned."""
    return np.where(np.isfinite(reading_mm), reading_mm, nominal_mm)


def deflection_mm(
    machine: MachineFile, mounts: Sequence[MountKey], block: _core.Samples, reading_mm: Floats, nominal_mm: Floats
) -> Floats:
    """Return the reading that geometry and set-up predict, shape (n,).

    Parameters
    ----------
    machine : MachineFile
    mounts : sequence of MountKey
        As the block numbers them.
    block : Samples
        Of the engine.
    reading_mm, nominal_mm : ndarray, shape (n,)
        Measured; of the nominal machine in the nominal set-up, which is returned where samples are planned or where a
        sample has no pose.
    """
    if not np.isfinite(reading_mm).all():
        return nominal_mm
    model = new_model(machine).with_mounts(mounts)
    few = np.unique(np.linspace(0, len(reading_mm) - 1, min(len(reading_mm), FITTED_ROWS)).astype(np.intp))
    rows, measured_mm = block.rows(few), reading_mm[few]
    for degrees in ((), *(STEPS * (DEGREES,))):
        stepped = _stepped(model, rows, measured_mm, degrees)
        if stepped is None:
            return nominal_mm
        model = stepped
    predicted = _core.predict(model.engine(), block)
    return nominal_mm if predicted.first_failure >= 0 else predicted.reading_mm


def _stepped(model: Model, rows: _core.Samples, reading_mm: Floats, degrees: Sequence[int]) -> Model | None:
    """Fit geometry and set-up by one step of Gauss and Newton, polynomials of the deflection as it is beside them.

    None where a sample has no pose.
    """
    predicted = _core.predict(model.engine(), rows, want_jacobian=True)
    if predicted.first_failure >= 0:
        return None
    free, values = np.flatnonzero(model.free), model.values
    prior = model.prior_sigma[free]
    part = predicted.reading_mm / max(float(np.abs(predicted.reading_mm).max()), NOISE_MM)
    bent = [BEND_MM * Legendre.basis(each)(part)[:, None] for each in degrees]
    columns = np.hstack([predicted.jacobian[:, free] * prior, *bent]) / NOISE_MM
    standing = np.concatenate([(values - model.start)[free] / prior, np.zeros(len(bent))])
    gradient = columns.T @ ((reading_mm - predicted.reading_mm) / NOISE_MM) - standing
    step = np.linalg.solve(columns.T @ columns + np.eye(columns.shape[1]), gradient)
    values[free] += prior * step[: len(free)]
    return model.with_values(values)
