"""Is anything missing that matters? Significance and size of what a trial leaves, told apart.

Significance is the test of level and shape that a diagnosis uses too (`FitTest`), on the residual with the forms of the
effects in the model explained: an effect whose form differs by no more than its prior allows lacks nothing. What
matters is a part of the noise or of the reading error, whichever is larger, unless the user states it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hexdbb.diagnosis import Noise
from hexdbb.discovery.lack_of_fit import FitTest, LackOfFit
from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.engine import Engine
from hexdbb.evidence.trial import Trial, Trials


@dataclass(frozen=True)
class Sufficiency:
    """How much a trial leaves.

    Attributes
    ----------
    lack : LackOfFit
        Whether it is significant.
    unexplained_um : float
        RMS beyond the noise.
    matters_um : float
        What matters.
    form_um : float
        What the forms of the effects in the model may leave.
    """

    lack: LackOfFit
    unexplained_um: float
    matters_um: float
    form_um: float

    @property
    def is_sufficient(self) -> bool:
        """Whether nothing is missing, or nothing that matters."""
        small = self.unexplained_um < max(self.matters_um, self.form_um)
        # Below the least that the test of level can tell from noise, a user's smaller tolerance cannot be judged by it.
        return small or (not self.lack.is_significant and self.lack.noise_um * LEAST_TOLD <= self.matters_um)


LEAST_TOLD = 0.25
"""Part of the noise from which an unexplained RMS is significant: `LEVEL_SIGMAS` times the doubt of repeated laps."""


def sufficiency(trial: Trial, trials: Trials, criteria: Criteria, matters_um: float | None = None) -> Sufficiency:
    """Test what a trial leaves."""
    engine = trials.engine
    linear = trials.linear(trial)
    row_mm = engine.row_noise_mm
    noise = Noise(float(np.mean(row_mm)), engine.noise.source)
    strength = np.linalg.eigvalsh(linear.own.T @ linear.own)
    fitted = float(np.sum(strength / (1.0 + strength)))
    lack = FitTest(engine.part, noise).of(linear.residual * row_mm, round(fitted))
    return Sufficiency(
        lack,
        float(np.sqrt(max(trial.left - 1.0, 0.0))) * noise.sigma_mm * 1e3,
        matters(engine, criteria) if matters_um is None else matters_um,
        criteria.form_sigma * float(np.sqrt(trials.explained_before)) * noise.sigma_mm * 1e3,
    )


def matters(engine: Engine, criteria: Criteria) -> float:
    """Return the unexplained RMS, um, below which nothing matters by default."""
    error_mm = engine.reading_mm - engine.part["nominal_reading_mm"]
    explained_um = float(np.std(error_mm)) * 1e3
    return max(criteria.matters_of_noise * engine.noise.sigma_mm * 1e3, criteria.matters_of_explained * explained_um)
