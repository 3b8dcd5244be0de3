"""Comparison of predicted with measured readings: ISO 230-4 quantities, largest residuals, predictors of the residual.

::

    comparison = compare(Samples.of(records), model)
    comparison.rms_mm, comparison.worst[0].where, comparison.to_json()
"""

from hexdbb.compare.circles import CircleComparison, DirectionComparison
from hexdbb.compare.comparison import Comparison, compare, compare_readings
from hexdbb.compare.quantities import QUANTITIES, UM_PER_MM, Quantities, Quantity
from hexdbb.compare.radial import RadialError
from hexdbb.compare.worst_arcs import WorstArc

__all__ = [
    "QUANTITIES",
    "UM_PER_MM",
    "CircleComparison",
    "Comparison",
    "DirectionComparison",
    "Quantities",
    "Quantity",
    "RadialError",
    "WorstArc",
    "compare",
    "compare_readings",
]
