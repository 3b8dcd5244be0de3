"""Values that a group of machines has in common: a batch of screws, a type of machine.

Every machine counts once, by the median of a value over its records. The mean of a group is compared with that of all
other machines (Welch's test, which lets both scatter differently); causes that discoveries found are counted in and
outside the group (Fisher's exact test). What is named passes after Bonferroni's correction for all that was tried.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln, stdtr, stdtrit

from hexdbb.fleet.growth import CHANCE
from hexdbb.fleet.observed import Floats, Observed, Series, ValueName, by_value

LEAST_MACHINES = 2
"""Machines of a group, and outside it, at least: of one alone the scatter is not known."""


@dataclass(frozen=True)
class SharedValue:
    """A value that differs between a group and all other machines.

    Attributes
    ----------
    kind, group : str
        ``batch`` or ``type``, and which.
    value_name : ValueName
        Its element is empty for the mean over all elements of an effect.
    machines, others : int
        In and outside the group.
    mean, mean_of_others : float
    low, high : float
        95 % interval of their difference.
    p : float
    """

    kind: str
    group: str
    value_name: ValueName
    machines: int
    others: int
    mean: float
    mean_of_others: float
    low: float
    high: float
    p: float


@dataclass(frozen=True)
class SharedCause:
    """A cause found more often in a group than outside: machines that have it, of all that were looked into."""

    kind: str
    group: str
    effect: str
    having: int
    machines: int
    others_having: int
    others: int
    p: float


def shared_values(observed: Observed) -> list[SharedValue]:
    """Return the values that groups have in common, those that chance makes least first."""
    tried = [
        found
        for name, medians in _medians(observed.series)
        for kind, group, inside in _groups(observed.groups, medians)
        if (found := _compared(kind, group, name, medians, inside)) is not None
    ]
    return sorted((each for each in tried if each.p * len(tried) < CHANCE), key=lambda each: each.p)


def shared_causes(observed: Observed) -> list[SharedCause]:
    """Return the causes that groups have in common."""
    tried = []
    for effect in sorted({effect for _, effect in observed.causes}):
        having = {machine for machine, found in observed.causes if found == effect}
        counted = {machine: float(machine in having) for machine in sorted(observed.looked_into)}
        for kind, group, inside in _groups(observed.groups, counted):
            own = [counted[each] for each in inside]
            others = [value for machine, value in counted.items() if machine not in inside]
            table = int(sum(own)), len(own), int(sum(others)), len(others)
            tried.append(SharedCause(kind, group, effect, *table, _fisher(*table)))
    return sorted((each for each in tried if each.p * len(tried) < CHANCE), key=lambda each: each.p)


def _medians(series: Sequence[Series]) -> Iterator[tuple[ValueName, dict[str, float]]]:
    """Yield every value with its median of each machine; then every effect with the mean over its elements."""
    of_effects: dict[ValueName, dict[str, list[float]]] = {}
    for name, own in by_value(series):
        medians = {each.machine: float(np.median(each.value)) for each in own}
        yield name, medians
        if name.element:
            whole = of_effects.setdefault(ValueName(name.effect, "", name.name, name.unit), {})
            for machine, value in medians.items():
                whole.setdefault(machine, []).append(value)
    for name, values in of_effects.items():
        most = max(map(len, values.values()))
        if most > 1:  # machines of which all elements are known
            yield name, {machine: float(np.mean(own)) for machine, own in values.items() if len(own) == most}


def _groups(
    groups: Mapping[str, Mapping[str, str]], machines: Mapping[str, float]
) -> Iterator[tuple[str, str, list[str]]]:
    """Yield every group with its machines, where there are enough in it and outside."""
    for kind, group_of in groups.items():
        for group in sorted(set(group_of.values())):
            inside = [machine for machine in machines if group_of.get(machine) == group]
            if len(inside) >= LEAST_MACHINES and len(machines) - len(inside) >= LEAST_MACHINES:
                yield kind, group, inside


def _compared(
    kind: str, group: str, name: ValueName, medians: Mapping[str, float], inside: Sequence[str]
) -> SharedValue | None:
    own: Floats = np.array([medians[machine] for machine in inside])
    others: Floats = np.array([value for machine, value in medians.items() if machine not in set(inside)])
    variances = own.var(ddof=1) / len(own), others.var(ddof=1) / len(others)
    variance = float(sum(variances))
    if variance == 0.0:
        return None
    free = variance**2 / float(variances[0] ** 2 / (len(own) - 1) + variances[1] ** 2 / (len(others) - 1))
    difference, sigma = float(own.mean() - others.mean()), float(np.sqrt(variance))
    wide = float(stdtrit(free, 0.975)) * sigma
    return SharedValue(
        kind,
        group,
        name,
        len(own),
        len(others),
        float(own.mean()),
        float(others.mean()),
        difference - wide,
        difference + wide,
        2.0 * float(stdtr(free, -abs(difference) / sigma)),
    )


def _fisher(having: int, machines: int, others_having: int, others: int) -> float:
    """Return the probability of so many in the group or more, where the group does not matter."""
    total, whole = having + others_having, machines + others

    def log_choose(n: int, k: int) -> float:
        return float(gammaln(n + 1) - gammaln(k + 1) - gammaln(n - k + 1))

    most = min(total, machines)
    logs = [
        log_choose(machines, k) + log_choose(others, total - k) - log_choose(whole, total)
        for k in range(having, most + 1)
    ]
    return float(np.sum(np.exp(logs)))
