"""Readings as the evidence uses them: plain arrays, whitened, linear about a fitted model.

About a fit the residual answers to the model's own values and to pushes at the engine's ports linearly,

    y = J d + sum over ports of S_port push_port + e,   e ~ N(0, I),   d ~ N(-standing, I),

with y the residual, J and S the derivatives, all divided by the noise of their row, and d the change of the model's
values in prior standard deviations; `standing` is where the fit has left them. A row is one reading, or the mean of a
few neighbouring ones where sampling is dense (`engine.py`).
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import DEFAULT

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

GROUPINGS = ("circle", "feed", "direction", "lap")
"""What may be held out as a whole, in the order in which results are reported."""


class State(dict[str, Floats]):
    """Variables by name, with the designs that were made of them."""

    def __init__(self, columns: Mapping[str, Floats]) -> None:
        super().__init__(columns)
        self.designs: dict[Hashable, Floats] = {}


@dataclass(frozen=True, eq=False)
class Readings:
    """What does not change with the model.

    Attributes
    ----------
    state : mapping of str to ndarray, shape (n,) or (n, 6)
        Variables on which a cause may depend, by name.
    groups : mapping of str to ndarray of int, shape (n,)
        Number of the circle, feed, direction and lap of each row, from 0; `sweep` in order of time.
    noise_mm : ndarray, shape (n,)
        Standard deviation of each row.
    screw_lead_mm : float
        Travel of a slider per turn of its screw.
    """

    state: Mapping[str, Floats]
    groups: Mapping[str, Ints]
    noise_mm: Floats
    screw_lead_mm: float = 5.0

    def __len__(self) -> int:
        return len(self.noise_mm)


@dataclass(frozen=True, eq=False)
class Linear:
    """A fitted model's neighbourhood.

    Attributes
    ----------
    residual : ndarray, shape (n,)
        y, in standard deviations of the noise.
    own : ndarray, shape (n, p)
        J, per prior standard deviation.
    standing : ndarray, shape (p,)
        Values in prior standard deviations.
    pushes : mapping of str to ndarray
        S by place, noise standard deviations per mm: `slider`, `leg`, `lateral`, `vertical` (n, 6), `ball`, `cup`
        (n, 3), `reading` (n, 1), `platform_joint` (n, 18).
    """

    residual: Floats
    own: Floats
    standing: Floats
    pushes: Mapping[str, Floats]

    @property
    def log_evidence(self) -> float:
        """Log marginal likelihood of the fitted model (Laplace; MacKay 1992), but for a constant of the readings."""
        information = self.own.T @ self.own + np.eye(self.own.shape[1])
        fit = float(self.residual @ self.residual) + float(self.standing @ self.standing)
        return -0.5 * (fit + float(np.linalg.slogdet(information)[1]))


class Thinned:
    """Some rows, evenly spread, of all linearisations of the same readings; designs made for one are kept for others.

    Parameters
    ----------
    readings : Readings
    count : int
    """

    def __init__(self, readings: Readings, count: int = DEFAULT.thinned_rows) -> None:
        whole = len(readings)
        self.rows: Ints = np.unique(np.linspace(0, whole - 1, min(whole, count)).astype(np.intp))
        self.readings = Readings(
            State({name: values[self.rows] for name, values in readings.state.items()}),
            {name: numbers[self.rows] for name, numbers in readings.groups.items()},
            readings.noise_mm[self.rows],
            readings.screw_lead_mm,
        )

    def linear(self, linear: Linear) -> Linear:
        """Return the rows of a linearisation."""
        return Linear(
            residual=linear.residual[self.rows],
            own=linear.own[self.rows],
            standing=linear.standing,
            pushes={place: push[self.rows] for place, push in linear.pushes.items()},
        )
