"""Whether circles left out can be predicted at all: with few circles a held-out error is one of extrapolation.

A fit to the other circles knows the model's values with the covariance C = (J'J / s^2 + P^-1)^-1, P the expected
sizes; of n readings left out, with derivatives J_0, it then misses

    expected^2 = s^2 + trace(C J_0'J_0) / n

on average, even where the model is true. Where that is far above the noise, a large held-out error accuses the plan and
not the model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis.heldout import MOST_FOLDS, folds
from hexdbb.model import Model
from hexdbb.record import Record
from hexdbb.samples import samples_of

Floats = NDArray[np.float64]

FAR_ABOVE = 2.0
"""Expected error over noise beyond which leaving circles out is an extrapolation."""


@dataclass(frozen=True)
class Foretold:
    """Error to expect of readings left out of the fit, were the model true.

    Attributes
    ----------
    expected_um, noise_um : float
        Root mean square over all readings, each left out once; the noise taken for one.
    circles : tuple of int
        Those that the others tell least about.
    worst_um : float
        To expect of these.
    """

    expected_um: float
    noise_um: float
    circles: tuple[int, ...]
    worst_um: float

    @property
    def extrapolates(self) -> bool:
        """Whether what is left out is not told by the rest."""
        return self.expected_um > FAR_ABOVE * self.noise_um

    def sentence(self, seen_um: float) -> str:
        """Say why a held-out error says little, given the one that was seen."""
        named = f"circle{'s' if len(self.circles) > 1 else ''} {', '.join(map(str, self.circles))}"
        return (
            f"held-out circles are extrapolated: with {named} left out the others tell too little of the machine; a"
            f" true model would miss the circles left out by {self.expected_um:.3g} um ({self.worst_um:.3g} um the"
            f" worst), {seen_um:.3g} um was seen: judge by the fitted error, or measure more circles"
        )


def foretold(records: Sequence[Record], model: Model, noise_um: float, most_folds: int = MOST_FOLDS) -> Foretold | None:
    """Compute the error to expect of circles left out, dealt as `held_out` deals them.

    Parameters
    ----------
    records : sequence of Record
    model : Model
        Fitted to them; its free values count.
    noise_um : float
        Standard deviation of one reading.
    most_folds : int
        As for `held_out`.

    Returns
    -------
    Foretold or None
        None where there are not two groups of circles, or nothing is free.
    """
    left_out = folds(records, "circle", most_folds)
    if len(left_out) < 2 or not model.free.any():
        return None
    parts = [[record.part(rows) for record, rows in zip(records, fold, strict=True) if rows.any()] for fold in left_out]
    squares = [_squares(part, model) / (noise_um * 1e-3) ** 2 for part in parts]
    sizes = np.array([each.prior_sigma for each in model.parameters()])[model.free]
    total = np.sum(squares, axis=0) + np.diag(sizes**-2.0)
    counts = np.array([sum(len(record) for record in part) for part in parts])
    unknown = np.array([float(np.trace(np.linalg.solve(total - own, own))) for own in squares])
    each_um = noise_um * np.sqrt(1.0 + unknown / counts)
    worst = int(np.argmax(each_um))
    return Foretold(
        expected_um=noise_um * float(np.sqrt(1.0 + unknown.sum() / counts.sum())),
        noise_um=noise_um,
        circles=tuple(sorted({int(each) for record in parts[worst] for each in np.unique(record.columns["circle"])})),
        worst_um=float(each_um[worst]),
    )


def _squares(records: Sequence[Record], model: Model) -> Floats:
    """J'J of a model's free values, engine units."""
    samples = samples_of(records, model)
    measured = np.concatenate([record.reading_mm for record in records])
    information: Floats = _core.normal_equations(model.engine(samples), samples, measured).information
    return information[np.ix_(model.free, model.free)]
