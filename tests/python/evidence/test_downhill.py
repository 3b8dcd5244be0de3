"""What hangs loosely on the platform falls to its lower side: one function of the tilt, along no axis of its own."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.evidence.linear.readings import Readings, State
from hexdbb.evidence.linear.signatures import signature_of
from hexdbb.learned import Learned
from hexdbb.samples.lean import leans


def test_one_function_pushes_towards_the_lower_side(readings: Readings) -> None:
    turn = readings.state["angle_rad"]
    rpy = np.column_stack([0.1 * np.sin(turn), 0.2 * np.cos(turn), 0.3 * np.sin(2.0 * turn)])
    state = State({**readings.state._columns, **leans(rpy), "platform_rpy_rad": rpy}, readings.state.machine)
    sinks = Learned.parse("learned:ball:tilt_downhill")
    assert sinks.components == 1
    some = Readings(state, readings.groups, readings.noise_mm, readings.ports)
    space = signature_of(sinks, some).space
    pushed = [space.design(state, axis) for axis in range(3)]
    # Splines add up to one: along each axis they push by the lower side's part of it.
    assert np.column_stack([each.sum(axis=1) for each in pushed]) == pytest.approx(state["downhill_in_platform"])
