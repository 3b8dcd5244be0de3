"""An effect at all its elements in one clause: where it is largest, and where it is smallest."""

from __future__ import annotations

from hexdbb.effects.words import effect_clause
from hexdbb.machine import shipped_machine
from hexdbb.model import Size, new_model

MODEL = new_model(shipped_machine(), ["servo_lag", "screw_thermal"])


def sizes(names: dict[str, str], values: list[dict[str, float]]) -> list[Size]:
    return [
        Size(str(element), name, each[name], 0.1 * abs(each[name]) or None, unit)
        for element, each in enumerate(values, 1)
        for name, unit in names.items()
    ]


def test_a_value_that_is_told_is_told_of_the_largest_and_of_the_smallest() -> None:
    lags = sizes({"lag": "ms"}, [{"lag": value} for value in (12.0, 15.0, 13.0, 11.0, 14.0, 12.5)])
    clause = effect_clause(MODEL.info("servo_lag"), lags)
    assert clause == "all 6 sliders: slider 2 lags 15 ± 2 ms behind its drive's encoder, down to 11 ± 1 ms of slider 4"


def test_what_nobody_measured_says_nothing_of_which_is_largest() -> None:
    """Without a temperature screws grow with time; their coefficients by temperature are zero."""
    names = {"per_kelvin": "1/K", "per_time": "1/s"}
    values = [{"per_kelvin": 0.0, "per_time": 1e-8 * value} for value in (1.0, 1.8, 1.5, 1.7, 0.9, 1.4)]
    clause = effect_clause(MODEL.info("screw_thermal"), sizes(names, values))
    assert clause == "all 6 sliders: the screw of slider 2 grows during the test most, that of slider 5 least"


def test_what_cools_shrinks() -> None:
    names = {"per_kelvin": "1/K", "per_time": "1/s"}
    cooled = sizes(names, [{"per_kelvin": 0.0, "per_time": -1e-8}])
    assert effect_clause(MODEL.info("screw_thermal"), cooled) == "the screw of slider 1 shrinks during the test"
