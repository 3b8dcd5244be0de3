"""Turn of each slider's screw: what repeats with every turn may grow along the screw."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

TURN = ("screw_cos", "screw_sin")
TURN_FROM = "sliders_mm"
"""Column that they follow from."""


def turns(sliders_mm: Floats, lead_mm: float) -> dict[str, Floats]:
    """Return cosine and sine of the angle that each screw has turned, shape (n, 6) each."""
    angle_rad = 2.0 * np.pi / lead_mm * sliders_mm
    return dict(zip(TURN, (np.cos(angle_rad), np.sin(angle_rad)), strict=True))
