"""Units of output: the factor belongs to the unit named, and people read µm where files say um."""

from __future__ import annotations

import pytest

from hexdbb.units import SHOWN, readable_unit, shown_factor, shown_unit

SI = {"mm": 1e-3, "um": 1e-6, "m": 1.0, "rad": 1.0, "urad": 1e-6, "s": 1.0, "ms": 1e-3, "h": 3600.0, "N": 1.0, "K": 1.0}


def in_si(unit: str) -> float:
    """Value of one unit in SI: numerator divided by every further factor."""
    first, *rest = unit.split("/")
    value = 1.0 if first == "1" else SI[first]
    for each in rest:
        value /= SI[each]
    return value


@pytest.mark.parametrize("engine_unit", SHOWN)
def test_a_value_is_the_same_in_both_units(engine_unit: str) -> None:
    assert shown_factor(engine_unit) * in_si(shown_unit(engine_unit)) == pytest.approx(in_si(engine_unit), rel=1e-12)


def test_a_unit_not_listed_is_unchanged() -> None:
    assert (shown_unit("Hz"), shown_factor("Hz")) == ("Hz", 1.0)


@pytest.mark.parametrize(
    ("unit", "read"),
    [
        ("um", "µm"),
        ("urad", "µrad"),
        ("um/m/K", "µm/m/K"),
        ("ms", "ms"),
        ("um/N", "µm/N"),
        ("lumen", "lumen"),
        ("", ""),
    ],
)
def test_people_read_the_sign(unit: str, read: str) -> None:
    assert readable_unit(unit) == read
