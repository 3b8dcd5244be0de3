"""Values of the set-up whose sign is open are fitted from both; those whose sign the readings determine are not."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.diagnosis import evaluate_fit, noise_of
from hexdbb.diagnosis.fit import fit_free
from hexdbb.diagnosis.mirror import settle_signs
from hexdbb.model import Model, new_model
from hexdbb.plan import load_plan
from hexdbb.rig.truth import Setup, random_truth
from hexdbb.samples import Samples
from hexdbb_truth.simulate import Pace, simulate

CUP_UM = [50.0, -80.0, 1500.0]


@pytest.fixture(scope="module")
def samples() -> Samples:
    """Seven horizontal circles about a cup that stands 1.5 mm too high."""
    plan = load_plan("standard")
    plan = plan.model_copy(update={"laps": 1, "feeds_mm_min": plan.feeds_mm_min[-1:]})
    set_up = Setup(cup_error_um=[CUP_UM], ball_offset_error_um=[0.0, 0.0, 0.0])
    truth = random_truth(3).model_copy(update={"setup": set_up})
    return Samples.of([simulate(truth, plan, seed=5, pace=Pace(11.4, 10, 2.0))])


def start_of(samples: Samples) -> Model:
    """Return the model of the cup alone."""
    model = new_model(samples.machine).with_mounts(samples.mounts)
    return model.with_free(np.array([each.effect == "cup_position" for each in model.parameters()]))


def test_height_above_horizontal_circles_has_no_sign(samples: Samples) -> None:
    found = fit_free(samples, start_of(samples))
    assert len(found.either_sign) == 1
    assert found.either_sign[0].startswith("cup_position:1 z may be")
    cup = [each.effect == "cup_position" for each in found.model.parameters()]
    np.testing.assert_array_equal(np.isnan(found.model.sigma[cup]), [False, False, True])


def test_only_the_value_whose_sign_is_open_is_fitted_again(samples: Samples) -> None:
    noise = noise_of(samples)
    starts: list[Model] = []

    def fit(start: Model) -> tuple[Model, _core.FitResult]:
        starts.append(start)
        return evaluate_fit(samples, start, start.free, noise)

    first = evaluate_fit(samples, start_of(samples), start_of(samples).free, noise)
    settle_signs(samples, first, fit, noise.sigma_mm)
    labels = [each.label for each in first[0].parameters()]
    turned = [np.flatnonzero(start.values != first[0].values) for start in starts]
    assert [[labels[at] for at in each] for each in turned] == [["cup_position:1 z"]]
