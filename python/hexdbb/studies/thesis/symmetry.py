"""The exact 120 degree symmetry of contours (thesis section 5-3: "the error contour rotates 120 degrees ...").

The nominal machine turned by 120 degrees about z is itself: guideway i becomes guideway i + 1. Mirrored in the plane
y = 0 it is itself too: guideway 1 stays, 2 and 3 change places, and so do the two legs of a pair. Where the circle has
the symmetry as well (level circle, cup on the z axis, ball on the platform's own axis, platform level), for errors of
any size and by exact kinematics
    contour(turned(values))(angle) = contour(values)(angle - 120 deg)
    contour(mirrored(values))(angle) = contour(values)(-angle).
A yaw of the platform keeps the turn and breaks the mirror, a pitch breaks the turn and keeps the mirror, a roll breaks
both. The thesis says "as the guideway rotates 60 degrees" because it counts the angle between two guideways as lines.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hexdbb.studies.thesis.circular_test import CircularTest
from hexdbb.studies.thesis.unknowns import UNKNOWNS

Floats = NDArray[np.float64]

TURN_RAD = math.radians(120.0)

_NEXT_GUIDEWAY = {"1": "2", "2": "3", "3": "1"}
_NEXT_SLIDER = {str(k): str((k + 1) % 6 + 1) for k in range(1, 7)}
_NEXT_SIDE = {"12": "23", "23": "31", "31": "12"}
_OTHER_GUIDEWAY = {"1": "1", "2": "3", "3": "2"}
_OTHER_SLIDER = {"1": "2", "2": "1", "3": "6", "4": "5", "5": "4", "6": "3"}
_OTHER_SIDE = {"12": "31", "23": "23", "31": "12"}
_SAME = {"1": "1"}

_ELEMENTS = {
    "leg_length": (_NEXT_SLIDER, _OTHER_SLIDER),
    "slider_offset": (_NEXT_SLIDER, _OTHER_SLIDER),
    "guideway_translation": (_NEXT_GUIDEWAY, _OTHER_GUIDEWAY),
    "guideway_rotation_xy": (_NEXT_GUIDEWAY, _OTHER_GUIDEWAY),
    "guideway_rotation_yz": (_NEXT_GUIDEWAY, _OTHER_GUIDEWAY),
    "guideway_rotation_centre": (_NEXT_GUIDEWAY, _OTHER_GUIDEWAY),
    "platform_side": (_NEXT_SIDE, _OTHER_SIDE),
    "cup_position": (_SAME, _SAME),
    "ball_offset": (_SAME, _SAME),
    "bar_length": (_SAME, _SAME),
}
"""Effect to the elements that its elements become under the turn and under the mirror."""

_CHANGES_SIGN = {
    ("slider_offset", "offset"),  # slider coordinates run the other way in the mirror
    ("guideway_translation", "y"),
    ("guideway_rotation_xy", "angle"),
    ("guideway_rotation_yz", "angle"),
    ("guideway_rotation_centre", "angle"),
    ("cup_position", "y"),
    ("ball_offset", "y"),
}
"""Parameters whose sign the mirror reverses."""

_VECTORS = ("cup_position", "ball_offset")
"""Effects whose x and y are components in a frame common to all guideways, and turn as a vector does."""


def turned(values: Floats) -> Floats:
    """Return the errors of the machine turned by 120 degrees: guideway i + 1 has the errors of guideway i.

    Parameters
    ----------
    values : ndarray, shape (len(UNKNOWNS),)

    Returns
    -------
    ndarray, shape (len(UNKNOWNS),)
    """
    moved = _moved(values, 0)
    cosine, sine = math.cos(TURN_RAD), math.sin(TURN_RAD)
    for effect in _VECTORS:
        x, y = (_column(effect, "1", name) for name in "xy")
        moved[[x, y]] = cosine * values[x] - sine * values[y], sine * values[x] + cosine * values[y]
    return moved


def mirrored(values: Floats) -> Floats:
    """Return the errors of the machine mirrored in the plane y = 0; shapes as in `turned`."""
    moved = _moved(values, 1)
    for each in UNKNOWNS.values():
        if (each.parameter.effect, each.parameter.name) in _CHANGES_SIGN:
            moved[each.column] *= -1.0
    return moved


def symmetry_departure_mm(test: CircularTest, errors: Floats) -> tuple[float, float]:
    """Return the largest departures, mm, of a test from the turn and from the mirror symmetry for given errors.

    Parameters
    ----------
    test : CircularTest
        Evenly sampled from angle 0, a multiple of three samples.
    errors : ndarray, shape (len(UNKNOWNS),)
    """
    contour = test.contour_mm(errors)
    turn = test.contour_mm(turned(errors)) - np.roll(contour, len(contour) // 3)
    mirror = test.contour_mm(mirrored(errors)) - np.roll(contour[::-1], 1)
    return float(np.abs(turn).max()), float(np.abs(mirror).max())


def _moved(values: Floats, which: int) -> Floats:
    moved = np.empty_like(values)
    for each in UNKNOWNS.values():
        parameter = each.parameter
        element = _ELEMENTS[parameter.effect][which][parameter.element]
        moved[_column(parameter.effect, element, parameter.name)] = values[each.column]
    return moved


def _column(effect: str, element: str, parameter: str) -> int:
    return _COLUMNS[effect, element, parameter]


_COLUMNS = {
    (each.parameter.effect, each.parameter.element, each.parameter.name): each.column for each in UNKNOWNS.values()
}
