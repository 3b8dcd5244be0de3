"""How the legs share a load on the platform: against the engine, and by the sum of their forces."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.kinematics import rotation_from_rpy
from hexdbb.kinematics.legs import Legs
from hexdbb.learned.places import BY_LOAD
from hexdbb.model import new_model
from hexdbb.plan import load_plan
from hexdbb.samples import Samples
from hexdbb.samples.leg_columns import leg_columns
from hexdbb.samples.load_shares import SHARES

FAR_MM = 1e9


@pytest.fixture(scope="module")
def planned() -> Samples:
    plan = load_plan("standard")
    return Samples.planned(plan.machine_file(), plan.runs()[::5], np.linspace(0.0, 6.0, 40), 100.0)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_pull_is_shared_as_the_engine_s_bar_pulls(planned: Samples, axis: int) -> None:
    """A bar to a cup 1000 km away pulls along an axis: what it reads per mm of a leg is the leg's force, by work."""
    cup_mm = np.where(np.arange(3) == axis, FAR_MM, 0.0)
    rows = len(planned)
    samples = _core.Samples(
        sliders_mm=planned["sliders_mm"],
        set_up=np.zeros(rows, np.int32),
        mount=np.zeros(rows, np.int32),
        set_ups=[_core.SetUp(cup_mm=cup_mm, ball_offset_mm=np.zeros(3), bar_length_mm=0.0)],
        state={},
    )
    first = _core.PORTS["leg"][0]
    answer = _core.port_sensitivity(new_model(planned.machine, []).engine(planned.tabulated), samples)
    found = planned[list(SHARES)[axis]]
    # The bar gets shorter as the platform is pulled towards the cup.
    assert found == pytest.approx(-answer[:, first : first + 6], abs=1e-5)
    assert np.abs(found).max() > 0.3


def test_the_legs_hold_the_load(planned: Samples) -> None:
    legs = Legs.at(
        planned.machine,
        planned["position_mm"],
        rotation_from_rpy(planned["platform_rpy_rad"]),
        planned["sliders_mm"],
    )
    turning = np.cross(legs.lever_mm, legs.unit) / planned.machine.platform.circumradius_mm
    held = np.concatenate([legs.unit, turning], axis=2)
    for axis, name in enumerate(SHARES):
        total = np.einsum("nk,nki->ni", planned[name], held)
        assert total == pytest.approx(np.tile(np.eye(6)[axis], (len(planned), 1)), abs=1e-9)
    assert planned["force_by_pull_z"] == pytest.approx(-planned["leg_force"], abs=1e-5)


def test_a_pose_out_of_reach_has_no_forces(planned: Samples) -> None:
    position_mm = planned["position_mm"].copy()
    position_mm[3] = np.nan
    found = leg_columns(planned.machine, position_mm, planned["platform_rpy_rad"], planned["sliders_mm"])
    assert all(np.isnan(each[3]).all() and np.isfinite(np.delete(each, 3, 0)).all() for each in found.values())


def test_learned_functions_name_the_same_columns() -> None:
    assert tuple(SHARES) == BY_LOAD
