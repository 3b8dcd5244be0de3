"""A user's own effects: loaded from a file, tabulated, fitted like the built-in ones; what is wrong is named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.effects import SampleState, effect, load_effects, sample_state, tabulate
from hexdbb.errors import InputError
from hexdbb.kinematics import engine_machine, inverse
from hexdbb.plan import load_plan
from hexdbb.samples.state import planned_columns

PLAN = load_plan("thesis")
MACHINE = PLAN.machine_file()
COUNT = 90
HEAD = "import numpy as np\nfrom hexdbb.effects import effect\n\n"


@pytest.fixture(scope="module")
def samples() -> _core.Samples:
    runs = PLAN.runs()
    angle = np.linspace(0.0, 2.0 * np.pi, COUNT, endpoint=False)
    tables = [
        inverse(MACHINE, run.circle.poses(run.direction * angle, run.mount.cup_mm), (0.0, 0.0, 0.0)) for run in runs
    ]
    rows = np.zeros(len(runs) * COUNT, np.int32)
    circle, mount = runs[0].circle, runs[0].mount
    set_up = _core.SetUp(
        cup_mm=np.array(mount.cup_mm), ball_offset_mm=np.array(circle.ball_offset_mm), bar_length_mm=100.0
    )
    made = _core.Samples(
        sliders_mm=np.vstack([sliders for sliders, _ in tables]),
        set_up=rows,
        mount=rows,
        set_ups=[set_up],
        state=planned_columns(runs, angle),
    )
    made.derive(engine_machine(MACHINE))
    return made


@pytest.fixture(scope="module")
def state(samples: _core.Samples) -> SampleState:
    return sample_state(samples, MACHINE)


def written(tmp_path: Path, body: str) -> Path:
    path = tmp_path / "mine.py"
    path.write_text(HEAD + body)
    return path


def failure(tmp_path: Path, state: SampleState, body: str) -> str:
    """What is said of the one effect of a file; another, good one beside it goes on."""
    good = (
        "\n@effect(port='reading', unit='mm', prior_sigma=0.01)\ndef good(state):\n    return np.cos(state.angle_rad)\n"
    )
    path = written(tmp_path, body + good)
    tabulated, failed = tabulate(load_effects(path), state)
    assert [each.effect.name for each in tabulated] == ["good"]
    assert len(failed) == 1 and failed[0].exit_status == 2
    return str(failed[0]).removeprefix(str(path))


DECLARED = "@effect(port='slider', unit='mm', prior_sigma=0.01, elements=6)\ndef mine(state):\n"


def test_same_as_the_built_in_one(tmp_path: Path, samples: _core.Samples, state: SampleState) -> None:
    body = """
@effect(port="slider", unit="s", prior_sigma=2e-3, elements=6)
def my_lag(state):
    '''Lag, written anew.'''
    return -state.velocity_mm_s
"""
    (mine,), failed = tabulate(load_effects(written(tmp_path, body)), state)
    assert failed == []
    own, built_in = _core.Model(engine_machine(MACHINE)), _core.Model(engine_machine(MACHINE))
    mine.add_to(own)
    built_in.add("servo_lag", 1)
    values = np.array([1.0, -2.0, 3.0, 0.0, 5.0, -6.0]) * 1e-3
    own.values = built_in.values = values
    for some in (samples, samples.rows([7, 80, 3])):
        ours, theirs = _core.predict(own, some, True), _core.predict(built_in, some, True)
        np.testing.assert_allclose(ours.reading_mm, theirs.reading_mm, rtol=0, atol=1e-12)
        np.testing.assert_allclose(ours.jacobian, theirs.jacobian, rtol=0, atol=1e-9)
    info = mine.effect.info()
    assert (info.physics, info.group, info.element_kind) == ("Lag, written anew.", "user", "slider")


def test_parameters_and_guideways(tmp_path: Path, samples: _core.Samples, state: SampleState) -> None:
    body = """
@effect(port="slider_joint", unit="mm", prior_sigma=0.1, elements=3, parameters=("across", "up"))
def bow(state):
    shape = state.sliders_mm / 800.0
    across, up = np.zeros((len(state), 6, 3)), np.zeros((len(state), 6, 3))
    across[:, :, 0], up[:, :, 2] = shape, shape
    return across, up
"""
    (bow,), _ = tabulate(load_effects(written(tmp_path, body)), state)
    assert bow.effect.info().size == 6
    model = _core.Model(engine_machine(MACHINE))
    bow.add_to(model)
    jacobian = _core.predict(model, samples, True).jacobian
    sensitivity = _core.port_sensitivity(_core.Model(engine_machine(MACHINE)), samples)
    first = _core.PORTS["slider_joint"][0]
    for guideway in range(3):
        for parameter, axis in enumerate((0, 2)):
            expected = sum(
                sensitivity[:, first + 3 * k + axis] * state.sliders_mm[:, k] / 800.0
                for k in (2 * guideway, 2 * guideway + 1)
            )
            np.testing.assert_allclose(jacobian[:, 2 * guideway + parameter], expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("    return 1 / 0\n", ":6: effect mine: ZeroDivisionError: division by zero"),
        ("    return state.acceleration\n", ":6: effect mine: AttributeError: 'SampleState' object has no attribute"),
        ("    return state.time_s\n", ":4: effect mine: size: gives shape (180,) (expected (180, 6) at port slider)"),
        ("    return 'large'\n", ":4: effect mine: size: gives a str (expected an array of numbers of shape (180, 6))"),
        ("    pass\n", ":4: effect mine: size: gives nothing (expected to return an array of shape (180, 6))"),
        (
            "    return np.where(np.arange(len(state))[:, None] == 2, np.nan, state.sliders_mm)\n",
            ":4: effect mine: size: nan in sample 3 (expected a number)",
        ),
        ("    return np.ones((len(state), 6))\n", ":4: effect mine: size: the same in every sample (expected"),
        ("    return np.zeros((len(state), 6))\n", ":4: effect mine: size: zero in every sample (expected"),
    ],
)
def test_failure_is_named_with_file_and_line(tmp_path: Path, state: SampleState, body: str, said: str) -> None:
    assert failure(tmp_path, state, DECLARED + body).startswith(said)


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
    def stretch(state: SampleState) -> np.ndarray:
        """Legs stretch."""
        return state.leg_force

    assert stretch.info().element_kind == "leg"
    assert stretch.limit == pytest.approx(10.0)
