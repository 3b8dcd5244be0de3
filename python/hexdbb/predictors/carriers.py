"""Which variable carries a residual: for a fault that no known effect explains, so that its finder knows what to write.

Every variable's hypothesis is judged by the share it carries on samples it was not fitted to (`judge.py`). A
description of many values explains nearly anything (ten degrees of angle on each of seven circles are 252 values), so
that each doubling of their number must pay: variables come in the order of share less `COST` for every doubling, and
what carries more than the first only by many more values is left out. What sits at one place is said with the place.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from hexdbb.predictors.bins import binned
from hexdbb.predictors.columns import Columns, FloatArray, sampling_rate_hz
from hexdbb.predictors.judge import Judge
from hexdbb.predictors.periods import strongest_frequency, waves
from hexdbb.predictors.places import Place, one_place
from hexdbb.predictors.pushes import Pushes
from hexdbb.predictors.steps import steps
from hexdbb.predictors.variable import Variable, variables

LEAST_SHARE = 0.02
COST = 0.015
SHORTEST_PERIOD_MM = 0.5
SINE_VALUES = 3


@dataclass(frozen=True)
class Profile:
    """Means over the bins of a variable, for drawing: one line for each number of `Variable.apart`.

    Attributes
    ----------
    name : str
    centre : (m,) array
    mean_um : (m,) array
        Of the residual; where the cause pushes elsewhere, root mean square of what its push does to the reading, with
        the push's sign.
    """

    name: str
    centre: FloatArray
    mean_um: FloatArray


@dataclass(frozen=True)
class Carrier:
    """A variable and what it carries.

    Attributes
    ----------
    subject, variable, unit, pushes : str
        As those of `Variable`.
    share : float
        Of the mean square residual, out of sample, 0 to 1.
    values : int
        How many values the description needs.
    period : float or None
        In `unit`, where it repeats.
    place : Place or None
        Where it sits, where that is one place only.
    size_um : float or None
        Amplitude of the sine, or the largest push at the place.
    sampled_hz : float or None
        Samples a second, of a period in time: faster ones look slow.
    profiles : tuple of Profile
    """

    subject: str
    variable: str
    unit: str
    pushes: str
    share: float
    values: int
    period: float | None = None
    place: Place | None = None
    size_um: float | None = None
    sampled_hz: float | None = None
    profiles: tuple[Profile, ...] = ()

    @property
    def worth(self) -> float:
        """Share less what the number of values costs."""
        return self.share - COST * float(np.log2(max(self.values, 1)))


def carriers(
    columns: Columns, pushes: Pushes | None = None, noise_mm: float = 0.0, *, beyond_noise: bool = False
) -> list[Carrier]:
    """Judge every variable, the one that is worth most first.

    Parameters
    ----------
    columns : dict of str to (n,) arrays
        As `sample_columns` gives them.
    pushes : Pushes, optional
        How the readings answer to pushes; without them all act on the reading.
    noise_mm : float
        Of one reading; where it is not known (0), nothing is allowed for what the model's own values imitate.
    beyond_noise : bool
        Whether the residual is that of a fit, of which shares are of what is beyond the noise; else they are of the
        whole mean square.
    """
    judge = Judge(columns, pushes, noise_mm, beyond_noise=beyond_noise)
    found = []
    for variable in variables(columns, pushes):
        found.append(_means(variable, judge))
        if variable.is_place or variable.name == "time":
            found += _periodic(variable, columns, judge)
    found += [
        Carrier(step.subject, step.variable, "s", step.pushes, share, step.values, None, step.place, step.size_um)
        for step in steps(columns, pushes, judge)
        if (share := judge.share(step.design, True)) > LEAST_SHARE
    ]
    return sorted(found, key=lambda each: -each.worth)


def telling(found: list[Carrier], most: int) -> list[Carrier]:
    """Choose what is worth saying, the largest share first: one variable of each subject, none that is a shadow."""
    best: dict[str, Carrier] = {}
    for each in found:
        if each.share > LEAST_SHARE and each.subject not in best:
            best[each.subject] = each
    chosen = list(best.values())
    return sorted((each for each in chosen if each.share <= chosen[0].share), key=lambda each: -each.share)[:most]


def _means(variable: Variable, judge: Judge) -> Carrier:
    cut = binned(variable)
    share, push_mm = judge.weighed(cut.design, variable.is_time)
    push_um = push_mm * 1e3
    # Of a weight of one this is the mean itself.
    mean_um = push_um * np.sqrt(np.asarray(cut.design.multiply(cut.design).sum(axis=0)).ravel() / cut.samples)
    profiles = tuple(
        Profile(variable.names[each] if variable.names else "", cut.centre[here], mean_um[here])
        for each in np.unique(cut.group)
        for here in [cut.group == each]
    )
    whole = Carrier(
        subject=variable.subject,
        variable=variable.name,
        unit=variable.unit,
        pushes=variable.pushes,
        share=max(share, 0.0),
        values=len(cut.centre),
        profiles=profiles,
    )
    if share < LEAST_SHARE or variable.apart is not None or not (variable.is_place or variable.is_time):
        return whole
    at = one_place(cut, push_um)
    if at is None:
        return whole
    place, inside = at
    there = cut.design[:, inside]
    inside_mm = judge.fit(there)
    largest_mm = float(inside_mm[np.argmax(np.abs(inside_mm))])
    alone = replace(
        whole,
        share=max(judge.share(there, variable.is_time), 0.0),
        values=int(inside.sum()) + 2,
        place=place,
        size_um=abs(largest_mm) * 1e3,
        pushes=variable.pushes if variable.signs is None else variable.signs[largest_mm < 0.0],
    )
    return max(whole, alone, key=lambda each: each.worth)


def _periodic(variable: Variable, columns: Columns, judge: Judge) -> Iterator[Carrier]:
    """A sine of the variable: the period found on one half, and judged with its amplitude on the other."""
    if len(variable.parts) > 1:
        return
    ((weight, values),) = variable.parts
    rate_hz = sampling_rate_hz(columns)
    highest = 0.5 * rate_hz if variable.is_time else 1.0 / SHORTEST_PERIOD_MM
    first = ~judge.second[variable.is_time]
    frequency = strongest_frequency((weight * judge.residual_mm)[first], values[first], highest)
    if frequency is None:
        return
    design = sparse.csr_matrix(waves(weight, values, frequency))
    share = judge.share(design, variable.is_time)
    if share > LEAST_SHARE:
        amplitude_um = float(np.linalg.norm(judge.fit(design))) * 1e3
        yield Carrier(
            subject=variable.subject,
            variable=f"{variable.name}, repeating",
            unit=variable.unit,
            pushes=variable.pushes,
            share=share,
            values=SINE_VALUES,
            period=1.0 / frequency,
            size_um=amplitude_um,
            sampled_hz=rate_hz if variable.is_time else None,
        )
