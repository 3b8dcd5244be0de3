"""A learned effect from data to file and back: found on a machine that has what its model lacks, kept completely."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.diagnosis import Diagnosis, diagnose
from hexdbb.diagnosis.text import diagnosis_text
from hexdbb.effects import draft, load_effects
from hexdbb.errors import InputError
from hexdbb.files.plain_text import plain_text
from hexdbb.learned import Learned, Space, hypotheses
from hexdbb.ledger import add_effect, fit_model, undo
from hexdbb.model import Choice, LearnedEffect, Model, load_model, new_model, save_model
from hexdbb.plan import load_plan
from hexdbb.plots import learned_figure
from hexdbb.samples import Samples, predict
from hexdbb_truth.cases import case
from hexdbb_truth.simulate import Pace

PACE = Pace(rate_hz=6.0, instants_per_sample=1)
CASE = case("pitch_cyclic-x10-s4", PACE)
HIDDEN = CASE.hidden[0]
NAME = f"learned:slider:{HIDDEN.element}:screw_phase"
TURN = 2.0 * np.pi
PLAN = load_plan("thesis")
LEAD_MM = PLAN.machine_file().sliders.screw_lead_mm


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of([CASE.record(temperature=False)])


@pytest.fixture(scope="module")
def before(samples: Samples) -> Model:
    return fit_model(samples, new_model(samples.machine), check_held_out=False).model


@pytest.fixture(scope="module")
def found(samples: Samples, before: Model) -> Diagnosis:
    return add_effect(samples, before, NAME)


@pytest.fixture(scope="module")
def planned() -> Samples:
    return Samples.planned(PLAN.machine_file(), PLAN.runs(), np.arange(180) * (2.0 * np.pi / 180), 100.0)


def text_of(model: Model, folder: Path) -> str:
    save_model(model, folder / "written.toml")
    return (folder / "written.toml").read_text()


def learned(model: Model) -> LearnedEffect:
    term = model.term(NAME)
    assert term is not None and term.learned is not None
    return term.learned


def test_what_the_model_lacked_is_learned_where_it_was_not_fitted(found: Diagnosis) -> None:
    step = found.model.ledger[-1]
    noise_um = found.noise.sigma_mm * 1e3
    assert (step.what, step.effect, step.element_kind) == ("add", NAME, "slider")
    assert step.rms_before_um > 5.0 * noise_um
    assert step.rms_after_um < 1.15 * noise_um
    assert step.heldout_after_um < 1.3 * noise_um
    assert [(size.name, size.unit) for size in step.sizes] == [("range", "um")]


def test_learned_functions_bend_no_readings(
    samples: Samples, found: Diagnosis, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The covariance leaves their second order out; taken in, as of any other effect, it is the same."""
    own = learned(found.model).info

    def not_learned(effect: LearnedEffect) -> _core.EffectInfo:
        info = own()
        return _core.EffectInfo(
            name=info.name,
            physics=info.physics,
            source="the test",
            element_kind=info.element_kind,
            elements=info.elements,
            parameters=info.parameters,
            ports=info.ports,
        )

    without = diagnose(samples, found.model, check_held_out=False)
    monkeypatch.setattr(LearnedEffect, "info", not_learned)
    complete = diagnose(Samples.of(samples.records), found.model, check_held_out=False)  # it is tabulated anew
    free = found.model.free
    np.testing.assert_allclose(
        np.diag(without.covariance)[free], np.diag(complete.covariance)[free], rtol=1e-3, atol=0.0
    )
    assert not np.array_equal(without.covariance, complete.covariance)


def test_learned_functions_alone_have_a_covariance(samples: Samples, found: Diagnosis) -> None:
    own = np.array([each.effect == NAME for each in found.model.parameters()])
    model = found.model.with_free(found.model.free & own)
    alone = diagnose(samples, model, check_held_out=False)
    assert alone.usable
    assert (np.diag(alone.covariance)[model.free] > 0.0).all()


def test_its_function_is_the_machine_s_within_the_band(found: Diagnosis) -> None:
    (curve,) = learned(found.model).curves(found.model.terms[-1].values)
    turn = 2.0 * np.pi * curve.at / LEAD_MM
    table = np.column_stack([np.ones(len(turn)), *(f(k * turn) for k in (1, 2) for f in (np.sin, np.cos))])
    _, *parts = np.linalg.lstsq(table, 1e3 * curve.value_mm, rcond=None)[0]
    band_um = 1e3 * float(np.median(curve.sigma_mm))
    assert 0.0 < band_um < 0.2 * HIDDEN.mechanism.amplitude_um
    # B-splines of 12 intervals follow the second harmonic to some per cent.
    assert np.hypot(*parts[:2]) == pytest.approx(HIDDEN.mechanism.amplitude_um, abs=4.0 * band_um)
    assert np.hypot(*parts[2:]) == pytest.approx(HIDDEN.mechanism.second_amplitude_um, abs=4.0 * band_um)
    assert curve.samples.sum() == len(found.samples)


def test_the_file_holds_it_to_the_last_digit(found: Diagnosis, tmp_path: Path) -> None:
    text = text_of(found.model, tmp_path)
    back = load_model(tmp_path / "written.toml")
    assert text_of(back, tmp_path) == text
    np.testing.assert_array_equal(
        predict(found.samples, back).reading_mm,
        predict(found.samples, load_model(tmp_path / "written.toml")).reading_mm,
    )
    np.testing.assert_allclose(
        predict(found.samples, back).reading_mm, predict(found.samples, found.model).reading_mm, rtol=0, atol=1e-12
    )
    assert learned(back).sigma_mm == pytest.approx(learned(found.model).sigma_mm)


def test_a_file_of_the_first_version_means_what_it_meant(found: Diagnosis, tmp_path: Path) -> None:
    text = text_of(found.model, tmp_path)
    (tmp_path / "old.toml").write_text(text.replace("since_s = ", "middle_s = "))
    assert text_of(load_model(tmp_path / "old.toml"), tmp_path) == text


def test_a_step_is_undone_to_the_file_there_was(before: Model, found: Diagnosis, tmp_path: Path) -> None:
    text_of(found.model, tmp_path)
    assert text_of(undo(load_model(tmp_path / "written.toml")), tmp_path) == text_of(before, tmp_path)
    assert "learned" not in text_of(before, tmp_path)


def test_an_earlier_state_with_it_comes_back_whole(found: Diagnosis, tmp_path: Path) -> None:
    refitted = fit_model(found.samples, found.model, check_held_out=False).model
    text_of(refitted, tmp_path)
    back = undo(load_model(tmp_path / "written.toml"))
    assert text_of(back, tmp_path) == text_of(found.model, tmp_path)


def test_a_diagnosis_shows_its_function_and_not_its_coefficients(found: Diagnosis) -> None:
    text = plain_text(diagnosis_text(found))
    assert "axis_1" not in text
    assert f"slider {HIDDEN.element} along its guideway over the turn of the screw" in text
    assert "value, µm" in text and NAME in text


def test_it_is_drawn_with_band_and_samples(found: Diagnosis) -> None:
    figure = learned_figure(found.model, NAME)
    above, below = figure.axes
    (line, _) = above.get_lines()
    (curve,) = learned(found.model).curves(found.model.terms[-1].values)
    np.testing.assert_allclose(line.get_ydata(), 1e3 * curve.value_mm)
    assert above.collections and below.collections
    with pytest.raises(InputError, match="no learned effect"):
        learned_figure(found.model, "learned:leg:1:time")


def test_it_cannot_be_added_twice(found: Diagnosis) -> None:
    with pytest.raises(InputError, match="has it already"):
        add_effect(found.samples, found.model, NAME)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("learned:wheel:1:time", "place 'wheel' (expected learned:PLACE, one of slider, leg"),
        ("learned:leg:7:time", "element '7' (expected one of 1, 2, 3, 4, 5, 6, 1-2, 3-4, 5-6, all, each)"),
        ("learned:leg:5:heat", "variable 'heat' (expected one of position"),
        ("learned:leg:5:warming", "warming_k has 0 different values (expected more)"),
        ("learned:vertical:all:position", "element 'all' (expected one of 1, 2, 3)"),
    ],
)
def test_what_is_not_there_is_refused_by_name(samples: Samples, before: Model, name: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        add_effect(samples, before, name)
    assert str(caught.value).startswith(f"{name}: ") and said in str(caught.value)


def test_every_hypothesis_is_found_by_its_name_and_reaches_its_port(planned: Samples) -> None:
    for hypothesis in (*hypotheses(), *hypotheses(of_forms=True)):
        assert Learned.parse(hypothesis.name) == hypothesis
    names = ["learned:lateral:2:position", "learned:platform_joint:3:constant", "learned:ball:time"]
    for name in names:
        space = Space.of(Learned.parse(name), planned, LEAD_MM)
        effect = LearnedEffect(space, 10.0, 0.01)
        table = effect.tabulated(planned)
        assert table.per_unit.shape == (len(planned), len(table.values))
        assert set(table.values) == set(range(effect.size))
    # At one height with a level platform the legs keep their angle to it.
    with pytest.raises(InputError, match="platform_joint_angle_rad hardly varies in these samples"):
        Space.of(Learned.parse("learned:platform_joint:3:joint_angle"), planned, LEAD_MM)


def made(planned: Samples, name: str, function: Callable[[np.ndarray], np.ndarray]) -> Model:
    """A model with a learned effect that is some function of its variable, fitted to it point by point."""
    space = Space.of(Learned.parse(name), planned, LEAD_MM)
    points = space.points()
    effect = LearnedEffect(space, 0.1, 0.01)
    basis = space.functions(points) @ effect.factor
    values = np.linalg.lstsq(basis, function(points), rcond=None)[0]
    band = np.full(len(points) * space.hypothesis.components, 3e-4)
    effect = LearnedEffect(space, 0.1, 0.01, tuple(band), tuple(space.counts(planned)))
    model = new_model(planned.machine, []).knowing_effects([effect])
    return model.with_effect(Choice.parse(name)).with_values(values)


@pytest.mark.parametrize(
    ("name", "function", "shapes"),
    [
        (
            "learned:slider:4:position",
            lambda x: 0.02 * np.exp(-(((x - x.mean()) / (0.2 * np.ptp(x))) ** 2)),
            {"centre", "width"},
        ),
        (
            "learned:slider:2:screw_phase",
            lambda x: 0.005 * np.sin(TURN * x / LEAD_MM + 1.0),
            {"period", "phase"},
        ),
        ("learned:leg:5:turning_rate", lambda x: 0.004 * np.tanh(x / 1e-3), set()),
        ("learned:leg:all:leg_force", lambda x: 0.03 * x, set()),
        ("learned:vertical:2:position", lambda x: 1e-7 * (x - x.mean()) ** 2 * np.sin(x / 40.0), set()),
        ("learned:leg:3:direction_position", lambda x: 0.01 + 1e-5 * x, set()),
        ("learned:leg:2:leg_force_lagged@7.5", lambda x: 0.03 * x, set()),
        ("learned:slider:4:time_position", lambda x: 1e-4 * (x - x.mean()), set()),
        ("learned:vertical:2:time_position_bent", lambda x: 1e-4 * (x - x.mean()), set()),
        ("learned:vertical:2:time_position_settling@150", lambda x: 1e-4 * (x - x.mean()), set()),
        ("learned:vertical:3:position_heated@40", lambda x: 1e-5 * (x - x.mean()), set()),
        ("learned:platform_joint:5-6:course", lambda x: 0.01 + 0.0 * x, set()),
        ("learned:platform_joint:1:course_speed", lambda x: 0.01 + 1e-4 * x, set()),
        ("learned:slider:3:velocity_lingering@30", lambda x: 1e-5 * x**2, {"period", "phase"}),
        ("learned:leg:2:velocity_lingering@30", lambda x: 1e-5 * x**2, {"period", "phase"}),
        ("learned:leg:5:position_lingering@6", lambda x: 1e-4 * (x - x.mean()), set()),
        ("learned:reading:angle_lingering@4.5", lambda x: 0.01 * np.sin(x + 0.3), {"period", "phase"}),
    ],
)
def test_a_draft_pushes_what_was_learned(
    tmp_path: Path, planned: Samples, name: str, function: Callable[[np.ndarray], np.ndarray], shapes: set[str]
) -> None:
    model = made(planned, name, function)
    path = tmp_path / "draft.py"
    path.write_text(draft(model, name))
    (drafted,) = load_effects(path)
    drafted.require_usable(planned)
    assert set(drafted.shapes) == shapes
    term = model.term(name)
    assert term is not None and term.learned is not None
    (curve,) = term.learned.curves(term.values)
    own = drafted.tabulated(planned)
    height_mm = float(next(line for line in path.read_text().splitlines() if "As learned" in line).split()[5])
    theirs = term.learned.tabulated(planned).pushes(np.arange(len(planned))) @ term.values
    ours = own.pushes(np.arange(len(planned)))[:, :, 0] * height_mm
    assert np.abs(theirs).max() > 1e-3
    assert np.abs(ours - theirs).max() < 2.0 * float(np.median(curve.sigma_mm))


def drafts_of_six(path: Path, planned: Samples, name: str) -> tuple[list[str], LearnedEffect, np.ndarray, np.ndarray]:
    """Draft a function of six components that differ in size, and check that the drafts push what it pushes.

    Returns
    -------
    list of str, LearnedEffect, ndarray, ndarray
        The drafts' names, the effect, its values, what it pushes.
    """
    effect = LearnedEffect(Space.of(Learned.parse(name), planned, LEAD_MM), 0.1, 0.01)
    model = new_model(planned.machine, []).knowing_effects([effect]).with_effect(Choice.parse(name))
    points = effect.space.points()
    line = np.linalg.lstsq(effect.space.functions(points) @ effect.factor, 1e-4 * points, rcond=None)[0]
    model = model.with_values(np.kron([1.0, -2.0, 3.0, 0.5, 1.5, -1.0], line))
    path.write_text(draft(model, name))
    drafted, rows = load_effects(path), np.arange(len(planned))
    lines = (line for line in path.read_text().splitlines() if "As learned" in line)
    heights_mm = [float(line.split()[5]) for line in lines]
    ours = sum(
        each.tabulated(planned).pushes(rows)[:, :, 0] * height_mm
        for each, height_mm in zip(drafted, heights_mm, strict=True)
    )
    theirs = effect.tabulated(planned).pushes(rows) @ model.values
    assert np.abs(theirs).max() > 1e-3
    assert ours == pytest.approx(theirs, abs=1e-3 * float(np.abs(theirs).max()))
    return [each.name for each in drafted], effect, model.values, theirs


def test_drafts_of_a_load_share_it_among_the_legs(tmp_path: Path, planned: Samples) -> None:
    names, *_ = drafts_of_six(tmp_path / "draft.py", planned, "learned:load:position_along@40")
    assert [each.rpartition("40_")[2] for each in names] == [
        f"{how}_{axis}" for how in ("pull", "turn") for axis in "xyz"
    ]


def test_drafts_of_six_elements_push_one_each(tmp_path: Path, planned: Samples) -> None:
    names, effect, values, pushed = drafts_of_six(tmp_path / "draft.py", planned, "learned:slider:each:position")
    assert [each[-2:] for each in names] == [f"_{each}" for each in range(1, 7)]
    assert np.count_nonzero(np.abs(pushed).max(axis=0) > 1e-3) == 6
    tables = effect.tables(values, planned.machine)
    assert [table.pushes[0][0] for table in tables] == [0, 1, 2, 3, 4, 5]


def test_tables_for_a_compensation_are_the_function(planned: Samples) -> None:
    model = made(planned, "learned:leg:5:turning_rate", lambda x: 0.004 * np.tanh(x / 1e-3))
    term = model.terms[0]
    assert term.learned is not None
    (table,) = term.learned.tables(term.values, PLAN.machine_file())
    assert (table.port, table.column, table.times) == ("leg", "slider_joint_rate_rad_s", "")
    ((element, ((port, weight),)),) = table.pushes
    assert all(np.diff(table.knots) > 0.0)
    push = weight * np.interp(planned[table.column][:, element], table.knots, table.values_mm)
    theirs = (term.learned.tabulated(planned).pushes(np.arange(len(planned))) @ term.values)[:, port]
    assert np.abs(push - theirs).max() < 0.03 * np.abs(theirs).max()
