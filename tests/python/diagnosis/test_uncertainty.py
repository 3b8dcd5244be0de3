"""Stated uncertainties against the truth, on a part of the machines of docs/uncertainty.md."""

import numpy as np
import pytest
from tests.truth.coverage import study_plan, trial

MACHINES = 24


@pytest.fixture(scope="module")
def trials():
    plan = study_plan()
    return [trial(seed, plan) for seed in range(1001, 1001 + MACHINES)]


def test_rank_of_the_seven_circles(trials):
    assert {each.rank for each in trials} == {21}


def test_intervals_hold_the_truth(trials):
    inside = np.concatenate([each.inside for each in trials])
    assert len(inside) > 12 * MACHINES
    # Values of one machine are correlated, so that the share itself is uncertain by about 3 %.
    assert 0.88 < inside.mean() <= 1.0
    assert max(each.worst_sigmas for each in trials) < 4.0


def test_residual_is_the_noise(trials):
    assert np.median([each.residual_over_noise for each in trials]) == pytest.approx(1.0, abs=0.02)


def test_unseen_poses_are_twenty_times_better(trials):
    assert min(each.position_before_um / each.position_after_um for each in trials) > 20.0
