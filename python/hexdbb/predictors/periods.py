"""Sines of a variable: the period found by Fourier transform on one half of the samples, tested on the other.

Values lie unevenly, so they are summed in cells and transformed at once (Press and Rybicki 1989, without the
spreading: a cell is short against the shortest period sought); the best of the grid is then refined by least squares.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hexdbb.predictors.variable import FloatArray

REFINED = 5
"""Frequencies evaluated within one grid step around the best, spaced by a sixteenth of a spectral line's width: a
parabola through three of them locates the maximum to some thousandths of the step."""
LEAST_TURNS = 2.0
"""Fewest turns of a sine over all values: below, a slow drift is taken for one."""


@dataclass(frozen=True)
class Grid:
    """Cells of equal width into which values are summed.

    Attributes
    ----------
    a_turn : int
        Cells in a turn of the highest frequency sought.
    most : int
        Cells at most.
    highest : float
        Highest frequency sought, in turns a cell.
    oversampled : int
        Zero padding of the transform.
    """

    a_turn: int
    most: int
    highest: float
    oversampled: int

    def cells(self, turns: float) -> int:
        """Return a number of cells, a power of two, for so many turns of the highest frequency over all values."""
        return int(2 ** np.ceil(np.log2(np.clip(self.a_turn * turns, 1.0, self.most))))


FINE = Grid(16, 2**16, 0.25, 4)
"""Cells lower the highest of sines by 0.6 %, by 10 % where there are as many as there may be, more than samples;
between two frequencies of the transform a sine loses 3 % at most. The transform of fewer cells takes less time."""
COARSE = Grid(3, 2**21, 0.35, 2)
"""For as many as a million turns: a cell lowers a sine by 20 % at most, the place between two frequencies by 10 %."""


def strongest_frequency(
    weighted: FloatArray, values: FloatArray, highest: float, lowest: float = 0.0, grid: Grid = FINE
) -> float | None:
    """Return the frequency whose sine explains most of a residual given at uneven places.

    Parameters
    ----------
    weighted : ndarray, shape (n,) or (n, c)
        Residual times its response to a push, along each of c axes.
    values : ndarray, shape (n,)
    highest, lowest : float
        Frequencies sought, in turns per unit of `values`.
    grid : Grid

    Returns
    -------
    float or None
        None where no frequency lies between two turns over all values and the highest.
    """
    spread = float(np.ptp(values))
    if spread <= 0.0:
        return None
    cells = grid.cells(highest * spread)
    cell = np.minimum(((values - values.min()) / spread * cells).astype(np.intp), cells - 1)
    padded = grid.oversampled * cells
    axes = weighted.reshape(len(values), -1).T
    sums = (np.bincount(cell, axis, cells).astype(np.float32) for axis in axes)  # for a rank, and in half of the time
    power = np.asarray(sum(np.abs(np.fft.rfft(each, padded)) ** 2 for each in sums))
    frequency = np.arange(len(power)) * cells / padded / spread
    least = max(lowest, LEAST_TURNS / spread)
    allowed = (frequency >= least) & (frequency <= min(highest, grid.highest * cells / spread))
    if not allowed.any():
        return None
    coarse = float(frequency[allowed][int(np.argmax(power[allowed]))])
    near = coarse + np.linspace(-0.5, 0.5, REFINED) / spread / grid.oversampled
    # Evenly spaced frequencies: each wave is the one before, turned a little further.
    wave, turn = axes * np.exp(2j * np.pi * near[0] * values), np.exp(2j * np.pi * (near[1] - near[0]) * values)
    strength = np.empty(REFINED)
    for place in range(REFINED):
        strength[place] = np.sum(np.abs(wave.sum(axis=1)) ** 2)
        wave *= turn
    return float(np.clip(_top(near, strength), near[0], near[-1]))


def _top(places: FloatArray, heights: FloatArray) -> float:
    """Return where the parabola through the highest of some evenly spaced points and its neighbours has its top."""
    highest = int(np.clip(np.argmax(heights), 1, len(heights) - 2))
    before, there, after = heights[highest - 1 : highest + 2]
    bend = before - 2.0 * there + after
    moved = 0.5 * (before - after) / bend if bend < 0.0 else float(np.argmax(heights) - highest)
    return float(places[highest] + moved * (places[1] - places[0]))


def folded_hz(frequency_hz: float, rate_hz: float) -> float:
    """Return the frequency to which another aliases when it is sampled at a rate."""
    return abs(frequency_hz - rate_hz * round(frequency_hz / rate_hz))


def waves(weight: FloatArray, values: FloatArray, frequency: float) -> FloatArray:
    """Return cosine and sine of a frequency times a weight, shape (n, 2)."""
    turns = 2.0 * np.pi * frequency * values
    return np.column_stack([weight * np.cos(turns), weight * np.sin(turns)])
