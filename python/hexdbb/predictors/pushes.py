"""Response of the readings to a push on the machine, sample by sample: it relates a residual to its cause.

Where a slider stands 1 µm off, the gauge reads some part of a micrometre, another part at every pose. A residual caused
by one slider's position is r = s(sample) f(position), s the derivative of the reading with respect to a push at the
slider's port: dividing by s gathers the samples of all circles on one curve f, where a bare mean over the position
mixes them. The derivatives with respect to the model's own free values stand beside it: a fit has removed from the
residual what these values can imitate.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics import engine_machine
from hexdbb.model import Model
from hexdbb.samples import Samples, linearise, port_sensitivity

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Pushes:
    """Derivatives of n readings with respect to pushes at the machine's ports, mm/mm, and to the model's own values.

    Attributes
    ----------
    slider, leg : (n, 6) arrays
        Slider k further along its guideway; leg k longer.
    lateral, vertical : (n, 6) arrays
        The joint on slider k outward and up, across its guideway.
    ball, cup : (n, 3) arrays
        Platform frame and base frame.
    own : (n, p) array
        The model's free values, each times its prior standard deviation: mm per standard deviation.
    standing : (p,) array
        These values, in prior standard deviations: a fit balances the readings against them.
    """

    slider: Floats
    leg: Floats
    lateral: Floats
    vertical: Floats
    ball: Floats
    cup: Floats
    own: Floats
    standing: Floats

    @classmethod
    def of(cls, samples: Samples, model: Model) -> Pushes:
        """Compute the derivatives for samples of a model's machine; all mounts must be known to the model."""
        ports = port_sensitivity(samples, model)
        sizes = np.array([each.prior_sigma for each in model.parameters()])
        free = np.flatnonzero(model.free)
        own = np.take(linearise(samples, model).jacobian, free, axis=1) * sizes[free]
        machine = engine_machine(model.machine)
        across = np.array([_core.guideway_axes(machine, slider // 2) for slider in range(6)])
        local = np.einsum("nki,kij->nkj", ports["slider_joint"], across)
        return cls(
            slider=ports["slider"],
            leg=ports["leg"],
            lateral=local[..., 0],
            vertical=local[..., 2],
            ball=ports["ball"],
            cup=ports["cup"],
            own=own,
            standing=(model.values / sizes)[free],
        )
