"""Values of effects between the engine's units and those of the model file.

Fifteen significant digits: one fewer than what the change of unit may cost in rounding, so that a file read and written
again is the same file, to the last digit, any number of times. What is lost is under a part in 10^15.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hexdbb import _core
from hexdbb.model.terms import Floats
from hexdbb.units import shown_factor


def units_of(info: _core.EffectInfo) -> list[str]:
    """Return the engine unit of each value of an effect, element by element."""
    return [each.unit for _ in info.elements for each in info.parameters]


def shown_value(value: float, unit: str) -> float:
    """Return a value of an engine unit in the unit shown."""
    return float(f"{value * shown_factor(unit):.15g}")


def shown_values(values: Floats, units: Sequence[str]) -> tuple[float, ...]:
    """Return values of engine units in the units shown; nan stays nan."""
    return tuple(shown_value(float(value), unit) for value, unit in zip(values, units, strict=True))


def engine_values(shown: Sequence[float], units: Sequence[str]) -> Floats:
    """Return shown values in engine units."""
    return np.array([value / shown_factor(unit) for value, unit in zip(shown, units, strict=True)], dtype=float)
