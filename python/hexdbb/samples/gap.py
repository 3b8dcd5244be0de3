"""Distance between the carriages of a guideway: the force of bellows or cables between them depends on it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

GAP = "gap_mm"
GAP_FROM = "sliders_mm"
"""Column that it follows from."""


def gaps_mm(sliders_mm: Floats) -> Floats:
    """Return each slider's coordinate less that of the other one on its guideway, shape (n, 6)."""
    neighbours = np.arange(sliders_mm.shape[1]) ^ 1
    return np.asarray(sliders_mm - sliders_mm[:, neighbours])
