"""The feed, and its square, in units of a usual one: what a motor's ripple excites grows with both."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FEED_RATIOS = ("feed_ratio", "feed_ratio_squared")
FEED_RATIOS_FROM = "feed_mm_s"
"""Column that they follow from."""
USUAL_MM_S = 50.0
"""3000 mm/min, the faster feed of a usual test: functions that grow with the feed, and with its square, are then of the
size of one that does not, as their common prior has them."""


def feed_ratios(feed_mm_s: Floats) -> dict[str, Floats]:
    """Return the columns `FEED_RATIOS`, each of shape (n,), from the commanded speed, shape (n,)."""
    ratio = feed_mm_s / USUAL_MM_S
    return dict(zip(FEED_RATIOS, (ratio, ratio**2), strict=True))
