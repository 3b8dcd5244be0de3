"""Which sliders come nearest to each other and to the ends of their travel, and in which row of a table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.machine import MachineFile

Floats = NDArray[np.float64]


EQUAL_DIGITS = 6
"""Digits of mm to which clearances are told apart: a millionth is far above rounding, far below any tolerance."""


@dataclass(frozen=True)
class NearestSliders:
    """Two sliders of one guideway, counted from 1, their distance, and the row of the table."""

    first: int
    second: int
    distance_mm: float
    row: int

    def words(self) -> str:
        """Return ``sliders 3 and 4 come within 78.2 mm``."""
        return f"sliders {self.first} and {self.second} come within {self.distance_mm:.1f} mm"


@dataclass(frozen=True)
class NearestEnd:
    """A slider, counted from 1, the end of its travel, what is left to it (negative beyond), and the row."""

    slider: int
    end_mm: float
    left_mm: float
    row: int

    def words(self) -> str:
        """Return ``slider 5 comes within 12.0 mm of its end of travel at 846 mm``."""
        return f"slider {self.slider} comes within {self.left_mm:.1f} mm of its end of travel at {self.end_mm:g} mm"


def nearest_sliders(sliders_mm: Floats) -> NearestSliders:
    """Find the two sliders of one guideway that come nearest in positions of shape (n, 6)."""
    distances_mm = sliders_mm[:, 1::2] - sliders_mm[:, 0::2]
    row, guideway = np.unravel_index(_first_least(distances_mm), distances_mm.shape)
    return NearestSliders(int(2 * guideway + 1), int(2 * guideway + 2), float(distances_mm[row, guideway]), int(row))


def nearest_end(machine: MachineFile, sliders_mm: Floats) -> NearestEnd:
    """Find the slider that comes nearest to an end of its travel in positions of shape (n, 6)."""
    travels_mm = np.array(machine.sliders.travels_mm)
    left_mm = np.stack([sliders_mm - travels_mm[:, 0], travels_mm[:, 1] - sliders_mm], axis=2)
    row, slider, end = np.unravel_index(_first_least(left_mm), left_mm.shape)
    return NearestEnd(int(slider + 1), float(travels_mm[slider, end]), float(left_mm[row, slider, end]), int(row))


def _first_least(values_mm: Floats) -> int:
    """Return the first of the smallest values: a symmetric machine has several, equal but for rounding."""
    return int(np.argmin(np.round(values_mm, EQUAL_DIGITS)))
