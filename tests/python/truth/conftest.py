"""A short plan, driven once."""

from __future__ import annotations

import pytest
from tests.truth.forms.history import History
from tests.truth.forms.measure import Measured
from tests.truth.simulate import Pace

from hexdbb.plan import Plan, load_plan
from hexdbb.rig.truth import random_truth


def short_plan() -> Plan:
    """One tilted circle, one lap each way at two feeds."""
    plan = load_plan("standard")
    return plan.model_copy(update={"circles": plan.circles[1:2], "laps": 1, "overshoot_deg": 20.0})


@pytest.fixture(scope="module")
def short() -> Measured:
    return Measured(random_truth(6), History(short_plan(), Pace(6.0, 12, 2.0)))
