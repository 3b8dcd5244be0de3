"""A short plan, driven once."""

from __future__ import annotations

import pytest

from hexdbb.plan import Plan, load_plan
from hexdbb.rig.truth import random_truth
from hexdbb_truth.forms.history import History
from hexdbb_truth.forms.measure import Measured
from hexdbb_truth.simulate import Pace


def short_plan() -> Plan:
    """One tilted circle, one lap each way at two feeds."""
    plan = load_plan("standard")
    return plan.model_copy(update={"circles": plan.circles[1:2], "laps": 1, "overshoot_deg": 20.0})


@pytest.fixture(scope="module")
def short() -> Measured:
    return Measured(random_truth(6), History(short_plan(), Pace(6.0, 12, 2.0)))
