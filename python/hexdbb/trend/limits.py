"""Limits of the machine file against series: what is beyond its limit, and since which record."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.machine import Watch
from hexdbb.trend.series import Series

Floats = NDArray[np.float64]

SURE = 2.0
"""Standard deviations by which a value must be beyond its limit: of values at the limit one in 44 is taken to be
beyond it. Intervals are drawn with the same factor (coverage 95 %)."""
STATUS_FINE, STATUS_LIMIT, STATUS_ALARM = 0, 3, 4
"""Exit statuses of the trend: 1 and 2 are those of commands that did not succeed or were used wrongly."""


@dataclass(frozen=True, eq=False)
class Exceeded:
    """A series beyond its limit.

    Attributes
    ----------
    series : Series
    watch : Watch
    first : int
        Record from which on it is beyond, from 0: the first of those up to `last`.
    last : int
        The last record beyond it.
    is_alarm : bool
        Whether it is beyond its alarm too, at `last`.
    """

    series: Series
    watch: Watch
    first: int
    last: int
    is_alarm: bool


def watched_effects(watches: Sequence[Watch], quantities: Sequence[str]) -> list[str]:
    """Return what is watched and is no quantity: effects, perhaps with an element."""
    return list(dict.fromkeys(each.what for each in watches if each.what not in quantities))


def exceeded(series: Sequence[Series], watches: Sequence[Watch], origin: str) -> tuple[list[Exceeded], list[str]]:
    """Return what is beyond its limit, and sentences on limits that cannot be judged.

    Parameters
    ----------
    series : sequence of Series
    watches : sequence of Watch
    origin : str
        The machine file, for errors.

    Raises
    ------
    InputError
        A limit of what no series is, or in another unit.
    """
    found, notes = [], []
    for index, watch in enumerate(watches):
        meant = _meant(series, watch, f"{origin}: watch[{index}]")
        unknown = [each.label for each in meant if not (each.is_known or watch.change)]
        if unknown:
            notes.append(
                f"{origin}: watch[{index}]: {', '.join(unknown)}: these readings determine its change alone"
                " (expected change = true)"
            )
        found += [
            beyond for each in meant if each.label not in unknown and (beyond := _beyond(each, watch)) is not None
        ]
    return found, notes


def status_of(found: Sequence[Exceeded]) -> int:
    """Return the exit status: the worst of what is beyond its limit at the last record it is known of."""
    if any(each.is_alarm for each in found):
        return STATUS_ALARM
    return STATUS_LIMIT if found else STATUS_FINE


def judged(series: Series, change: bool) -> tuple[Floats, Floats]:
    """Return the values that limits and pictures take, and their standard deviations.

    Values that do not change are the shared one.
    """
    if change:
        nothing = np.zeros_like(series.value)
        return (series.change, series.change_sigma) if series.is_changing else (nothing, nothing)
    if series.is_changing:
        return series.value, series.sigma
    return np.full_like(series.value, series.shared), np.full_like(series.value, series.shared_sigma)


def _meant(series: Sequence[Series], watch: Watch, where: str) -> list[Series]:
    named = [each for each in series if watch.what in (each.label, each.effect)]
    if not named:
        raise InputError(f'{where}.what: "{watch.what}" (expected G, G(b), H, or an effect as hexdbb effects lists)')
    meant = [each for each in named if watch.parameter in (None, each.parameter)]
    if not meant:
        names = ", ".join(dict.fromkeys(each.parameter for each in named))
        raise InputError(f'{where}.parameter: "{watch.parameter}" (expected one of {names})')
    other = next((each.unit for each in meant if each.unit != watch.unit), None)
    if other is not None:
        raise InputError(f'{where}.unit: "{watch.unit}" (expected "{other}", that of {watch.what})')
    return meant


def _beyond(series: Series, watch: Watch) -> Exceeded | None:
    value, sigma = judged(series, watch.change)
    surely = np.abs(value) - SURE * np.nan_to_num(sigma, nan=0.0)
    known = np.flatnonzero(np.isfinite(value))
    beyond = surely > watch.limit
    if not len(known) or not beyond[known].any():
        return None
    last = int(known[beyond[known]][-1])
    first = last
    for each in known[::-1]:
        if each < first:
            # A record whose interval reaches below the limit does not end it, one that is below it does.
            if np.abs(value[each]) <= watch.limit:
                break
            first = int(each) if beyond[each] else first
    is_alarm = watch.alarm is not None and bool(surely[last] > watch.alarm)
    return Exceeded(series, watch, first, last, is_alarm)
