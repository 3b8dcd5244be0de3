"""Noise that laps do not show: a gauge or an encoder rounds alike wherever it is at the same place again.

The difference of two laps has lost what both share. Readings rounded to a step much larger than their noise are the
same in both laps, though each is off by up to half a step; so are the positions of sliders that repeat to less than
their encoders' step. A step is that of the values themselves: files are rounded too.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hexdbb.model import new_model
from hexdbb.samples import Samples, port_sensitivity

Floats = NDArray[np.float64]

ROWS = 300
"""Readings that are looked at: one of ten steps is missed where all these happen to lie on a ten times coarser one."""
STEPS_MM = tuple(part * 10.0**power for power in range(-1, -7, -1) for part in (1.0, 0.5, 0.2))
"""Steps that encoders, gauges and files have: 100 µm to 0.2 nm."""
ROUNDED = 1e-4
"""Part of a step within which a value lies on it: a float of 1000 mm has a ten-thousandth of the smallest step."""
UNIFORM = 1.0 / math.sqrt(12.0)
"""Standard deviation of an error that is uniform over one step."""
NEGLIGIBLE = 0.2
"""Part of the noise below which rounding adds less than 2 % to it: `lack_of_fit` doubts noise by 1 % and takes four
times that."""
DITHERED = 0.7
"""Standard deviation of laps' noise, in steps, from which rounding is not the same in two laps: noise of half a step
leaves a correlation of 10^-5 (`_shared`)."""
TERMS, HALVINGS = 20, 40
"""Terms of the series for the correlation of two rounding errors, which fall as 1 / k²: twenty leave out 3 % of it at
most. Halvings of an interval: forty bring it to 10^-12 of the noise."""


def with_rounding(samples: Samples, noise_mm: float) -> float:
    """Return the standard deviation of one reading, mm, whose laps differ by some noise: what rounding adds, added.

    Parameters
    ----------
    samples : Samples
    noise_mm : float
        From the differences of laps, in units of one reading.
    """
    some = np.linspace(0, len(samples) - 1, min(ROWS, len(samples))).astype(np.intp)
    noise_mm = _rounded(noise_mm, step_mm(samples.reading_mm[some]))
    sliders_mm = samples["sliders_mm"]
    steps = np.array([step_mm(sliders_mm[some, each]) for each in range(sliders_mm.shape[1])])
    if not steps.any():
        return noise_mm
    answers = port_sensitivity(samples.part(some), new_model(samples.machine))["slider"]
    of_encoders_mm = UNIFORM * float(np.sqrt(np.mean(np.sum((answers * steps) ** 2, axis=1))))
    if of_encoders_mm < NEGLIGIBLE * noise_mm:
        return noise_mm
    return math.hypot(noise_mm, of_encoders_mm * math.sqrt(_repeated(samples, sliders_mm)))


def step_mm(values: Floats) -> float:
    """Return the step to which some values are rounded, mm; 0 where none of `STEPS_MM` is."""
    from_first = values - values[0]
    steps = from_first[:, None] / np.array(STEPS_MM)
    on_steps = np.all(np.abs(steps - np.round(steps)) < ROUNDED, axis=0)
    return STEPS_MM[int(np.argmax(on_steps))] if on_steps.any() and from_first.any() else 0.0


def _rounded(noise_mm: float, step: float) -> float:
    """Return the noise before rounding, and the rounding: that of which laps differ by `noise_mm`."""
    if noise_mm >= DITHERED * step:
        return noise_mm
    of_rounding = (UNIFORM * step) ** 2
    low, high = 0.0, noise_mm
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        differs = math.sqrt(middle**2 + of_rounding * (1.0 - _shared(middle / step)))
        low, high = (middle, high) if differs < noise_mm else (low, middle)
    return math.sqrt(low**2 + of_rounding)


def _shared(noise_steps: float) -> float:
    """Return the correlation of rounding errors of two readings of one value: Widrow and Kollár, 2008, ch. 4.

    An error is a Fourier series of the value; normal noise on either reading takes exp(-2 pi^2 k^2 s^2) of term k.
    """
    order = np.arange(1, TERMS + 1)
    whole = np.sum(1.0 / order**2)
    return float(np.sum(np.exp(-((2.0 * np.pi * order * noise_steps) ** 2)) / order**2) / whole)


def _repeated(samples: Samples, sliders_mm: Floats) -> float:
    """Return the part of the readings at whose sliders' positions another reading of their sweep was taken."""
    again = 0
    for rows in samples.sweeps():
        _, which, count = np.unique(sliders_mm[rows], axis=0, return_inverse=True, return_counts=True)
        again += int(np.sum(count[which.ravel()] > 1))
    return again / len(samples)
