"""Deflection of the gauge as geometry predicts it: what errors of the gauge that depend on its reading depend on.

The measured reading is no variable of a cause: a function of it explains whatever is missing. The nominal one is
constant on circles of the nominal radius, where errors of geometry and set-up deflect the gauge by tenths of a
millimetre. So the readings are predicted by the machine with its geometry and set-up fitted to them, one step of Gauss
and Newton from the nominal machine: what is left of second order is a thousandth of the deflection.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.machine import MachineFile
from hexdbb.model import MountKey, new_model

Floats = NDArray[np.float64]

DEFLECTION = "deflection_mm"
FITTED_ROWS = 3000
"""Readings that the step is taken from: some tens for each value of geometry and set-up, as in `Criteria.fit_rows`."""
NOISE_MM = 1e-3
"""Against which priors count: of tenths of a millimetre, they are the same beside the noise of any gauge."""


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
    found = _core.normal_equations(model.engine(), block.rows(few), reading_mm[few])
    if found.failure >= 0:
        return nominal_mm
    free, values = np.flatnonzero(model.free), model.values
    prior = model.prior_sigma[free]
    scale = prior / NOISE_MM * np.sqrt(len(reading_mm) / len(few))
    information = found.information[np.ix_(free, free)] * np.outer(scale, scale) + np.eye(len(free))
    values[free] += prior * np.linalg.solve(information, scale * found.gradient[free] * scale / prior)
    predicted = _core.predict(model.with_values(values).engine(), block)
    return nominal_mm if predicted.first_failure >= 0 else predicted.reading_mm
