"""A user's effects stand beside the known ones: found, fitted, saved by name; what is wrong with one is named."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hexdbb.discovery import discover
from hexdbb.effects import UserEffectError, load_effects
from hexdbb.errors import InputError
from hexdbb.kinematics import inverse
from hexdbb.ledger import add_effect, undo
from hexdbb.model import Model, load_model, new_model, save_model
from hexdbb.plan import Circle
from hexdbb.record import Record
from hexdbb.samples import Samples, predict

MINE = """
import numpy as np
from hexdbb.effects import effect

@effect(port="slider_joint", unit="mm", prior_sigma=0.01, elements=3)
def dent(state):
    '''A dent of a guideway that both its carriages dip into.'''
    dip = np.exp(-(((state.sliders_mm - 225.2) / 6.6) ** 2))
    return dip[..., np.newaxis] * np.array([0.0, 0.0, -1.0])

@effect(port="slider", unit="s", prior_sigma=2e-3, elements=6)
def late(state):
    '''A lag of the servo that does not grow with the feed.'''
    return -state.velocity_mm_s * (1000.0 / 60.0) / state.feed_mm_s[:, None]

@effect(port="reading", unit="mm", prior_sigma=0.01)
def broken(state):
    return state.angle_rad / state.nothing

@effect(port="reading", unit="mm", prior_sigma=0.01)
def constant(state):
    return np.ones(len(state))
"""


@pytest.fixture(scope="module")
def mine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("own") / "mine.py"
    path.write_text(MINE)
    return path


def knowing_mine(record: Record, mine: Path) -> Model:
    return new_model(record.machine).knowing_effects(load_effects(mine))


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("broken", ":18: effect broken: AttributeError: 'Samples' object has no attribute 'nothing'"),
        ("constant", ":20: effect constant: size: the same in every sample (expected a push that depends on the"),
    ],
)
def test_what_is_wrong_is_named_before_a_verdict(
    measured: Callable[[str], Record], mine: Path, name: str, said: str
) -> None:
    record = measured("none-s1")
    with pytest.raises(UserEffectError) as refused:
        discover(Samples.of([record]), knowing_mine(record, mine), ["dent", name, "backlash"])
    assert str(refused.value).removeprefix(str(mine)).startswith(said)


def test_a_fault_no_known_effect_explains_is_found_and_kept(
    measured: Callable[[str], Record], mine: Path, tmp_path: Path
) -> None:
    record = measured("dent-x3-s1")  # guideway 3, sliders 5 and 6
    found = discover(
        Samples.of([record]), knowing_mine(record, mine), ["dent", "backlash", "straightness", "pitch_cyclic"]
    )
    assert (found.verdict, found.best and found.best.effect) == ("effect", "dent")
    assert found.best is not None and found.best.elements == ("3",)
    model = add_effect(Samples.of([record]), knowing_mine(record, mine), found.best.choice).model
    step = model.ledger[-1]
    assert step.heldout_before_um is not None and step.heldout_after_um is not None
    assert step.heldout_after_um < 0.6 * step.heldout_before_um

    path = tmp_path / "model.toml"
    save_model(model, path)
    assert "exp(" not in path.read_text()  # a name and values, nothing that runs
    with pytest.raises(InputError, match=r'effect\[\d+\].name: no effect has the name "dent".*--effects FILE.py'):
        load_model(path)
    again = load_model(path, load_effects(mine))
    assert again.values == pytest.approx(model.values, rel=1e-12)
    assert predict(Samples.of([record]), again).residual_mm == pytest.approx(
        predict(Samples.of([record]), model).residual_mm, abs=1e-9
    )
    assert [term.effect for term in undo(again).terms] == [term.effect for term in new_model(record.machine).terms]
    with pytest.raises(InputError, match="dent: an effect of your own is known in measured samples only"):
        again.engine()


def test_alike_at_one_feed_told_apart_at_another(measured: Callable[[str], Record], mine: Path) -> None:
    whole = measured("servo_lag-x10-s4")
    feed = float(np.unique(whole.columns["feed_mm_min"])[-1])
    record = whole.part(whole.columns["feed_mm_min"] == feed)
    asked = ["servo_lag", "late", "backlash"]
    found = discover(Samples.of([record]), knowing_mine(record, mine), asked)
    assert found.verdict == "ambiguous"
    assert found.best is not None
    assert {found.best.effect, *(each.partition(":")[0] for each in found.ambiguous_with)} == {"servo_lag", "late"}
    test = found.next_test
    assert test is not None and {each.partition(":")[0] for each in test.between} == {"servo_lag", "late"}
    assert test.feed_mm_min != feed and test.expected_sigmas > 10.0
    circle = Circle.model_validate(test.circle)
    poses = circle.poses(np.linspace(0.0, 2.0 * np.pi, 90), record.mount(circle.mount).cup_mm)
    assert not inverse(record.machine, poses, circle.platform_rpy_rad)[1].any()

    told = discover(Samples.of([whole]), knowing_mine(whole, mine), asked)
    assert (told.verdict, told.best and told.best.effect) == ("effect", "servo_lag")
