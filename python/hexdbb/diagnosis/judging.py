"""The noise that a model of some records is judged by, and what is to be said of it.

Repeated laps tell it best, where they are as steady as the gauge is stated to be, or as neighbouring readings are.
Where they repeat much worse, either the gauge is noisier than stated, and what differs from lap to lap is white; or
something is missing that no lap shares with the next: then what is stated, or what neighbouring readings do not share,
counts, and whatever else is found, not all is well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis.noise import (
    Noise,
    lap_differences,
    less_nominal_mm,
    noise_of,
    repeats_but_for_shifts,
    residual_repeats_to,
    stated_noise,
)
from hexdbb.diagnosis.whiteness import is_white
from hexdbb.samples import Samples

UNSTEADY = 1.25
"""Noise of repeated laps over the gauge's stated noise beyond which the machine does not repeat."""
QUIETER = 0.7
"""Noise of a model's residual over that of the laps, below which the lower value is used: half the variance of the
difference was then not noise. Learned functions flexible enough to follow noise remove a tenth of it at most."""
ROUGH = 5.0
"""Noise of repeated laps over that of neighbouring readings, above which laps are considered not to repeat. The ratio
is 1 for white noise and 4.5 for first-order correlated noise with a correlation of 0.95 between readings; an axis that
hunts at 0.43 Hz, read five times a second, has 7."""


@dataclass(frozen=True)
class JudgingNoise:
    """Noise of one reading; `remark` where laps say otherwise than the gauge, `is_steady` where that is but noise."""

    noise: Noise
    remark: str | None = None
    is_steady: bool = True

    def beside(self, samples: Samples, residual_mm: NDArray[np.float64]) -> JudgingNoise:
        """Return the noise estimated from a model's residual if that is much lower than this one; else this one.

        The difference of two laps contains noise and every error that is not sampled alike in both laps: the pitch
        error of a screw that turns by more than its lead between two readings, a drifting gauge. A model that
        describes such an error removes it from the difference.
        """
        if self.noise.source != "repeated laps":
            return self
        sigma_mm = residual_repeats_to(samples, residual_mm)
        is_quieter = sigma_mm < QUIETER * self.noise.sigma_mm
        return replace(self, noise=replace(self.noise, sigma_mm=sigma_mm)) if is_quieter else self


def explains_changes(samples: Samples, residual_mm: NDArray[np.float64], judging: JudgingNoise) -> bool:
    """Check that a model explains what differs from lap to lap: what it leaves repeats as well as is stated."""
    if judging.is_steady:
        return True
    return residual_repeats_to(samples, residual_mm) < UNSTEADY * judging.noise.sigma_mm


def judging_noise(samples: Samples, estimated: Noise | None = None) -> JudgingNoise:
    """Choose the noise of one reading that a model of some records is judged by.

    Parameters
    ----------
    samples : Samples
    estimated : Noise, optional
        As `noise_of` estimates it, where that is known already.
    """
    repeated, stated = estimated or noise_of(samples), stated_noise(samples)
    if stated is None:
        return _beside_neighbours(repeated)
    if repeated.sigma_mm < UNSTEADY * stated.sigma_mm:
        return JudgingNoise(repeated)
    sizes = (
        f"laps repeat to {repeated.sigma_mm * 1e3:.2f} µm only,"
        f" the gauge is stated to have {stated.sigma_mm * 1e3:.2f} µm"
    )
    # A cable that winds up from lap to lap shifts each against the next; within them the gauge is as good as stated.
    if _is_white(samples) and repeats_but_for_shifts(samples) >= UNSTEADY * stated.sigma_mm:
        return JudgingNoise(repeated, f"{sizes}: it is noisier than stated")
    return JudgingNoise(stated, f"{sizes}: something changes from lap to lap", is_steady=False)


def _is_white(samples: Samples) -> bool:
    """Check that what differs from lap to lap is white noise at every feed."""
    left_mm = less_nominal_mm(samples)
    series, feeds = [], []
    for rows in samples.sweeps():
        own = list(lap_differences(samples, left_mm, [rows]))
        series += own
        feeds += [float(samples["feed_mm_s"][rows[0]])] * len(own)
    return is_white(series, feeds)


def _beside_neighbours(repeated: Noise) -> JudgingNoise:
    """Return the noise of repeated laps, or that of neighbouring readings if the laps differ by much more."""
    if repeated.sigma_mm < ROUGH * repeated.rough_mm:
        return JudgingNoise(repeated)
    sizes = (
        f"the lap-to-lap repeatability is {repeated.sigma_mm * 1e3:.2f} µm, the noise between neighbouring readings"
        f" {repeated.rough_mm * 1e3:.2f} µm: something changes from lap to lap"
    )
    return JudgingNoise(Noise(repeated.rough_mm, "roughness"), sizes, is_steady=False)
