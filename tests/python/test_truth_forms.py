"""Cases with forms: forms deviate as stated, faults act where their labels say, sizes are reached, halves differ."""

from __future__ import annotations

import ast
import itertools
from pathlib import Path

import numpy as np
import pytest
from tests.truth.forms import plans
from tests.truth.forms.cases import (
    CATALOGUED,
    FAMILIES,
    HALVES,
    OUTSIDE,
    alone,
    case,
    clean,
    combined,
    outside,
    reachable,
)
from tests.truth.forms.deviation import Formed, measured_deviation
from tests.truth.forms.fit import fitted, geometry_readings_mm, true_values
from tests.truth.forms.history import History, monotone
from tests.truth.forms.labels import VARIABLES
from tests.truth.forms.measure import Measured
from tests.truth.forms.operators import lost_motion, lowpass, presliding, travel_since_reversal, windup
from tests.truth.forms.ports import Action, add
from tests.truth.forms.sizes import UnreachableSizeError, remaining
from tests.truth.simulate import Pace, true_readings_mm

from hexdbb import _core
from hexdbb.diagnosis import diagnose
from hexdbb.errors import InputError
from hexdbb.model import new_model
from hexdbb.plan import Plan, load_plan
from hexdbb.record import read_record
from hexdbb.rig.mechanisms import MECHANISMS, Motion, Push
from hexdbb.rig.truth import TruthFile, random_truth
from hexdbb.samples import Samples

FORMS = Path(__file__).parents[1] / "truth" / "forms"
ESTIMATOR_FREE = {"errors", "validation", "machine", "plan", "record", "rig"}
PORTS = {"slider", "leg", "guideway", "platform_joint", "ball", "cup", "reading"}


def short_plan() -> Plan:
    """One tilted circle, one lap each way at two feeds."""
    plan = load_plan("standard")
    return plan.model_copy(update={"circles": plan.circles[1:2], "laps": 1, "overshoot_deg": 20.0})


@pytest.fixture(scope="module")
def short() -> Measured:
    return Measured(random_truth(6), History(short_plan(), Pace(6.0, 12, 2.0)))


def every_form():
    return [
        pytest.param(kind, half, number, id=f"{kind}-{form.__name__.strip('_')}")
        for kind, family in FAMILIES.items()
        for half in HALVES
        for number, form in enumerate(getattr(family, half))
    ]


def formed(kind: str, half: str, number: int, deviation: float, seed: int = 3) -> Formed:
    draw, family = np.random.default_rng(seed), FAMILIES[kind]
    exact = family.exact(draw)
    odd = getattr(family, half)[number](draw, exact)
    return Formed(exact.port, exact.elements, exact.formula, exact.others, odd, deviation)


# --- independence -----------------------------------------------------------------------------------------------------


def test_the_truth_with_forms_imports_nothing_of_the_estimator():
    files = sorted(FORMS.glob("*.py"))
    assert len(files) > 10
    for path in files:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            names += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            for name in names:
                if name.startswith("hexdbb"):
                    assert name.split(".")[1] in ESTIMATOR_FREE, f"{path.name} imports {name}"


def test_every_effect_of_the_catalogue_has_forms_and_the_halves_share_none():
    assert set(CATALOGUED) == set(_core.effect_names("catalogue"))
    assert set(FAMILIES) == set(VARIABLES)
    for kind, family in FAMILIES.items():
        assert family.calibrate, kind
        assert family.judge, kind
        assert not set(family.calibrate) & set(family.judge), kind


# --- the catalogue's formulas -----------------------------------------------------------------------------------------


def rig_table(kind: str, measured: Measured, size: float, values: np.ndarray, elements: tuple[int, ...]):
    """The rig's mechanism of the same size; sign and direction as they were drawn are read off the values."""
    sign = float(np.sign(values.reshape(-1)[np.argmax(np.abs(values))]))
    axis = elements[0] + 1 if elements else None
    drives = measured.history.drive_mm[measured.history.samples]
    match kind:
        case "backlash":
            return {"slider": axis, "width_um": size}
        case "lead_error":
            middle = sum(measured.history.machine.sliders.travel_mm) / 2.0
            slope = np.polyfit(drives[:, elements[0]] - middle, values[:, 0], 1)[0]
            return {"slider": axis, "error_um_m": float(np.sign(slope)) * size}
        case "gravity_sag":
            return {"compliance_um_n": size}
        case "joint_offset":
            return {"leg": axis, "offset_um": (1e3 * values[0]).tolist()}
        case "bar_drift":
            return {"rate_um_min": sign * size / 60.0}
        case "sample_delay":
            return {"delay_ms": size}
    raise AssertionError(kind)


@pytest.mark.parametrize(
    ("kind", "size"),
    [("backlash", 20.0), ("lead_error", 300.0), ("joint_offset", 40.0), ("bar_drift", 80.0), ("gravity_sag", 0.5)],
)
def test_without_deviation_a_fault_reads_as_the_rigs_own_mechanism(short, kind, size):
    """Another implementation, stepped in time, at the rig's own ports."""
    action = formed(kind, "judge", 0, 0.0).action()
    scene = short.scene(short.history.samples)
    table = rig_table(kind, short, size, action.values(scene, size), action.elements)
    truth = short.truth.model_copy(update={"mechanism": (MECHANISMS[kind].model_validate(table),)})
    # The rig's simulator makes instants between samples for mechanisms with a memory alone.
    expected = true_readings_mm(truth, short.history.plan, short.history.pace)
    shown = short.readings_mm([(action, size)])
    difference = np.abs(shown - expected).max()
    change = np.abs(shown - short.readings_mm([])).max()
    assert change > 1e-3
    assert difference < 2e-4 * change


def test_a_delay_reads_what_is_true_later(short):
    action = formed("sample_delay", "judge", 0, 0.0).action()
    dt_ms = 1e3 * short.history.dt_s
    rows = short.history.samples[5:50]
    expected = short.readings_mm([], rows + 3)
    np.testing.assert_allclose(short.readings_mm([(action, 3.0 * dt_ms)], rows), expected, atol=1e-9)
    with pytest.raises(InputError, match="outside the run"):
        short.readings_mm([(action, 1e5)])


def test_a_scale_error_is_a_share_of_the_deflection(short):
    action = formed("bar_gain", "judge", 0, 0.0).action()
    plain, wrong = short.readings_mm([]), short.readings_mm([(action, 2.0)])
    ratio = (wrong / plain)[np.abs(plain) > 1e-3]
    np.testing.assert_allclose(np.abs(ratio - 1.0), 0.02, rtol=1e-9)


# --- operators --------------------------------------------------------------------------------------------------------


def wandering(n: int = 3000) -> np.ndarray:
    time = np.arange(n) * 0.01
    return 5.0 * np.sin(0.9 * time) + 0.3 * np.sin(4.1 * time)


@pytest.mark.parametrize("kind", ["backlash", "reversal_spike"])
def test_memories_go_as_the_rigs_step_by_step(kind):
    at, dt = wandering(), 0.01
    drive = np.repeat(at[:, None], 6, axis=1)
    size = {"backlash": {"width_um": 60.0}, "reversal_spike": {"breakaway_um": 60.0, "decay_s": 0.3}}[kind]
    table = MECHANISMS[kind].model_validate({"slider": 2, **size})
    push = Push(len(at))
    table.start(load_plan("standard").machine_file()).act(Motion(dt * np.arange(len(at)), dt, drive), push)
    pieces = monotone(at)
    if kind == "backlash":
        ours = lost_motion(at, 0.03, pieces)
        settled = slice(400, None)  # The rig's starts in the middle of its play.
    else:
        ours = -windup(at, dt * np.arange(len(at)), pieces, 0.06, lambda since: np.exp(-since / 0.3))
        settled = slice(None)
    np.testing.assert_allclose(ours[settled], push.slider_mm[settled, 1], atol=1e-9)


def test_reversals_are_where_the_motion_turns():
    at = wandering()
    pieces = monotone(at)
    velocity = np.gradient(at)
    for first, last, sign in zip(pieces.begin, [*pieces.begin[1:], len(at)], pieces.sign, strict=True):
        assert np.all(sign * velocity[first + 1 : last - 1] > 0.0)
    since = travel_since_reversal(at, pieces)
    assert since.min() >= 0.0
    assert since.max() == pytest.approx(np.ptp(at), rel=0.05)


def test_presliding_turns_over_within_its_stretch_and_a_lag_settles():
    at = wandering()
    pieces = monotone(at)
    force, far = presliding(at, pieces, 0.1), travel_since_reversal(at, pieces) > 1.0
    sign = np.repeat(pieces.sign, np.diff([*pieces.begin, len(at)]))
    assert np.abs(force[far] - sign[far]).max() < 1e-3
    assert np.abs(force).max() <= 1.0
    step = np.where(np.arange(1000) < 100, 0.0, 1.0)
    lagged = lowpass(step, 0.01, 0.5)
    np.testing.assert_allclose(lagged[100:], -np.expm1(-0.01 * np.arange(1, 901) / 0.5), atol=1e-9)


# --- deviation --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("kind", "half", "number"), every_form())
def test_a_form_deviates_as_stated_at_any_size(kind, half, number):
    measured = Measured(random_truth(2), plans.history(FAMILIES[kind].plan))
    scene = measured.scene(measured.history.samples)
    for deviation, factor in ((0.05, 1.0), (0.2, 3.0)):
        size = factor * FAMILIES[kind].start
        assert measured_deviation(formed(kind, half, number, deviation), scene, size) == pytest.approx(
            deviation, rel=1e-6
        )
    assert measured_deviation(formed(kind, half, number, 0.0), scene, FAMILIES[kind].start) < 1e-9


def test_deviation_of_a_lag_is_what_a_straight_line_over_velocity_leaves():
    """Measured by other means than the simulator's own."""
    measured = Measured(random_truth(2), plans.history("standard"))
    fault = formed("servo_lag", "judge", 0, 0.1)
    scene = measured.scene(measured.history.samples)
    values = fault.action().values(scene, 2.0)[:, 0]
    velocity = measured.history.velocity_mm_s[measured.history.samples, fault.elements[0]]
    left = values - np.polyval(np.polyfit(velocity, values, 1), velocity)
    assert np.std(left) / np.std(values) == pytest.approx(0.1, rel=1e-6)


def test_what_is_asked_for_some_samples_is_what_all_have():
    measured = Measured(random_truth(2), plans.history("standard"))
    some = measured.history.samples[::7]
    for kind in ("backlash", "straightness", "gravity_sag", "bar_drift"):
        action = formed(kind, "judge", 1, 0.2).action()
        size = FAMILIES[kind].start
        every = action.values(measured.scene(measured.history.samples), size)
        np.testing.assert_allclose(action.values(measured.scene(some), size), every[::7], atol=1e-12)


# --- ports ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("port", "elements", "constant", "geometry"),
    [
        ("slider", (3,), [0.02], {"slider_offset_um": [0, 0, 0, 20, 0, 0]}),
        ("leg", (4,), [0.02], {"leg_length_um": [0, 0, 0, 0, 20, 0]}),
        ("guideway", (1,), [0.02, 0.0, 0.02, 0.0], {"guideway_translation_um": [[0] * 3, [20, 0, 0], [0] * 3]}),
        ("guideway", (2,), [0.0, 0.02, 0.0, 0.02], {"guideway_translation_um": [[0] * 3, [0] * 3, [0, 0, 20]]}),
        ("cup", (), [0.01, 0.0, -0.02], {"cup_error_um": [[10, 0, -20]]}),
        ("ball", (), [0.01, 0.0, -0.02], {"ball_offset_error_um": [10, 0, -20]}),
        ("reading", (), [-0.02], {"bar_length_error_um": 20}),
    ],
)
def test_a_constant_at_a_port_is_the_error_of_geometry_that_it_is(short, port, elements, constant, geometry):
    """Move the fault: the reading changes as the true kinematics say."""
    nominal = TruthFile()
    action = Action(port, elements, lambda scene, size: np.tile(size * np.array(constant), (len(scene.rows), 1)))
    shown = Measured(nominal, short.history).readings_mm([(action, 1.0)])
    floats = {key: (np.array(value, dtype=float)).tolist() for key, value in geometry.items()}
    part = "setup" if port in ("cup", "ball", "reading") else "geometry"
    moved = TruthFile.model_validate({"schema": "hexdbb.truth/1", part: floats})
    np.testing.assert_allclose(shown, Measured(moved, short.history).readings_mm([]), atol=1e-9)
    assert np.abs(shown).max() > 1e-4


@pytest.mark.parametrize("kind", [*FAMILIES, *OUTSIDE])
def test_a_fault_moves_the_element_of_its_label_alone(kind):
    one = case(f"{kind}-d{0 if kind in OUTSIDE else 10}-x3-judge-s4")
    scene = one.measured.scene(one.history.samples[::29])
    action, _ = drawn_action(one, kind)
    values = action.values(scene, 10.0)
    assert np.all(np.isfinite(values))
    if action.port == "delay":
        return
    push = Push(len(scene.rows))
    add(action, values, scene, push)
    moved = {name for name, array in vars(push).items() if np.any(array)}
    attribute = {"guideway": "slider_joint_mm", "compliance": "compliance_mm_n"}.get(action.port, f"{action.port}_mm")
    assert moved == {attribute}
    if action.elements:
        joints = (2 * action.elements[0], 2 * action.elements[0] + 1) if action.port == "guideway" else action.elements
        array = getattr(push, attribute)
        others = [k for k in range(6) if k not in joints]
        assert not np.any(array[:, others])
        assert all(np.any(array[:, k]) for k in joints)


def drawn_action(one, kind):
    if kind in OUTSIDE:
        fault = OUTSIDE[kind].drawn(one._draw(kind))
        return fault.action, fault.equivalents
    return one._drawn(kind)[0].action(), ()


@pytest.mark.parametrize("kind", list(OUTSIDE))
def test_a_fault_outside_the_catalogue_says_where_it_is_and_what_else_explains_it(kind):
    kindred = OUTSIDE[kind]
    assert kindred.variables
    for seed in range(3):
        action, equivalents = drawn_action(case(f"{kind}-d0-x3-judge-s{seed}"), kind)
        assert action.port in PORTS
        assert all(0 <= element < 6 for element in action.elements)
        for each in equivalents:
            assert each.port in PORTS
            assert each.why
    first, again = (drawn_action(case(f"{kind}-d0-x3-judge-s1"), kind)[0] for _ in range(2))
    measured = Measured(random_truth(1), plans.history(kindred.plan))
    some = measured.scene(measured.history.samples[::11])
    np.testing.assert_array_equal(first.values(some, 10.0), again.values(some, 10.0))
    assert np.ptp(first.values(some, 10.0)) > 0.0


def test_there_are_enough_faults_outside_the_catalogue_at_many_ports():
    assert len(OUTSIDE) >= 12
    actions = [drawn_action(case(f"{kind}-d0-x3-judge-s1"), kind)[0] for kind in OUTSIDE]
    assert {action.port for action in actions} >= {"slider", "leg", "guideway", "platform_joint", "cup", "reading"}
    assert len(set(itertools.chain(*(kind.variables for kind in OUTSIDE.values())))) >= 8


# --- fit and sizes ----------------------------------------------------------------------------------------------------


def test_the_fit_finds_a_machine_without_faults():
    measured = Measured(random_truth(8), plans.history("varied"))
    rows = measured.history.samples[::7]
    readings = measured.readings_mm([], rows)
    assert fitted(readings, rows, measured.history, 0.5e-3).rms_mm < 2e-6, "priors draw a little"
    own = true_values(measured.truth, 3)
    np.testing.assert_allclose(geometry_readings_mm(own, rows, measured.history), readings, atol=1e-9)


def test_slopes_of_the_fit_are_differences_of_its_readings():
    measured = Measured(random_truth(8), plans.history("two_mounts"))
    rows = measured.history.samples[::97]
    begin = true_values(measured.truth, 2)
    fit = fitted(measured.readings_mm([], rows), rows, measured.history, 0.5e-3, begin)
    for j, step in enumerate(1e-5 * np.eye(len(fit.value))):
        after, before = (geometry_readings_mm(fit.value + sign * step, rows, measured.history) for sign in (1.0, -1.0))
        np.testing.assert_allclose(
            fit.slopes[:, j], (after - before) / 2e-5, atol=2e-5 * max(1.0, fit.slopes[:, j].max())
        )


@pytest.mark.parametrize(
    "name",
    [
        "backlash-d10-x100-judge-s2",
        "dent-d0-x30-judge-s2",
    ],
)
def test_a_case_leaves_as_much_as_its_name_says(name):
    one = case(name)
    fit = remaining([(each.action, each.size) for each in one.hidden], one.measured, thinned=3)
    assert fit.rms_mm == pytest.approx(one.times_noise * 0.5e-3, rel=0.06)


@pytest.mark.parametrize("name", ["servo_lag-d10-x10-judge-s1", "bar_whirls-d0-x10-judge-s1"])
def test_diagnosis_leaves_what_the_case_says(name):
    """The estimator's own fit, on the record with noise."""
    one = case(name)
    record = one.record()
    found = diagnose(Samples.of([record]), new_model(record.machine))
    excess_um = np.sqrt(found.rms_after_um**2 - one.truth.gauge.noise_um**2)
    assert excess_um == pytest.approx(one.times_noise * 0.5, rel=0.06)


def test_what_no_machine_has_is_not_made():
    one = case("straightness-d0-x100-judge-s1")
    with pytest.raises(UnreachableSizeError, match="100 x noise is beyond 4000"):
        one.record()
    assert list(reachable([one])) == []


def test_more_shows_of_a_form_where_geometry_absorbs_its_formula():
    (lead,) = case("lead_error-d10-x10-judge-s1").shown_deviation()
    assert lead is not None and lead > 0.15


# --- cases ------------------------------------------------------------------------------------------------------------


def test_names_tell_cases():
    some = [
        *itertools.islice(alone("judge"), 300),
        *itertools.islice(outside("calibrate"), 200),
        *combined("judge"),
        *combined("judge", 3, count=5),
        *clean("calibrate"),
    ]
    for each in some:
        assert case(each.name) == each
    assert {len(each.kinds) for each in some} == {0, 1, 2, 3}


@pytest.mark.parametrize(
    "name",
    [
        "backlash",
        "backlash-d10-x3-s1",
        "gremlin-d10-x3-judge-s1",
        "backlash-d10-x3-train-s1",
        "none-judge-s1@nowhere",
        "none-d10-x3-judge-s1",
    ],
)
def test_a_name_that_tells_no_case_is_refused(name):
    with pytest.raises(InputError, match=r"^case "):
        case(name)


def test_a_case_is_its_name_and_the_halves_are_other_machines():
    one, again = case("pitch_cyclic-d10-x3-judge-s3"), case("pitch_cyclic-d10-x3-judge-s3")
    np.testing.assert_array_equal(one.record().columns["reading_um"], again.record().columns["reading_um"])
    other = case("pitch_cyclic-d10-x3-calibrate-s3")
    assert other.truth != one.truth
    assert other.hidden[0].form in {"pitch_third", "pitch_fading"}
    assert one.hidden[0].form in {"pitch_wandering", "pitch_sharp"}
    assert one.deviations()[0] == pytest.approx(0.1, rel=1e-6)
    assert case("pitch_cyclic+bar_drift-d10-x3-judge-s3").catalogued
    assert not case("pitch_cyclic+dent-d10-x3-judge-s3").catalogued


def test_a_record_has_noise_rounding_and_a_thermometer_in_every_second_seed():
    one = case("leg_thermal-d5-x3-judge-s1")
    record, clean_um = one.record(), 1e3 * one.readings_mm()
    assert 9000 < len(record) < 11000
    reading = record.columns["reading_um"]
    assert np.std(reading - clean_um) == pytest.approx(0.5, rel=0.03)
    np.testing.assert_allclose(reading / 0.1, np.round(reading / 0.1), atol=1e-6)
    np.testing.assert_allclose(record.sliders_mm * 1e4, np.round(record.sliders_mm * 1e4), atol=1e-6)
    assert record.columns["temperature_c"].max() > 20.5
    assert "temperature_c" not in case("none-judge-s2").record().columns
    assert {"sweep", "lap", "direction", "feed_mm_min"} <= set(record.columns)


def test_every_plan_is_driven_with_as_many_readings(tmp_path):
    for name in plans.PLANS:
        one = case(f"none-judge-s4@{name}")
        record = one.record()
        assert 9000 < len(record) < 11000
        low, high = record.machine.sliders.travel_mm
        assert low < record.sliders_mm.min() < record.sliders_mm.max() < high
        gaps = record.sliders_mm[:, 1::2] - record.sliders_mm[:, ::2]
        assert gaps.min() > record.machine.sliders.min_gap_mm
    written = one.write(tmp_path)
    np.testing.assert_array_equal(read_record(written).columns["reading_um"], record.columns["reading_um"])
