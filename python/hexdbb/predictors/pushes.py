"""How the reading answers to a push on the machine, sample by sample: what turns a residual into a cause.

A slider that stands 1 µm off is seen by the gauge as some part of a micrometre, another part at every pose. A residual
that one slider's place causes is r = s(sample) f(place), s the derivative of the reading at the slider's port: dividing
by s gathers the samples of all circles on one curve f, where a bare mean over the place mixes them up. What the model's
own free values do to the readings stands beside it: a fit has taken from the residual what they could imitate.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.effects.shapes import SHAPES
from hexdbb.model import Model

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Pushes:
    """Derivatives of n readings at the places where something can push, mm per mm, and at the model's own values.

    Attributes
    ----------
    slider, leg : (n, 6) arrays
        Slider k further along its guideway; leg k longer.
    lateral, vertical : (n, 6) arrays
        The joint on slider k outward and up, across its guideway.
    ball, cup : (n, 3) arrays
        Platform frame and base frame.
    own : (n, p) array
        The model's free values, each times its expected size: mm per expected size.
    standing : (p,) array
        Where these values stand, in expected sizes: a fit balances the readings against them.
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
    def of(cls, model: Model, samples: _core.Samples) -> Pushes:
        """Compute them for samples of a model's machine."""
        engine = model.engine(samples)
        every = _core.port_sensitivity(engine, samples)
        sizes = np.array([each.prior_sigma for each in model.parameters()])
        own = _core.predict(engine, samples, want_jacobian=True).jacobian * sizes
        widths = [int(np.prod(shape, dtype=int)) for shape in SHAPES.values()]
        parts = dict(zip(SHAPES, np.split(every, np.cumsum(widths)[:-1], axis=1), strict=True))
        joint = parts["slider_joint"].reshape(-1, 6, 3)
        across = np.array([_core.guideway_axes(slider // 2) for slider in range(6)])
        local = np.einsum("nki,kij->nkj", joint, across)
        return cls(
            slider=parts["slider"],
            leg=parts["leg"],
            lateral=local[..., 0],
            vertical=local[..., 2],
            ball=parts["ball"],
            cup=parts["cup"],
            own=own[:, model.free],
            standing=(model.values / sizes)[model.free],
        )

    @classmethod
    def joined(cls, parts: list[Pushes]) -> Pushes:
        """Put those of one model's records one after another."""
        of_samples = [field.name for field in fields(cls) if field.name != "standing"]
        joined = {name: np.concatenate([getattr(each, name) for each in parts]) for name in of_samples}
        return cls(**joined, standing=parts[0].standing)
