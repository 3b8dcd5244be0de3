"""Values over time: ISO 230-4 quantities of every record, and every effect's values with their standard deviations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.comparison import UM_PER_MM, largest_quantities
from hexdbb.identifiability import KNOWN_PART
from hexdbb.samples import Samples
from hexdbb.trend.arrow import Changing, Solution, solve
from hexdbb.trend.changing import candidates
from hexdbb.trend.joint import JointFit
from hexdbb.units import shown_factor, shown_unit

Floats = NDArray[np.float64]

WATCHED_QUANTITIES = ("circular_deviation", "bidirectional_circular_deviation", "circular_hysteresis")
"""Keys of the quantities that are drawn: those that acceptance protocols ask for and that grow with wear."""


@dataclass(frozen=True, eq=False)
class Series:
    """One value, record by record.

    Attributes
    ----------
    label : str
        ``G``, or effect and element, ``backlash:4``.
    effect, parameter : str
        Empty for quantities of ISO 230-4.
    unit : str
        ASCII.
    value, sigma : ndarray, shape (records,)
        nan where not known; the sigma of a quantity is nan.
    change, change_sigma : ndarray, shape (records,)
        Since the first record.
    is_changing : bool
        Whether the readings ask for it to change; where not, values are what they would be if it alone changed
        beside those that do.
    is_known : bool
        Whether the value is identifiable and not the change alone.
    shared, shared_sigma : float
        One value for all records; nan for quantities.
    """

    label: str
    effect: str
    parameter: str
    unit: str
    value: Floats
    sigma: Floats
    change: Floats
    change_sigma: Floats
    is_changing: bool
    is_known: bool
    shared: float = float("nan")
    shared_sigma: float = float("nan")

    @property
    def name(self) -> str:
        """Label and parameter, for people: ``backlash:4 play``."""
        return f"{self.label} {self.parameter}".strip()


def quantity_series(samples: Sequence[Samples], symbols: dict[str, str]) -> list[Series]:
    """Return G, G(b) and H of every record, the largest on any circle, feed and direction.

    Parameters
    ----------
    samples : sequence of Samples
        One of each record.
    symbols : dict
        Symbol of each quantity by its key.
    """
    found = {key: np.full(len(samples), np.nan) for key in WATCHED_QUANTITIES}
    for number, each in enumerate(samples):
        for key, value in largest_quantities(each, WATCHED_QUANTITIES).items():
            found[key][number] = np.nan if value is None else value * UM_PER_MM
    nothing = np.full(len(samples), np.nan)
    return [
        Series(symbols[key], "", "", "um", each, nothing, each - each[0], nothing, True, True)
        for key, each in found.items()
    ]


def effect_series(fit: JointFit) -> list[Series]:
    """Return the values of every element of every shared effect, in the order of the model."""
    changing = {each.label for each in fit.changing}
    found = []
    for each in candidates(fit):
        if each.label in changing:
            solution, departures = fit.solution, fit.departures
        else:
            # A wide prior: what is shown is what the readings say, not what the prior makes of it.
            alone = replace(each, scale=1.0)
            departures = tuple(np.append(own, np.zeros(len(each.columns))) for own in fit.departures)
            solution = solve(fit.equations, fit.layout, (*fit.changing, alone), departures)
        found += [_of_value(fit, each, column, solution, departures) for column in each.columns]
    return found


def _of_value(fit: JointFit, one: Changing, column: int, solution: Solution, departures: Sequence[Floats]) -> Series:
    parameter = fit.models[0].parameters()[column]
    factor = parameter.prior_sigma * shown_factor(parameter.unit)
    place = int(np.flatnonzero(solution.layout.shared == column)[0])
    own = int(np.flatnonzero(solution.departing == column)[0])
    at = fit.equations[0].at[column] - departures[0][own]
    shared = at + solution.moved[place]
    variance = float(solution.covariance[place, place])
    values, variances, carried, left = [], [], [], []
    for number, steps in enumerate(solution.own):
        index = len(solution.layout.set_up[number]) + own
        gain = solution.carried[number][index]
        values.append(shared + departures[number][own] + steps[index])
        # w = m - carried x, so that value = x_c + w has the gain e_c - carried of the shared values.
        direction = -gain
        direction[place] += 1.0
        left.append(float(solution.spread[number][index, index]))
        variances.append(left[-1] + float(direction @ solution.covariance @ direction))
        carried.append(gain)
    apart = [carried[0] - gain for gain in carried]
    change_variance = [
        0.0 if number == 0 else left[number] + left[0] + float(each @ solution.covariance @ each)
        for number, each in enumerate(apart)
    ]
    value = np.array(values)
    return Series(
        one.label,
        one.effect,
        parameter.name,
        shown_unit(parameter.unit),
        (value + parameter.start / parameter.prior_sigma) * factor,
        np.sqrt(variances) * factor,
        (value - value[0]) * factor,
        np.sqrt(change_variance) * factor,
        one.label in {each.label for each in fit.changing},
        bool(np.sqrt(max(variances)) <= KNOWN_PART),
        float(shared) * factor,
        float(np.sqrt(variance)) * factor,
    )
