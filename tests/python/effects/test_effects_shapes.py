"""Shape parameters of users' effects: fitted from a distance, refused where they cannot be."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hexdbb.diagnosis import Noise, evaluate_fit
from hexdbb.effects import load_effects, same_effects
from hexdbb.errors import InputError
from hexdbb.model import Choice, Model, load_model, new_model, save_model
from hexdbb.plan import load_plan
from hexdbb.samples import Samples, linearise, port_sensitivity, predict

PLAN = load_plan("thesis")
MACHINE = PLAN.machine_file()
HEAD = "import numpy as np\nfrom hexdbb.effects import Shape, effect\n\n"
DENT = """
@effect(port="slider", unit="mm", prior_sigma=0.02, elements=6, shapes={
    "centre": Shape({start}, prior_sigma=50.0, lower=0.0, upper=900.0),
    "width": Shape(20.0, prior_sigma=8.0, lower=2.0),
})
def dent(samples, centre, width):
    '''A dent.'''
    return np.exp(-(((samples["sliders_mm"] - centre) / width) ** 2))
"""
ELEMENT, HEIGHT_MM, WIDTH_MM, NOISE_MM = 4, 0.02, 14.0, 2e-4


@pytest.fixture(scope="module")
def samples() -> Samples:
    angle = np.arange(360) * (2.0 * np.pi / 360)
    return Samples.planned(MACHINE, PLAN.runs(), angle, 100.0)


@pytest.fixture(scope="module")
def centre_mm(samples: Samples) -> float:
    """Where the dent of these tests lies: off the middle of what slider 4 passes."""
    return float(np.quantile(samples["sliders_mm"][:, ELEMENT - 1], 0.35))


@pytest.fixture(scope="module")
def measured(samples: Samples, centre_mm: float) -> Samples:
    """The same circles with readings: what a dent of slider 4 does to first order, written out anew, and noise."""
    push = HEIGHT_MM * np.exp(-(((samples["sliders_mm"][:, ELEMENT - 1] - centre_mm) / WIDTH_MM) ** 2))
    nominal = new_model(MACHINE, [])
    answer = port_sensitivity(samples, nominal)["slider"][:, ELEMENT - 1]
    noise = np.random.default_rng(4).normal(0.0, NOISE_MM, len(samples))
    reading = predict(samples, nominal).reading_mm + answer * push + noise
    taken = Samples.planned(MACHINE, PLAN.runs(), np.arange(360) * (2.0 * np.pi / 360), 100.0)
    taken["reading_mm"][:] = reading
    return taken


def written(tmp_path: Path, body: str) -> Path:
    path = tmp_path / "mine.py"
    path.write_text(HEAD + body)
    return path


def with_dent(tmp_path: Path, start: float) -> Model:
    effects = load_effects(written(tmp_path, DENT.replace("{start}", f"{start!r}")))
    return new_model(MACHINE, []).knowing_effects(effects).with_effect(Choice("dent", (str(ELEMENT),)))


@pytest.mark.parametrize("off_mm", [0.0, 30.0, -60.0])
def test_a_dent_is_found_from_a_start_several_widths_away(
    tmp_path: Path, measured: Samples, centre_mm: float, off_mm: float
) -> None:
    model = with_dent(tmp_path, centre_mm + off_mm)
    fitted, result = evaluate_fit(measured, model, model.free, Noise(NOISE_MM, "stated"))
    size, centre, width = fitted.values[3 * (ELEMENT - 1) : 3 * ELEMENT]
    sigma = fitted.sigma[3 * (ELEMENT - 1) : 3 * ELEMENT]
    assert abs(centre - centre_mm) < 4.0 * sigma[1] < 1.0
    assert abs(width - WIDTH_MM) < 4.0 * sigma[2] < 1.5
    assert abs(size - HEIGHT_MM) < 4.0 * sigma[0] < 2e-3
    assert result.rms_after_mm == pytest.approx(NOISE_MM, rel=0.05)


def test_the_derivative_by_a_shape_is_that_of_the_prediction(
    tmp_path: Path, samples: Samples, centre_mm: float
) -> None:
    model = with_dent(tmp_path, centre_mm)
    values = model.values.copy()
    at = 3 * (ELEMENT - 1)
    values[at : at + 3] = 0.02, centre_mm - 10.0, 25.0
    jacobian = linearise(samples, model.with_values(values)).jacobian
    for index, step in ((at + 1, 0.05), (at + 2, 0.05)):
        ends = []
        for sign in (1.0, -1.0):
            moved = values.copy()
            moved[index] += sign * step
            ends.append(predict(samples, model.with_values(moved)).reading_mm)
        slope = (ends[0] - ends[1]) / (2.0 * step)
        assert np.abs(slope).max() > 1e-5
        np.testing.assert_allclose(jacobian[:, index], slope, rtol=0, atol=2e-3 * np.abs(slope).max())


def test_shapes_stand_in_the_file_as_they_are(tmp_path: Path) -> None:
    model = with_dent(tmp_path, 400.0)
    save_model(model, tmp_path / "model.toml")
    text = (tmp_path / "model.toml").read_text()
    assert "value = 400.0" in text and 'unit = "mm"' in text
    back = load_model(tmp_path / "model.toml", load_effects(tmp_path / "mine.py"))
    np.testing.assert_array_equal(back.values, model.values)
    assert not back.without_effect(Choice("dent", (str(ELEMENT),))).terms


def test_effects_made_in_a_loop_are_all_there(tmp_path: Path, samples: Samples) -> None:
    body = """
for k in range(3):
    @effect(port="slider", unit="mm", prior_sigma=0.01, elements=6, name=f"harmonic_{k + 1}")
    def harmonic(samples, k=k):
        return np.sin(2.0 * np.pi * (k + 1) * samples["sliders_mm"] / 5.0)
"""
    effects = load_effects(written(tmp_path, body))
    assert [each.name for each in effects] == ["harmonic_1", "harmonic_2", "harmonic_3"]
    assert same_effects(effects, samples) == {}


def test_two_effects_that_are_the_same_are_refused(tmp_path: Path, samples: Samples) -> None:
    body = """
for k in range(2):
    @effect(port="slider", unit="mm", prior_sigma=0.01, elements=6, name=f"same_{k}")
    def one(samples, k=k):
        return (1.0 + k) * samples["velocity_mm_s"]
"""
    (error,) = same_effects(load_effects(written(tmp_path, body)), samples).values()
    assert "mine.py:6: effect same_1: the same as effect same_0 of line 6" in str(error)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("lower=0.0", "lower=450.0", "shape centre: start 400 mm (expected it within its domain, 450 to 900 mm)"),
        ("prior_sigma=8.0", "prior_sigma=0.0", "shape width: prior_sigma 0.0 (expected a number > 0)"),
        ("samples, centre, width", "samples, centre", "shape width: the function takes no 'width'"),
        ("Shape(20.0, prior_sigma=8.0, lower=2.0)", "20.0", "shape width: 20.0 (expected Shape("),
        ('"width":', '"size":', "shape size: the name of a parameter too"),
    ],
)
def test_a_shape_that_cannot_be_is_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    path = written(tmp_path, DENT.replace("{start}", "400.0").replace(old, new))
    with pytest.raises(InputError) as caught:
        load_effects(path)
    assert str(caught.value).startswith(f"{path}:5: effect dent: ") and said in str(caught.value)
