"""The loop closed where an effect had to be learned: its plan, what takes no part in the fit, its page."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from tests.truth.held_out import held_out_plans
from tests.truth.learned_closing import Closed, case_of, held_out_records
from tests.truth.learned_loop import page
from tests.truth.spread_plan import spread_plan

from hexdbb.plan import load_plan

ROOT = Path(__file__).parents[3]


def test_the_plan_of_the_docs_is_the_one_that_is_driven():
    assert load_plan(ROOT / "docs" / "plans" / "spread-24.toml").circles == spread_plan().circles


def test_no_held_out_circle_is_about_a_cup_or_at_a_feed_of_the_fitted_ones():
    fitted = spread_plan()
    cups = {mount.cup_mm for mount in fitted.mounts}
    for plan in held_out_plans():
        assert not cups & {mount.cup_mm for mount in plan.mounts}
        assert not set(fitted.feeds_mm_min) & set(plan.feeds_mm_min)


def test_held_out_circles_show_the_machine_without_the_errors_of_its_set_up():
    """Cups that are elsewhere change no reading."""
    case, moved = (case_of(4, 0.1, "calibrate") for _ in range(2))
    setup = case.truth.setup.model_copy(update={"cup_error_um": ((300.0, 0.0, 0.0),) * 5})
    vars(moved)["truth"] = case.truth.model_copy(update={"setup": setup})
    readings = [next(held_out_records(each, [], None)).columns["reading_um"] for each in (case, moved)]
    np.testing.assert_array_equal(*readings)


def test_a_machine_that_the_controller_refuses_counts_as_not_reached():
    closed = [
        Closed("one", ("backlash:1",), "none", 10.0, 0.1, 0.05, 0.01),
        Closed("two", ("servo_lag", "learned:leg:2:time"), "none", 10.0, 1.0, 0.5, 0.01, ("learned:leg:2:time",)),
        Closed("three", (), "none; refused", 10.0, float("nan"), 0.2, 0.01),
    ]
    text = page(closed, [7], "make it")
    assert "falls 10 times in the median of 3 machines,\n0 times in the worst case; 1 of 3 reach 50 times" in text
    assert "| three | nothing | none; refused | 10.00 | nan | refused | 0.200 | 0.010 |" in text
    assert "| two | servo_lag, (learned:leg:2:time) | none |" in text
    assert "that is so on 1 of the machines" in text
    assert "seed 7" in text
