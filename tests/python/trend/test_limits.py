"""Limits: what they are of, units, intervals, alarms, and what was beyond for a while."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hexdbb.errors import InputError
from hexdbb.machine import Watch
from hexdbb.trend.limits import STATUS_ALARM, STATUS_FINE, STATUS_LIMIT, exceeded, status_of
from hexdbb.trend.series import Series


def play(values: list[float], sigma: float = 0.5, **changed: Any) -> Series:
    value, spread = np.array(values), np.full(len(values), sigma)
    fields = {
        "label": "backlash:4",
        "effect": "backlash",
        "parameter": "play",
        "unit": "um",
        "value": value,
        "sigma": spread,
        "change": value - value[0],
        "change_sigma": spread,
        "is_changing": True,
        "is_known": True,
        "shared": 6.0,
        "shared_sigma": 0.1,
    }
    return Series(**{**fields, **changed})


def watch(**keys: Any) -> Watch:
    return Watch(**{"what": "backlash", "limit": 10.0, "unit": "um", **keys})


@pytest.mark.parametrize(
    ("values", "first", "last"),
    [
        ([5.0, 9.0, 12.0, 15.0], 2, 3),
        ([5.0, 10.5, 12.0, 15.0], 2, 3),  # its interval reaches below the limit
        ([5.0, 12.0, 10.5, 15.0], 1, 3),  # a wide interval does not end it
        ([5.0, 12.0, 6.0, 15.0], 3, 3),  # a value below the limit does
        ([5.0, 12.0, 13.0, 6.0], 1, 2),  # beyond for a while
    ],
)
def test_it_is_beyond_from_the_first_record_that_is_surely(values: list[float], first: int, last: int) -> None:
    (one,), notes = exceeded([play(values)], [watch()], "machine.toml")
    assert (one.first, one.last, notes) == (first, last, [])


def test_statuses() -> None:
    fine, _ = exceeded([play([5.0, 9.0])], [watch()], "")
    limit, _ = exceeded([play([5.0, 15.0])], [watch(alarm=20.0)], "")
    alarm, _ = exceeded([play([5.0, -25.0])], [watch(alarm=20.0)], "")
    assert [status_of(each) for each in (fine, limit, alarm)] == [STATUS_FINE, STATUS_LIMIT, STATUS_ALARM]


def test_what_does_not_change_is_judged_by_its_one_value() -> None:
    noisy = [6.0, 13.0, 6.0]
    assert exceeded([play(noisy, is_changing=False)], [watch()], "")[0] == []
    assert len(exceeded([play(noisy, is_changing=False, shared=11.0)], [watch()], "")[0]) == 1


def test_a_value_that_is_not_identifiable_is_not_judged_but_said() -> None:
    found, (note,) = exceeded([play([5.0, 15.0], is_known=False)], [watch()], "machine.toml")
    assert found == []
    assert "watch[0]: backlash:4: these readings determine its change alone (expected change = true)" in note
    assert len(exceeded([play([5.0, 17.0], is_known=False)], [watch(change=True)], "")[0]) == 1


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"what": "backlahs"}, r'watch\[0\].what: "backlahs" \(expected G, G\(b\), H, or an effect'),
        ({"unit": "ms"}, r'watch\[0\].unit: "ms" \(expected "um", that of backlash\)'),
        ({"parameter": "x"}, r'watch\[0\].parameter: "x" \(expected one of play\)'),
    ],
)
def test_a_limit_of_nothing_is_refused(keys: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        exceeded([play([1.0, 2.0])], [watch(**keys)], "machine.toml")
