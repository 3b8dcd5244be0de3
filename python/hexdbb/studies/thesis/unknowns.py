"""Short names of the thesis' 33 errors and of the set-up's unknowns, for table heads and options.

Each stands for one value of an effect of the engine. Units are the engine's, mm and rad; the unit error of a reference
contour is `UNIT_MM` or `UNIT_RAD`. The thesis as scanned does not state the size of its unit errors.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from hexdbb.errors import InputError
from hexdbb.machine import shipped_machine
from hexdbb.model import Parameter, new_model

UNIT_MM = 0.1
UNIT_RAD = math.radians(0.02)
"""Unit errors: both move a guideway's slider by about 0.1 mm, the rotation at 300 mm from its axis."""

UNIT_SIZES = {"mm": UNIT_MM, "rad": UNIT_RAD}

SHORT_NAMES = {
    "leg_length": "leg{element}",
    "slider_offset": "slider{element}",
    "guideway_translation": "{parameter}{element}",
    "guideway_rotation_xy": "xy{element}",
    "guideway_rotation_yz": "yz{element}",
    "guideway_rotation_centre": "centre{element}",
    "platform_side": "side{element}",
    "cup_position": "cup_{parameter}",
    "ball_offset": "ball_{parameter}",
    "bar_length": "bar",
}
"""Effects of the thesis' estimator in the order of its values, and the pattern of their values' short names."""


@dataclass(frozen=True)
class Unknown:
    """One error."""

    name: str
    """Short name."""
    column: int
    """Index among the values."""
    parameter: Parameter

    @property
    def unit(self) -> str:
        """Engine unit, mm or rad."""
        return self.parameter.unit

    @property
    def unit_size(self) -> float:
        """Size of the unit error of its reference contour, engine unit."""
        return UNIT_SIZES[self.unit]


def _all() -> dict[str, Unknown]:
    found = {}
    # Names and units belong to the effects and are the same for every machine.
    for column, each in enumerate(new_model(shipped_machine(), list(SHORT_NAMES)).parameters()):
        name = SHORT_NAMES[each.effect].format(element=each.element, parameter=each.name)
        found[name] = Unknown(name, column, each)
    return found


UNKNOWNS = _all()
"""All unknowns by short name, in the order of the values."""

GEOMETRIC_ERRORS = tuple(name for name, each in UNKNOWNS.items() if not each.parameter.is_set_up)
"""The thesis' 33 errors (section 3.2)."""


def find_unknowns(names: Sequence[str]) -> list[Unknown]:
    """Return unknowns by name.

    Raises
    ------
    InputError
        No name, an unknown one, or one given twice.
    """
    if not names:
        raise InputError("no error named (expected at least one of: " + ", ".join(UNKNOWNS) + ")")
    for index, name in enumerate(names):
        if name not in UNKNOWNS:
            raise InputError(f'error "{name}": not known (expected one of: {", ".join(UNKNOWNS)})')
        if name in names[:index]:
            raise InputError(f'error "{name}": named twice (expected each once)')
    return [UNKNOWNS[name] for name in names]
