"""Functions learned from readings: where they push, on which variable they depend, and what form they have.

Everything here is data and arithmetic on it: a hypothesis is chosen by name from closed lists (`places`, `variables`),
its function is a penalised spline (`splines`), and `words` puts the fitted function into words.
"""

from hexdbb.learned.directed import is_directed
from hexdbb.learned.following import two_states
from hexdbb.learned.hypothesis import FINER, Directed, Learned, part_of
from hexdbb.learned.listed import (
    crossed_hypotheses,
    further_hypotheses,
    grown_with_warmth,
    hypotheses,
    products,
    settling,
)
from hexdbb.learned.numbered import has_chosen_number, number_of, step
from hexdbb.learned.places import ALL, PAIRS
from hexdbb.learned.ranges import Columns, Ranges
from hexdbb.learned.repeating import periodic
from hexdbb.learned.signs import turning, turns_with
from hexdbb.learned.space import Space, Weight
from hexdbb.learned.tables import Curve, Table
from hexdbb.learned.variable import Variable
from hexdbb.learned.words import Form, describe

__all__ = [
    "ALL",
    "FINER",
    "PAIRS",
    "Columns",
    "Curve",
    "Directed",
    "Form",
    "Learned",
    "Ranges",
    "Space",
    "Table",
    "Variable",
    "Weight",
    "crossed_hypotheses",
    "describe",
    "further_hypotheses",
    "grown_with_warmth",
    "has_chosen_number",
    "hypotheses",
    "is_directed",
    "number_of",
    "part_of",
    "periodic",
    "products",
    "settling",
    "step",
    "turning",
    "turns_with",
    "two_states",
]
