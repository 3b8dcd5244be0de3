"""Mechanisms whose form is the catalogue's but for a stated share.

Model: values at the port p = c + kappa q, c the catalogue's formula, q a mechanism of another form from which has been
taken, by least squares over the samples, what the formula's free parameters and the port's own geometry can do. Then
    deviation = RMS of what of p the formula and geometry cannot do / RMS of what of p geometry cannot do
              = kappa |q| / sqrt(|c'|^2 + kappa^2 |q|^2),
c' being c less its geometry, and kappa follows from the stated deviation in closed form, at any size.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hexdbb.rig.geometry import Array
from hexdbb_truth.forms.ports import Action, Scene, Values, geometry_columns


@dataclass(frozen=True, eq=False)
class Formed:
    """A catalogue effect with a form of its own.

    Attributes
    ----------
    port : str
    elements : tuple of int
        From 0.
    exact : Values
        The catalogue's formula.
    others : tuple of Values
        What more the formula's free parameters can do (cosine beside sine, another time constant).
    odd : Values
        A mechanism of another form.
    deviation : float
        Share of the effect, 0 to below 1, that is not the formula.
    """

    port: str
    elements: tuple[int, ...]
    exact: Values
    others: tuple[Values, ...]
    odd: Values
    deviation: float

    def action(self) -> Action:
        """Return the mechanism as a whole."""
        return Action(self.port, self.elements, self._values)

    def _values(self, scene: Scene, size: float) -> Array:
        exact = self.exact(scene, size)
        if self.deviation == 0.0:
            return exact
        free = self._free(scene.sampled, size)
        odd = self.odd(scene.sampled, size).reshape(-1)
        taken = np.linalg.lstsq(free, odd, rcond=1e-12)[0]
        strange = odd - free @ taken
        shown = without(geometry_columns(self.action(), scene.sampled, exact.shape[1]), self.exact(scene.sampled, size))
        kappa = self.deviation / math.sqrt(1.0 - self.deviation**2) * _rms(shown) / _rms(strange)
        if scene.sampled is not scene:
            free, odd = self._free(scene, size), self.odd(scene, size).reshape(-1)
            strange = odd - free @ taken
        return exact + kappa * strange.reshape(exact.shape)

    def _free(self, scene: Scene, size: float) -> Array:
        values = [self.exact(scene, size), *(other(scene, size) for other in self.others)]
        formula = np.stack([each.reshape(-1) for each in values], axis=1)
        return np.hstack([geometry_columns(self.action(), scene, values[0].shape[1]), formula])


def measured_deviation(formed: Formed, scene: Scene, size: float) -> float:
    """Return the share of a mechanism at its port that is not the catalogue's formula, all samples."""
    scene = scene.sampled
    values = formed.action().values(scene, size)
    geometry = geometry_columns(formed.action(), scene, values.shape[1])
    shown = without(geometry, values)
    formula = [formed.exact(scene, size), *(other(scene, size) for other in formed.others)]
    free = np.hstack([geometry, np.stack([each.reshape(-1) for each in formula], axis=1)])
    return _rms(without(free / np.maximum(np.abs(free).max(axis=0), 1e-300), values)) / _rms(shown)


def without(columns: Array, values: Array) -> Array:
    """Return values, flattened, less their least-squares fit by columns."""
    flat = values.reshape(-1)
    if columns.shape[1] == 0:
        return flat
    return np.asarray(flat - columns @ np.linalg.lstsq(columns, flat, rcond=1e-12)[0])


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
