"""A user's own effects: loaded from a file, tabulated, fitted like the built-in ones; what is wrong is named."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hexdbb.effects import UserEffect, UserEffectError, effect, load_effects
from hexdbb.errors import InputError
from hexdbb.model import Choice, Model, new_model
from hexdbb.plan import load_plan
from hexdbb.samples import Samples, linearise, port_sensitivity, predict

PLAN = load_plan("thesis")
MACHINE = PLAN.machine_file()
COUNT = 90
HEAD = "import numpy as np\nfrom hexdbb.effects import effect\n\n"


@pytest.fixture(scope="module")
def samples() -> Samples:
    angle = np.arange(COUNT) * (2.0 * np.pi / COUNT)
    return Samples.planned(MACHINE, PLAN.runs(), angle, 100.0)


def written(tmp_path: Path, body: str) -> Path:
    path = tmp_path / "mine.py"
    path.write_text(HEAD + body)
    return path


DECLARED = "@effect(port='slider', unit='mm', prior_sigma=0.01, elements=6)\ndef mine(samples):\n"


def with_effects(effects: list[UserEffect]) -> Model:
    """A model with users' effects alone, all values zero."""
    model = new_model(MACHINE, []).knowing_effects(effects)
    for each in effects:
        model = model.with_effect(Choice(each.name))
    return model


def test_same_as_the_built_in_one(tmp_path: Path, samples: Samples) -> None:
    body = """
@effect(port="slider", unit="s", prior_sigma=2e-3, elements=6)
def my_lag(samples):
    '''Lag, written anew.'''
    return -samples["velocity_mm_s"]
"""
    effects = load_effects(written(tmp_path, body))
    values = np.array([1.0, -2.0, 3.0, 0.0, 5.0, -6.0]) * 1e-3
    own, built_in = (each.with_values(values) for each in (with_effects(effects), new_model(MACHINE, ["servo_lag"])))
    for some in (samples, samples.part(np.array([7, 80, 3]))):
        ours, theirs = linearise(some, own), linearise(some, built_in)
        np.testing.assert_allclose(ours.reading_mm, theirs.reading_mm, rtol=0, atol=1e-12)
        np.testing.assert_allclose(ours.jacobian, theirs.jacobian, rtol=0, atol=1e-9)
    info = effects[0].info()
    assert (info.physics, info.group, info.element_kind) == ("Lag, written anew.", "user", "slider")


def test_parameters_and_guideways(tmp_path: Path, samples: Samples) -> None:
    body = """
@effect(port="slider_joint", unit="mm", prior_sigma=0.1, elements=3, parameters=("across", "up"))
def bow(samples):
    form = samples["sliders_mm"] / 800.0
    across, up = np.zeros((len(samples), 6, 3)), np.zeros((len(samples), 6, 3))
    across[:, :, 0], up[:, :, 2] = form, form
    return across, up
"""
    model = with_effects(load_effects(written(tmp_path, body)))
    assert len(model.values) == 6
    jacobian = linearise(samples, model).jacobian
    sensitivity = port_sensitivity(samples, new_model(MACHINE, []))["slider_joint"]
    for guideway in range(3):
        for parameter, axis in enumerate((0, 2)):
            expected = sum(
                sensitivity[:, k, axis] * samples["sliders_mm"][:, k] / 800.0 for k in (2 * guideway, 2 * guideway + 1)
            )
            np.testing.assert_allclose(jacobian[:, 2 * guideway + parameter], expected, rtol=0, atol=1e-12)


def test_a_column_is_an_attribute_too_and_the_function_is_called_once_for_all_parts(
    tmp_path: Path, samples: Samples
) -> None:
    """Files written before columns had names in brackets go on working."""
    calls = []
    (mine,) = load_effects(written(tmp_path, DECLARED + "    return samples.velocity_mm_s\n"))
    counted = replace(mine, basis=lambda given: calls.append(len(given)) or mine.basis(given))
    model = with_effects([counted]).with_values(np.full(6, 1e-3))
    whole = predict(samples, model).reading_mm
    for rows in (np.arange(0, len(samples), 3), np.arange(len(samples)) % 2 == 0):
        np.testing.assert_allclose(predict(samples.part(rows), model).reading_mm, whole[rows], rtol=0, atol=1e-12)
    assert calls == [len(samples)]


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("    return 1 / 0\n", ":6: effect mine: ZeroDivisionError: division by zero"),
        ("    return samples.acceleration\n", ":6: effect mine: AttributeError: 'Samples' object has no attribute"),
        (
            "    return samples['time_s']\n",
            ":4: effect mine: size: returns shape (180,) (expected (180, 6) at port slider)",
        ),
        (
            "    return 'large'\n",
            ":4: effect mine: size: returns a str (expected an array of numbers of shape (180, 6))",
        ),
        ("    pass\n", ":4: effect mine: size: returns nothing (expected an array of shape (180, 6))"),
        (
            "    return np.where(np.arange(len(samples))[:, None] == 2, np.nan, samples.sliders_mm)\n",
            ":4: effect mine: size: nan in sample 3 (expected a number)",
        ),
        ("    return np.ones((len(samples), 6))\n", ":4: effect mine: size: the same in every sample (expected"),
        ("    return np.zeros((len(samples), 6))\n", ":4: effect mine: size: zero in every sample (expected"),
    ],
)
def test_failure_is_named_with_file_and_line(tmp_path: Path, samples: Samples, body: str, said: str) -> None:
    path = written(tmp_path, DECLARED + body)
    (mine,) = load_effects(path)
    with pytest.raises(UserEffectError) as caught:
        mine.require_usable(samples)
    assert str(caught.value).removeprefix(str(path)).startswith(said)
    assert caught.value.exit_status == 2


def test_in_a_part_of_a_record_an_effect_may_be_the_same_everywhere(tmp_path: Path, samples: Samples) -> None:
    (mine,) = load_effects(written(tmp_path, DECLARED + "    return np.ones((len(samples), 6))\n"))
    assert mine.tabulated(samples).per_unit.shape == (len(samples), 6)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("def f(:\n", "mine.py:4: SyntaxError"),
        ("import no_such_module\n", "mine.py:4: ModuleNotFoundError: No module named 'no_such_module'"),
        ("x = 1\n", "mine.py: declares no effect"),
        (
            DECLARED.replace("slider'", "wheel'") + "    return 1\n",
            "mine.py:4: effect mine: port 'wheel' (expected one of slider",
        ),
        (DECLARED.replace("=6", "=4") + "    return 1\n", "mine.py:4: effect mine: elements 4 (expected 1 or 3 or 6"),
        (
            DECLARED.replace("0.01", "0.0") + "    return 1\n",
            "mine.py:4: effect mine: prior_sigma 0.0 (expected a number > 0)",
        ),
        (
            DECLARED.replace("mine", "backlash") + "    return 1\n",
            "mine.py:4: effect backlash: the name is that of a known",
        ),
    ],
)
def test_file_that_declares_nothing_useful(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        load_effects(written(tmp_path, text))
    assert said in str(caught.value)


def test_no_such_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        load_effects(tmp_path / "none.py")


def test_decorated_function_is_a_value() -> None:
    @effect(port="leg", unit="mm", prior_sigma=0.1, elements=6)
    def stretch(samples: Samples) -> np.ndarray:
        """Legs stretch."""
        return samples["leg_force"]

    assert stretch.info().element_kind == "leg"
    assert stretch.limit == pytest.approx(10.0)
