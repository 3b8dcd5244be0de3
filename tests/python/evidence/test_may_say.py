"""Whether a learned function may say what a known effect does: at a place of its form, by time only if that is."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.place import may_say
from hexdbb.learned import Learned

KIN = {
    "backlash:1": (
        "learned:slider:1:direction",
        "learned:vertical:1:direction_position",
        "learned:vertical:1:direction_time",
    ),
    "screw_thermal:3": ("learned:slider:3:time_position", "learned:vertical:2:time_position"),
    "ball_eccentricity:2": ("learned:ball:fine_time",),
}


@pytest.fixture
def search() -> Any:
    by_name = {name: Learned.parse(name) for names in KIN.values() for name in names}
    kin = {name: set(names) for name, names in KIN.items()}
    return SimpleNamespace(kin=kin, learnable=SimpleNamespace(by_name=by_name))


@pytest.mark.parametrize(
    ("effect", "element", "function", "may"),
    [
        # A guideway that is lifted now and then is no play of its slider.
        ("backlash", "1", "learned:vertical:1:time_period@390", False),
        ("backlash", "1", "learned:vertical:1:time", False),
        ("backlash", "1", "learned:vertical:1:position", True),
        ("backlash", "1", "learned:vertical:2:position", False),
        ("backlash", "1", "learned:slider:1:direction_time", True),
        # A screw that warms grows by the place.
        ("screw_thermal", "3", "learned:vertical:2:time", True),
        ("ball_eccentricity", "2", "learned:ball:time_in_circle", True),
        ("ball_eccentricity", "2", "learned:cup:time", False),
    ],
)
def test_a_function_may_say_an_effect_at_its_places_and_by_its_states(
    search: Any, effect: str, element: str, function: str, may: bool
) -> None:
    assert may_say(search, Known(effect, (element,)), Learned.parse(function)) is may
