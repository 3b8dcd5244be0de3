"""The servo axis against the differential equation it solves, and its stops."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hexdbb.rig.servo import ServoAxis

LAG_S, DT_S, FAST = 0.002, 0.004, 1e6


@pytest.mark.parametrize("feedforward", [0.0, 0.6, 1.0])
def test_follows_as_the_differential_equation_says(feedforward):
    axis = ServoAxis(10.0, LAG_S, feedforward)
    targets = 10.0 + np.cumsum(np.sin(np.arange(20) * 0.4) * 0.05)
    demand, position = 10.0, 10.0
    for target in targets:
        axis.follow(float(target), DT_S, DT_S, FAST)
        velocity = (target - demand) / DT_S
        solved = solve_ivp(
            lambda t, x, d=demand, v=velocity: (d + v * t - x) / LAG_S + feedforward * v,
            (0.0, DT_S),
            [position],
            rtol=1e-11,
            atol=1e-12,
        )
        demand, position = float(target), float(solved.y[0, -1])
        assert axis.position_mm == pytest.approx(position, abs=1e-9)


def test_lag_at_constant_velocity_is_velocity_times_time_constant():
    axis = ServoAxis(0.0, LAG_S, 0.0)
    for step in range(1, 101):
        axis.follow(0.2 * step, DT_S, DT_S, FAST)
    assert axis.following_error_mm == pytest.approx(0.2 / DT_S * LAG_S, rel=1e-9)


def test_feed_forward_of_one_leaves_no_lag():
    axis = ServoAxis(0.0, LAG_S, 1.0)
    for step in range(1, 21):
        axis.follow(0.2 * step, DT_S, DT_S, FAST)
    assert axis.following_error_mm == pytest.approx(0.0, abs=1e-12)


@given(split=st.integers(1, 7), target=st.floats(-5.0, 5.0))
def test_motion_does_not_depend_on_the_step(split, target):
    whole, parts = ServoAxis(0.0, LAG_S, 0.3), ServoAxis(0.0, LAG_S, 0.3)
    whole.follow(target, DT_S, DT_S, FAST)
    for k in range(1, split + 1):
        parts.follow(target * k / split, DT_S / split, DT_S / split, FAST)
    assert parts.position_mm == pytest.approx(whole.position_mm, abs=1e-12)


def test_short_interpolation_arrives_early_and_waits():
    axis = ServoAxis(0.0, LAG_S, 1.0)
    axis.follow(1.0, DT_S / 4.0, DT_S, FAST)
    assert axis.demand_mm == 1.0
    assert axis.position_mm == pytest.approx(1.0, abs=1e-9)


def test_velocity_limit_holds_back_and_says_so():
    axis = ServoAxis(0.0, LAG_S, 1.0)
    assert axis.follow(10.0, DT_S, DT_S, 100.0)
    assert axis.demand_mm == pytest.approx(100.0 * DT_S)
    assert not axis.follow(0.5, DT_S, DT_S, 100.0)


@given(speed=st.floats(1.0, 300.0), deceleration=st.floats(100.0, 20_000.0))
def test_brakes_within_the_distance_of_the_ramp(speed, deceleration):
    axis = ServoAxis(0.0, LAG_S, 0.0)
    for step in range(1, 11):
        axis.follow(speed * DT_S * step, DT_S, DT_S, FAST)
    begin = axis.demand_mm
    cycles = 0
    while not axis.at_standstill:
        axis.brake(DT_S, deceleration)
        cycles += 1
        assert cycles < 2000
    assert axis.demand_mm - begin == pytest.approx(speed**2 / (2.0 * deceleration), rel=1e-9)
    assert cycles * DT_S <= speed / deceleration + 12.0 * LAG_S + math.log1p(speed) * LAG_S + 2.0 * DT_S


def test_jammed_axis_stays_and_lets_the_error_grow():
    axis = ServoAxis(5.0, LAG_S, 0.0)
    axis.jammed = True
    for step in range(1, 6):
        axis.follow(5.0 + step, DT_S, DT_S, FAST)
    assert axis.position_mm == 5.0
    assert axis.following_error_mm == pytest.approx(5.0)
    axis.brake(1.0, 100_000.0)
    assert axis.at_standstill
