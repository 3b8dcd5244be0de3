"""Ranking of the variables that predict a residual: where no known effect explains it, they say what to look for.

Every variable's hypothesis is rated by the share it explains of samples to which it was not fitted
(`cross_validation.py`). A description of many values explains nearly anything (ten degrees of angle on each of seven
circles are 252 values), so each doubling of their number must pay: variables come in the order of share less `COST` for
every doubling, and one that explains more than the first only by many more values is left out. What is confined to one
place is stated with the place.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from hexdbb.predictors.bins import binned
from hexdbb.predictors.cross_validation import CrossValidation
from hexdbb.predictors.design import Design
from hexdbb.predictors.halves import sampling_rate_hz
from hexdbb.predictors.periods import strongest_frequency, waves
from hexdbb.predictors.places import one_place
from hexdbb.predictors.predictor import LEAST_SHARE, Predictor, Profile
from hexdbb.predictors.pushes import Pushes
from hexdbb.predictors.steps import steps
from hexdbb.predictors.variable import FloatArray, Variable, variables
from hexdbb.samples import Samples

SHORTEST_PERIOD_MM = 0.5
"""Shortest period sought along a guideway: a tenth of the screw's lead; shorter ones alias with the sampling."""
SINE_VALUES = 3
"""Amplitude, phase and period."""


def rank_predictors(
    samples: Samples,
    residual_mm: FloatArray,
    pushes: Pushes | None = None,
    noise_mm: float = 0.0,
    *,
    beyond_noise: bool = False,
) -> list[Predictor]:
    """Rate every variable of the samples as a predictor of a residual.

    Parameters
    ----------
    samples : Samples
    residual_mm : ndarray, shape (n,)
        Measured minus predicted reading of each sample.
    pushes : Pushes, optional
        Response of the readings to pushes; without them every cause acts on the reading.
    noise_mm : float
        Standard deviation of one reading; where it is not known (0), nothing is allowed for what the model's own values
        imitate.
    beyond_noise : bool
        Whether the residual is that of a fit; shares are then of what exceeds the noise, else of the whole mean square.

    Returns
    -------
    list of Predictor
        Those of most worth (share less the cost of their values) first.
    """
    tested = CrossValidation(samples, residual_mm, pushes, noise_mm, beyond_noise=beyond_noise)
    found = []
    for variable in variables(samples, pushes):
        found.append(_means(variable, tested))
        if variable.is_place or variable.name == "time":
            found += _periodic(variable, samples, tested)
    found += (
        []
        if "time_s" in samples.unmeasured
        else [
            Predictor(step.subject, step.variable, "s", step.pushes, share, step.values, None, step.place, step.size_um)
            for step in steps(samples, pushes, tested)
            if (share := tested.share(step.design, True)) > LEAST_SHARE
        ]
    )
    return sorted(found, key=lambda each: -each.worth)


def main_predictors(found: Sequence[Predictor], most: int) -> list[Predictor]:
    """Choose the predictors to print, largest share first: one for each subject, none that the first one implies.

    Parameters
    ----------
    found : sequence of Predictor
        As `rank_predictors` returns them.
    most : int
        Largest number to choose.
    """
    best: dict[str, Predictor] = {}
    for each in found:
        if each.share > LEAST_SHARE and each.subject not in best:
            best[each.subject] = each
    chosen = list(best.values())
    return sorted((each for each in chosen if each.share <= chosen[0].share), key=lambda each: -each.share)[:most]


def _means(variable: Variable, tested: CrossValidation) -> Predictor:
    cut = binned(variable)
    share, push_mm, squares = tested.share_and_values(cut.design, variable.is_time)
    push_um = push_mm * 1e3
    # Of a weight of one this is the mean itself.
    mean_um = push_um * np.sqrt(squares / cut.samples)
    profiles = tuple(
        Profile(variable.names[each] if variable.names else "", cut.centre[here], mean_um[here])
        for each in np.unique(cut.group)
        for here in [cut.group == each]
    )
    whole = Predictor(
        subject=variable.subject,
        variable=variable.name,
        unit=variable.unit,
        pushes=variable.pushes,
        share=max(share, 0.0),
        values=len(cut.centre),
        profiles=profiles,
        classes=variable.classes,
    )
    if share < LEAST_SHARE or variable.apart is not None or not (variable.is_place or variable.is_time):
        return whole
    at = one_place(cut, push_um)
    if at is None:
        return whole
    place, inside = at
    there = cut.design.only(inside)
    inside_mm = tested.fit(there)
    largest_mm = float(inside_mm[np.argmax(np.abs(inside_mm))])
    alone = replace(
        whole,
        share=max(tested.share(there, variable.is_time), 0.0),
        values=int(inside.sum()) + 2,
        place=place,
        size_um=abs(largest_mm) * 1e3,
        pushes=variable.pushes if variable.signs is None else variable.signs[largest_mm < 0.0],
    )
    return max(whole, alone, key=lambda each: each.worth)


def _periodic(variable: Variable, samples: Samples, tested: CrossValidation) -> Iterator[Predictor]:
    """Yield a sine of the variable: its period is found on one half and tested with its amplitude on the other."""
    if len(variable.parts) > 1:
        return
    ((weight, values),) = variable.parts
    rate_hz = sampling_rate_hz(samples)
    highest = 0.5 * rate_hz if variable.is_time else 1.0 / SHORTEST_PERIOD_MM
    first = ~tested.second[variable.is_time]
    frequency = strongest_frequency((weight * tested.residual_mm)[first], values[first], highest)
    if frequency is None:
        return
    design = Design.full(waves(weight, values, frequency))
    share = tested.share(design, variable.is_time)
    if share > LEAST_SHARE:
        amplitude_um = float(np.linalg.norm(tested.fit(design))) * 1e3
        yield Predictor(
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
