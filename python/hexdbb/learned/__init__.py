"""Functions learned from readings: where they push, on which variable they depend, and what form they have.

Everything here is data and arithmetic on it: a hypothesis is chosen by name from closed lists (`places`, `variables`),
its function is a penalised spline (`splines`), and `words` puts the fitted function into words.
"""

from hexdbb.learned.places import ALL, FINER, Learned, hypotheses, part_of
from hexdbb.learned.space import Columns, Curve, Space, Table
from hexdbb.learned.variables import Variable, periodic, step, with_period
from hexdbb.learned.words import Form, describe

__all__ = [
    "ALL",
    "FINER",
    "Columns",
    "Curve",
    "Form",
    "Learned",
    "Space",
    "Table",
    "Variable",
    "describe",
    "hypotheses",
    "part_of",
    "periodic",
    "step",
    "with_period",
]
