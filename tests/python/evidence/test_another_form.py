"""An effect of quite another form: measured well where geometry leaves enough of it, and then no such effect."""

from __future__ import annotations

import numpy as np
import pytest
from tests.foreign_records import samples_of

from hexdbb.diagnosis import judging_noise
from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.fit.trial import Member
from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.linear.engine import Engine
from hexdbb.evidence.linear.readings import Linear
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.search import Search
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb.samples.places import with_set_up_of
from hexdbb_truth.forms.cases import case


def form_of(samples: Samples, effect: str, element: str) -> Form:
    model = with_set_up_of(samples, new_model(samples.machine))
    search = Search(Engine(samples, model, judging_noise(samples).noise), (effect,), DEFAULT)
    (form,) = search.trials.of((Member(Known(effect, (element,))),)).forms
    assert form is not None
    return form


def test_a_drive_that_lags_above_a_speed_only_is_no_lag() -> None:
    form = form_of(samples_of("lags-above-a-speed"), "servo_lag", "2")
    assert form.is_seen and form.is_odd
    assert DEFAULT.form_as_seen < form.deviation < DEFAULT.form_limit


@pytest.mark.parametrize(
    ("name", "effect", "element", "is_seen"),
    [
        ("servo_lag-d20-x10-judge-s46", "servo_lag", "4", True),
        ("joint_friction-d20-x3-judge-s46", "joint_friction", "4", True),
        ("straightness-d20-x10-calibrate-s31", "straightness", "3", False),
    ],
)
def test_a_form_a_fifth_off_is_not_another(name: str, effect: str, element: str, is_seen: bool) -> None:
    form = form_of(Samples.of([case(name).record()]), effect, element)
    assert form.is_seen is is_seen and not form.is_odd
    assert form.deviation > 0.01


def test_what_values_push_beyond_others_is_what_these_do_not_imitate() -> None:
    draw = np.random.default_rng(7)
    own, standing = draw.normal(size=(60, 5)), draw.normal(size=5)
    at = np.array([False, True, False, True, False])
    push, rest = own[:, at] @ standing[at], own[:, ~at]
    imitated = rest @ np.linalg.solve(rest.T @ rest + np.eye(3), rest.T @ push)
    whole, left = Linear(draw.normal(size=60), own, standing).beyond(at, ~at)
    assert (whole, left) == pytest.approx((np.mean(push**2), np.mean((push - imitated) ** 2)))
