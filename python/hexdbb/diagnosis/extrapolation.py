"""Whether held-out circles can be predicted at all: with few circles a cross-validation error is one of extrapolation.

A fit to the other circles knows the model's values with the covariance C = (J'J / s^2 + P^-1)^-1, P the prior
variances; of n readings held out, with derivatives J_0, it then misses

    expected^2 = s^2 + trace(C J_0'J_0) / n

on average, even where the model is true. Where that is far above the noise, a large cross-validation error is evidence
against the plan and not against the model.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis.heldout import MAX_FOLDS, folds
from hexdbb.model import Model
from hexdbb.samples import Samples, normal_equations

Floats = NDArray[np.float64]

EXTRAPOLATION_RATIO = 2.0
"""Expected error over noise above which holding circles out is an extrapolation: then the variance that the fit's own
uncertainty adds is three times that of the noise, and the comparison with the noise has lost its meaning."""


@dataclass(frozen=True)
class ExpectedError:
    """Error to expect of readings held out of the fit, were the model true.

    Attributes
    ----------
    expected_um, noise_um : float
        Root mean square over all readings, each held out once; the noise assumed for one.
    circles : tuple of int
        Those that the others constrain least.
    worst_um : float
        To expect of these.
    """

    expected_um: float
    noise_um: float
    circles: tuple[int, ...]
    worst_um: float

    @property
    def extrapolates(self) -> bool:
        """Whether what is held out is not determined by the rest."""
        return self.expected_um > EXTRAPOLATION_RATIO * self.noise_um

    def sentence(self, found_um: float) -> str:
        """Return why a cross-validation error, `found_um`, means little."""
        named = f"circle{'s' if len(self.circles) > 1 else ''} {', '.join(map(str, self.circles))}"
        return (
            f"held-out circles are extrapolated: without {named} the others do not constrain the machine enough; a true"
            f" model would miss held-out circles by {self.expected_um:.3g} µm ({self.worst_um:.3g} µm the worst),"
            f" {found_um:.3g} µm was found: judge by the fitted error, or measure more circles"
        )


def expected_error(samples: Samples, model: Model, noise_um: float, max_folds: int = MAX_FOLDS) -> ExpectedError | None:
    """Compute the error to expect of held-out circles, dealt as `held_out` deals them.

    Parameters
    ----------
    samples : Samples
    model : Model
        Fitted to them; its free values count.
    noise_um : float
        Standard deviation of one reading.
    max_folds : int
        As for `held_out`.

    Returns
    -------
    ExpectedError or None
        None where there are not two groups of circles, or nothing is free.
    """
    parts = [samples.part(fold) for fold in folds(samples, "circle", max_folds)]
    if len(parts) < 2 or not model.free.any():
        return None
    squares = [_squares(part, model) / (noise_um * 1e-3) ** 2 for part in parts]
    total = np.sum(squares, axis=0) + np.diag(model.prior_sigma[model.free] ** -2.0)
    counts = np.array([len(part) for part in parts])
    unknown = np.array([float(np.trace(np.linalg.solve(total - own, own))) for own in squares])
    each_um = noise_um * np.sqrt(1.0 + unknown / counts)
    worst = int(np.argmax(each_um))
    return ExpectedError(
        expected_um=noise_um * float(np.sqrt(1.0 + unknown.sum() / counts.sum())),
        noise_um=noise_um,
        circles=tuple(int(each) for each in np.unique(parts[worst]["circle"])),
        worst_um=float(each_um[worst]),
    )


def _squares(samples: Samples, model: Model) -> Floats:
    """Return J'J of a model's free values, engine units."""
    information: Floats = normal_equations(samples, model).information
    return information[np.ix_(model.free, model.free)]
