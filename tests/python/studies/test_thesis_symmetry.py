"""The contour's 120 degree symmetry of thesis section 5-3, as a property of any errors of any size, and its limits."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from hexdbb.plan import load_plan
from hexdbb.studies.thesis import UNKNOWNS, CircularTest, joint_plane_test, plan_test, reference_contours
from hexdbb.studies.thesis.symmetry import mirrored, symmetry_departure_mm, turned

Floats = NDArray[np.float64]

SIZES = np.array([each.unit_size for each in UNKNOWNS.values()])
LEVEL = [joint_plane_test(), plan_test(load_plan("thesis"), 0, "thesis")]
any_errors = st.lists(st.floats(-5.0, 5.0), min_size=len(SIZES), max_size=len(SIZES)).map(
    lambda amounts: np.array(amounts) * SIZES
)
ROUNDING_MM = 1e-11


@pytest.mark.parametrize("test", LEVEL, ids=["joint plane", "plan thesis"])
@settings(max_examples=25, deadline=None)
@given(errors=any_errors)
def test_level_circle_has_both_symmetries(test: CircularTest, errors: Floats) -> None:
    turn_mm, mirror_mm = symmetry_departure_mm(test, errors)
    assert turn_mm < ROUNDING_MM
    assert mirror_mm < ROUNDING_MM


@given(errors=any_errors)
def test_three_turns_and_two_mirrors_change_nothing(errors: Floats) -> None:
    np.testing.assert_allclose(turned(turned(turned(errors))), errors, atol=1e-12)
    np.testing.assert_array_equal(mirrored(mirrored(errors)), errors)
    np.testing.assert_allclose(mirrored(turned(mirrored(turned(errors)))), errors, atol=1e-12)


@pytest.mark.parametrize("test", LEVEL, ids=["joint plane", "plan thesis"])
def test_error_of_the_next_guideway_has_the_contour_turned_by_120_degrees(test: CircularTest) -> None:
    """What the thesis saw in Figures 3.16-3.20, error by error."""
    names = {
        "leg1": "leg3",
        "leg4": "leg6",
        "leg5": "leg1",
        "slider2": "slider4",
        "side31": "side12",
        **{f"{kind}{i}": f"{kind}{i % 3 + 1}" for kind in ("x", "y", "z", "xy", "yz", "centre") for i in (1, 2, 3)},
    }
    for name, following in names.items():
        one, next_one = reference_contours(test, (name, following)).exact_mm.T
        np.testing.assert_allclose(next_one, np.roll(one, 120), atol=ROUNDING_MM, err_msg=f"{name}, {following}")
        if np.abs(one).max() > 1e-3:
            assert np.abs(next_one - one).max() > 0.1 * np.abs(one).max()


@pytest.mark.parametrize(
    ("roll_pitch_yaw_deg", "turn_holds", "mirror_holds"),
    [((12, 0, 0), False, False), ((0, 12, 0), False, True), ((0, 0, 15), True, False)],
)
def test_held_platform_breaks_what_it_should(
    roll_pitch_yaw_deg: tuple[float, ...], turn_holds: bool, mirror_holds: bool
) -> None:
    plan = load_plan("standard")
    circle = next(each for each in plan.circles if each.platform_rpy_deg == roll_pitch_yaw_deg)
    errors = SIZES * np.random.default_rng(3).normal(size=len(SIZES))
    turn_mm, mirror_mm = symmetry_departure_mm(plan_test(plan, circle.id, "standard"), errors)
    assert (turn_mm < ROUNDING_MM) == turn_holds
    assert (mirror_mm < ROUNDING_MM) == mirror_holds
    assert max(turn_mm, mirror_mm) > 0.01
