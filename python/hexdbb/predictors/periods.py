"""Sines of a variable: the period found by Fourier transform on one half of the samples, tested on the other.

Values lie unevenly, so they are summed in cells and transformed at once (Press and Rybicki 1989, without the
spreading: a cell is short against the shortest period sought); the best of the grid is then refined by least squares.
"""

from __future__ import annotations

import numpy as np

from hexdbb.predictors.variable import FloatArray

MOST_CELLS = 2**16
"""Cells of equal width into which the values are summed, at most: more than samples, so that hardly any are merged."""
CELLS_A_TURN = 16
"""Cells in a turn of the highest frequency sought: a cell lowers a sine by 0.6 % then, and the
transform of fewer cells takes less time."""
OVERSAMPLED = 4
"""Zero padding of the transform: between two of its frequencies a sine then loses 3 % at most."""
REFINED = 5
"""Frequencies evaluated within one grid step around the best, spaced by a sixteenth of a spectral line's width: a
parabola through three of them locates the maximum to some thousandths of the step."""
PER_CELL = 0.25
"""Highest frequency, in turns a cell: at a quarter of a turn a cell lowers a sine by 10 % at most."""
LEAST_TURNS = 2.0
"""Fewest turns of a sine over all values: below, a slow drift is taken for one."""


def strongest_frequency(weighted: FloatArray, values: FloatArray, highest: float) -> float | None:
    """Return the frequency whose sine explains most of a residual given at uneven places.

    Parameters
    ----------
    weighted : ndarray, shape (n,) or (n, c)
        Residual times its response to a push, along each of c axes.
    values : ndarray, shape (n,)
    highest : float
        Highest frequency sought, in turns per unit of `values`.

    Returns
    -------
    float or None
        None where no frequency lies between two turns over all values and the highest.
    """
    spread = float(np.ptp(values))
    if spread <= 0.0:
        return None
    cells = _cells(highest * spread)
    cell = np.minimum(((values - values.min()) / spread * cells).astype(np.intp), cells - 1)
    padded = OVERSAMPLED * cells
    axes = weighted.reshape(len(values), -1).T
    power = sum(np.abs(np.fft.rfft(np.bincount(cell, axis, cells), padded)) ** 2 for axis in axes)
    power = np.asarray(power)
    frequency = np.arange(len(power)) * cells / padded / spread
    allowed = (frequency >= LEAST_TURNS / spread) & (frequency <= min(highest, PER_CELL * cells / spread))
    if not allowed.any():
        return None
    coarse = float(frequency[allowed][int(np.argmax(power[allowed]))])
    near = coarse + np.linspace(-0.5, 0.5, REFINED) / spread / OVERSAMPLED
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


def _cells(turns: float) -> int:
    """Return a number of cells, a power of two, for so many turns of the highest frequency over all values."""
    return int(2 ** np.ceil(np.log2(np.clip(CELLS_A_TURN * turns, 1.0, MOST_CELLS))))


def folded_hz(frequency_hz: float, rate_hz: float) -> float:
    """Return the frequency to which another aliases when it is sampled at a rate."""
    return abs(frequency_hz - rate_hz * round(frequency_hz / rate_hz))


def waves(weight: FloatArray, values: FloatArray, frequency: float) -> FloatArray:
    """Return cosine and sine of a frequency times a weight, shape (n, 2)."""
    turns = 2.0 * np.pi * frequency * values
    return np.column_stack([weight * np.cos(turns), weight * np.sin(turns)])
