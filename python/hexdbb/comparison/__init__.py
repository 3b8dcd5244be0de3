"""Comparison of predicted with measured readings: ISO 230-4 quantities, largest residuals, predictors of the residual.

::

    comparison = compare(Samples.of(records), model)
    comparison.rms_mm, comparison.worst[0].where, comparison.to_json()
"""

from hexdbb.comparison.circles import CircleComparison, DirectionComparison
from hexdbb.comparison.commanded import compare_commanded
from hexdbb.comparison.comparison import Comparison, compare, compare_readings
from hexdbb.comparison.largest import largest_quantities
from hexdbb.comparison.quantities import QUANTITIES, UM_PER_MM, Quantities, Quantity
from hexdbb.comparison.radial import RadialError
from hexdbb.comparison.worst_arcs import WorstArc

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
    "compare_commanded",
    "compare_readings",
    "largest_quantities",
]
