"""Predicted against measured: per record, circle, feed and direction, in ISO 230-4 quantities, and where it is worst.

The core takes arrays and knows nothing of models::

    comparison = compare(records, [predict_reading_mm(record, model) for record in records])
    comparison.rms_mm, comparison.worst[0].where, comparison.to_json()
"""

from hexdbb.compare.circles import CircleComparison, DirectionComparison
from hexdbb.compare.comparison import Comparison, compare
from hexdbb.compare.quantities import QUANTITIES, UM_PER_MM, Quantities, Quantity
from hexdbb.compare.radial import RadialError
from hexdbb.compare.worst import WorstPlace

__all__ = [
    "QUANTITIES",
    "UM_PER_MM",
    "CircleComparison",
    "Comparison",
    "DirectionComparison",
    "Quantities",
    "Quantity",
    "RadialError",
    "WorstPlace",
    "compare",
]
