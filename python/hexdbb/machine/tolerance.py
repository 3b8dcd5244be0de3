"""Tolerances that a machine's circles are judged by."""

from __future__ import annotations

from hexdbb.files.validation import Positive, StrictModel


class Tolerance(StrictModel):
    """Largest values of ISO 230-4 quantities, µm, on any circle; what is absent is not judged."""

    circular_deviation_um: Positive | None = None
    """Circular deviation G of each direction."""
    bidirectional_circular_deviation_um: Positive | None = None
    """Bi-directional circular deviation G(b)."""
    radial_deviation_um: Positive | None = None
    """Radial deviation F, largest and smallest, to either side; centre offset removed (least squares)."""
