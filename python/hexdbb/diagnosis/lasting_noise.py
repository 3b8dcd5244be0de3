"""Noise that lasts for some readings, on single laps, by its spectrum: how much of it is in the lowest harmonics.

White noise and noise that is forgotten exponentially: power s P(f) + (1 - s) times a variance, f in periods a reading,
with P = (1 - kept^2) / (1 - 2 kept cos 2 pi f + kept^2). What a reading keeps of the one before is the same at every
rate of readings, or goes by the time between them: both are weighed. The harmonics above the lowest determine variance,
s and `kept` by Whittle's likelihood (1953), sum of -log S - I / S over their periodograms I; averaged over s and
`kept`, it gives the power of the lowest harmonics, in which a fault shows, and how uncertain that is.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MOST_READINGS, MOST_OF_LAP = 20.0, 0.05
"""Readings, and part of the slowest sweep, that noise lasts at most: longer it is as smooth as a fault, and a single
lap does not distinguish them. A twentieth of a lap has its bend at the third harmonic."""
CASES = 24
"""Number of times that noise may last. Neighbours differ by an eighth at one rate of readings, by a quarter where the
rates differ by four; spectra of some thousand readings do not resolve less."""
SHORTEST = 0.3
"""Least time that noise lasts, in times between two readings: a reading then keeps 4 % of the one before, and the noise
is white but for that."""
SHARES: Floats = np.linspace(0.0, 1.0, 33) ** 2
"""Parts of the variance that may last. They are close together where they are small: 3 % that lasts for twenty readings
already doubles the power of the lowest harmonics."""
BINS = 48
"""Number of frequency bins, evenly spaced in the logarithm. The spectrum bends once, and ten bins describe that."""
SAME_RATE = 1.1
"""Ratio of the times between readings up to which sweeps are of one rate: what is kept differs by a tenth at most."""


@dataclass(frozen=True)
class LowestPower:
    """Variance that noise has in the lowest harmonics of the sweeps.

    Attributes
    ----------
    variance : float
        Mean over them.
    freedom : float
        Degrees of freedom by which it is known: its relative variance is two over that.
    alike : float
        Part of the harmonics' number that count as independent: where noise has more in some, these count most.
    """

    variance: float
    freedom: float
    alike: float


class LastingNoise:
    """Periodograms of sweeps without their lowest harmonics.

    Parameters
    ----------
    lowest : int
        Harmonics that were taken away, beside the mean.
    """

    def __init__(self, lowest: int) -> None:
        self._lowest = lowest
        self._rates: dict[int, _Rate] = {}

    def add(self, residual: Floats, step_s: float) -> None:
        """Add what a sweep has beyond its lowest harmonics, shape (n,), and the time between its readings."""
        count = len(residual)
        of = np.arange(self._lowest + 1, (count + 1) // 2)
        rate = self._rates.setdefault(round(np.log(step_s) / np.log(SAME_RATE)), _Rate(step_s))
        rate.rows.append(count)
        rate.frequencies.append(of / count)
        rate.powers.append(np.abs(np.fft.rfft(residual)[of]) ** 2 / count)

    def lowest_power(self) -> LowestPower:
        """Return the power that the lowest harmonics have of noise."""
        rates = list(self._rates.values())
        slowest = max(rates, key=lambda each: each.step_s)
        most = min(MOST_READINGS, MOST_OF_LAP * float(np.median(slowest.rows)))
        kept = _kept(np.array([each.step_s for each in rates]), most)
        binned = [each.binned() for each in rates]
        counts = np.concatenate([each[0] for each in binned])
        powers = np.concatenate([each[2] for each in binned])
        shape = np.concatenate([_shapes(each[1], of) for each, of in zip(binned, kept, strict=True)], axis=-1)
        scale = (powers / shape) @ counts / counts.sum()
        fit = -counts.sum() * np.log(scale) - np.log(shape) @ counts
        weight = np.exp(fit - fit.max())
        weight /= weight.sum()
        lowest = np.concatenate(
            [_shapes(each.lowest(self._lowest), of) for each, of in zip(rates, kept, strict=True)], axis=-1
        )
        mean = scale * lowest.mean(axis=-1)
        expected = float(np.sum(weight * np.log(mean)))
        doubt = float(np.sum(weight * (np.log(mean) - expected) ** 2)) + 1.0 / counts.sum()
        alike = float(np.sum(weight * lowest.mean(axis=-1) ** 2 / np.mean(lowest**2, axis=-1)))
        return LowestPower(float(np.exp(expected)), 2.0 / doubt, alike)


@dataclass
class _Rate:
    """Sweeps with one time between readings: their readings, and frequencies and powers above the lowest harmonics."""

    step_s: float
    rows: list[int] = field(default_factory=list)
    frequencies: list[Floats] = field(default_factory=list)
    powers: list[Floats] = field(default_factory=list)

    def binned(self) -> tuple[Floats, Floats, Floats]:
        """Return number, mean frequency and mean power of the periodograms' values by bins of frequency."""
        frequency, power = np.concatenate(self.frequencies), np.concatenate(self.powers)
        edges = np.geomspace(frequency.min(), frequency.max(), BINS + 1)[1:-1]
        bins = np.searchsorted(edges, frequency)
        counts = np.bincount(bins, minlength=BINS).astype(np.float64)
        has = counts > 0.0
        sums = [np.bincount(bins, each, minlength=BINS)[has] / counts[has] for each in (frequency, power)]
        return counts[has], sums[0], sums[1]

    def lowest(self, most: int) -> Floats:
        """Return the frequencies of the mean and the lowest harmonics, periods a reading."""
        return np.concatenate([np.arange(most + 1) / each for each in self.rows])


def _kept(steps_s: Floats, most: float) -> Floats:
    """Return what readings may keep, shape (rates, cases): the same at each rate, or by the time between them.

    `most` is how many readings it lasts at most, those of the slowest rate.
    """
    same = 1.0 - np.geomspace(1.0 / most, 1.0, CASES)
    by_time = np.exp(-steps_s[:, None] / np.geomspace(SHORTEST * steps_s.min(), most * steps_s.max(), CASES))
    return np.hstack([np.tile(same, (len(steps_s), 1)), by_time])


def _shapes(frequency: Floats, kept: Floats) -> Floats:
    """Return spectra of variance one for every share and part kept, shape (shares, cases, n); periods a reading."""
    kept = kept[:, None]
    lasting = (1.0 - kept**2) / (1.0 - 2.0 * kept * np.cos(2.0 * np.pi * frequency) + kept**2)
    found: Floats = SHARES[:, None, None] * lasting + (1.0 - SHARES[:, None, None])
    return found
