"""How many faults a set of hypotheses is."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.fit.trial import Member, Trial
from hexdbb.evidence.linear.screen import Known
from hexdbb.learned import Learned


@pytest.mark.parametrize(
    ("hypotheses", "faults"),
    [
        ((), 0),
        ((Known("servo_lag", ("2",)), Known("servo_lag", ("1",))), 2),
        ((Known("servo_lag", ("1", "2", "3", "4", "5", "6"), True),), 6),
        ((Learned.parse("learned:slider:1-2:velocity"),), 2),
        ((Learned.parse("learned:slider:4:velocity"), Learned.parse("learned:guideway:2:carriage_load")), 2),
        ((Learned.parse("learned:slider:all:velocity"), Learned.parse("learned:reading:time")), 2),
    ],
)
def test_a_fault_is_counted_for_each_element_that_has_one(hypotheses: tuple[Any, ...], faults: int) -> None:
    """What all elements share is one function, as a room that warms."""
    trial = SimpleNamespace(members=tuple(map(Member, hypotheses)))
    assert Node(cast(Trial, trial), 0.0).faults == faults
