"""Is the model sufficient? What it leaves unexplained, whether that is significant, and whether it matters.

Significance and size are two questions: with 20,000 readings a hundredth of a micrometre is significant. `diagnose`
warns by this answer, `discover` gives its verdict `none` by it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis.glitches import bridged, glitches_in
from hexdbb.diagnosis.judging import JudgingNoise, judging_noise
from hexdbb.diagnosis.lack_of_fit import FitTest, LackOfFit
from hexdbb.model import Model
from hexdbb.samples import Samples, predict
from hexdbb.samples.distinct import distinct_rows, rows_by_number

if TYPE_CHECKING:
    from hexdbb.diagnosis.json_form import SufficiencyJson

Floats = NDArray[np.float64]

MATTERS_OF_NOISE = 0.25
"""Unexplained RMS over the noise of one reading below which it does not matter: it raises the RMS of single readings by
3 %, which is how well a gauge's noise is known where it is stated."""
MATTERS_OF_EXPLAINED = 0.001
"""The same over the reading error that the model explains: of an error of which a thousandth is left, the next
recording of the same machine changes more."""
EXPLAINED_ROWS = 1000
"""Evenly spaced readings of which the reading error that a model explains is the RMS: it is smooth along a circle, and
of 20,000 readings of a plan of seven circles, 1,000 yield it to a part of a thousand. It decides nothing finer than
`MATTERS_OF_EXPLAINED`."""
NO_CHANCE = 1e-16
"""Probabilities below this are rounding errors of one."""


@dataclass(frozen=True)
class Sufficiency:
    """Whether a model is sufficient for some samples.

    Attributes
    ----------
    lack_of_fit : LackOfFit
    matters_um : float
        Unexplained RMS from which it matters.
    is_steady : bool
        False where laps differ by more than noise: what no lap shares with the next no model explains.
    """

    lack_of_fit: LackOfFit
    matters_um: float
    is_steady: bool = True

    @property
    def is_significant(self) -> bool:
        """Whether what is left differs from noise."""
        return self.lack_of_fit.is_significant

    @property
    def matters(self) -> bool:
        """Whether what is left is both significant and large enough."""
        return self.is_significant and self.lack_of_fit.unexplained_um >= self.matters_um

    @property
    def is_sufficient(self) -> bool:
        """Whether nothing that matters is missing."""
        return self.is_steady and not self.matters

    @property
    def sentence(self) -> str:
        """The answer in words: ``0.09 µm unexplained, significant (p < 1e-16), below the 0.13 µm that matter here``."""
        lack = self.lack_of_fit
        if not self.is_significant:
            return f"what is left is noise ({lack.rms_um:.2f} µm RMS, noise {lack.noise_um:.2f} µm)"
        reason = p_words(lack.shape_p) if lack.shape_p < 1e-4 else f"{lack.level:.0f} standard deviations"
        side = "above" if self.matters else "below"
        return (
            f"{lack.unexplained_um:.2f} µm unexplained, significant ({reason}),"
            f" {side} the {self.matters_um:.2f} µm that matter here"
        )

    def to_json(self) -> SufficiencyJson:
        """Return the object as commands print it."""
        from hexdbb.diagnosis.json_form import SufficiencyJson  # only --json needs it

        lack = self.lack_of_fit
        return SufficiencyJson(
            sufficient=self.is_sufficient,
            significant=self.is_significant,
            unexplained_um=lack.unexplained_um,
            matters_um=self.matters_um,
            level=lack.level,
            whiteness_p=lack.shape_p,
            sentence=self.sentence,
        )


def assess_sufficiency(
    samples: Samples,
    model: Model,
    residual_mm: Floats,
    *,
    noise: JudgingNoise | None = None,
    matters_um: float | None = None,
    test: FitTest | None = None,
    alone: NDArray[np.bool_] | None = None,
) -> Sufficiency:
    """Judge what a fitted model leaves, but for readings that stand alone (`hexdbb.diagnosis.glitches`).

    Parameters
    ----------
    samples : Samples
    model : Model
        Fitted to them.
    residual_mm : ndarray, shape (n,)
        Measured minus predicted.
    noise : JudgingNoise, optional
        Estimated from the samples where not given.
    matters_um : float, optional
        Unexplained RMS from which it matters; `default_matters_um` where not given.
    test : FitTest, optional
        Prepared for the samples and the noise.
    alone : ndarray of bool, shape (n,), optional
        Readings that stand alone in this residual, against this noise, where they were looked for already.
    """
    judged = noise or judging_noise(samples)
    found = glitches_in(samples, residual_mm, judged.noise.sigma_mm) if alone is None else alone
    left_mm = bridged(samples, residual_mm, found)
    count = int(model.free.sum())
    lack = (test or FitTest(samples, judged.noise)).of(left_mm, count)
    if not lack.is_significant and (quieter := judged.beside(samples, left_mm)) is not judged:
        judged, lack = quieter, FitTest(samples, quieter.noise).of(left_mm, count)
    if matters_um is None:
        matters_um = default_matters_um(judged.noise.sigma_mm * 1e3, explained_um(samples, model, residual_mm))
    return Sufficiency(lack, matters_um, judged.is_steady)


def default_matters_um(noise_um: float, explained_um: float) -> float:
    """Return the unexplained RMS from which it matters: a part of the noise, or of the reading error explained."""
    return max(MATTERS_OF_NOISE * noise_um, MATTERS_OF_EXPLAINED * explained_um)


def explained_um(samples: Samples, model: Model, residual_mm: Floats) -> float:
    """Return the RMS of the reading error that a model's machine explains.

    What the set-up could take as well, a constant and the first harmonic of each circle, does not count. `residual_mm`
    is what the model leaves. Some `EXPLAINED_ROWS` of the readings stand for all.
    """
    every = slice(None, None, max(len(samples) // EXPLAINED_ROWS, 1))
    some = samples.part(np.arange(len(samples))[every])
    machine = np.array([not each.is_set_up for each in model.parameters()])
    nominal = model.with_values(np.where(machine, 0.0, model.values))
    caused: Floats = some.reading_mm - residual_mm[every] - predict(some, nominal).reading_mm
    _, set_up = distinct_rows(some["set_up"])
    _, left = _core.CaptureHarmonics(some["angle_rad"], rows_by_number(set_up), 1).split(caused)
    return float(np.sqrt(left @ left / max(len(caused), 1))) * 1e3


def p_shown(p_value: float) -> str:
    """Return a p-value for people; below 1e-16 it is a rounding error of one."""
    return "< 1e-16" if p_value < NO_CHANCE else f"{p_value:.1g}"


def p_words(p_value: float) -> str:
    """Return ``p = 0.03`` or ``p < 1e-16``."""
    shown = p_shown(p_value)
    return f"p {shown}" if shown.startswith("<") else f"p = {shown}"
