"""The ball bar and its length gauge."""

from __future__ import annotations

import math
from datetime import date
from typing import Annotated

from pydantic import Field

from hexdbb.files.validation import NotNegative, Positive, StrictModel

LEAST_NOISE_MM = 1e-6
"""Limits a noise from below, so that no reading counts as exact: one nanometre, a hundredth of the usual resolution of
a ball bar (0.1 µm)."""


class Gauge(StrictModel):
    """Ball bar and length gauge."""

    bar_length_mm: Positive
    """L0: nominal distance between the two ball centres; a reading is the length minus this."""
    noise_um: NotNegative | None = None
    """Gauge specification: standard deviation of one reading; absent where it is not known."""
    resolution_um: NotNegative = 0.1
    """Step to which readings are rounded."""
    range_um: Positive = 1000.0
    """Largest reading, to either side."""

    serial_number: Annotated[str, Field(min_length=1)] | None = None
    """Serial number of the ball bar, for reports."""
    calibrated: date | None = None
    """Date of the bar's last calibration, for reports."""

    @property
    def stated_noise_mm(self) -> float | None:
        """Standard deviation of one reading as specified, rounding included, mm; None where it is not specified.

        Rounding adds an error uniform over one step, of standard deviation step / sqrt(12).
        """
        if self.noise_um is None:
            return None
        return max(math.hypot(self.noise_um, self.resolution_um / math.sqrt(12.0)) / 1000.0, LEAST_NOISE_MM)
