"""Truth with forms: the catalogue's formulas, their memories, their deviation."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.plan import load_plan
from hexdbb.rig.mechanisms import MECHANISMS, Motion, Push
from hexdbb.rig.truth import random_truth
from hexdbb_truth.forms import plans
from hexdbb_truth.forms.cases import (
    CATALOGUED,
    FAMILIES,
    HALVES,
)
from hexdbb_truth.forms.deviation import Formed, measured_deviation
from hexdbb_truth.forms.history import monotone
from hexdbb_truth.forms.labels import VARIABLES
from hexdbb_truth.forms.measure import Measured
from hexdbb_truth.forms.operators import (
    lost_motion,
    lowpass,
    presliding,
    pushed_ahead,
    relay,
    travel_since_reversal,
    windup,
)
from hexdbb_truth.simulate import true_readings_mm


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


def test_every_effect_of_the_catalogue_has_forms_and_the_halves_share_none():
    assert set(CATALOGUED) == set(_core.effect_names("catalogue"))
    assert set(FAMILIES) == set(VARIABLES)
    for kind, family in FAMILIES.items():
        assert family.calibrate, kind
        assert family.judge, kind
        assert not set(family.calibrate) & set(family.judge), kind


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


def test_a_relay_keeps_its_state_between_its_thresholds():
    values = np.array([0.5, 0.9, 1.1, 0.5, 0.1, -0.1, 0.5, 0.9, 1.2])
    np.testing.assert_array_equal(relay(values, 0.0, 1.0), [0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0])
    at, high = wandering(), 1.0
    state = False
    for value, ours in zip(at, relay(at, -1.0, high), strict=True):
        state = value > high or (state and value >= -1.0)
        assert ours == float(state)


def test_what_is_pushed_ahead_flows_back_where_nothing_pushes():
    at, time = wandering(), 0.01 * np.arange(3000)
    front, expected = pushed_ahead(at, time, 0.05, 2.0), 2.0 + 0.05 * 0.01
    for value, ours in zip(at, front, strict=True):
        expected = max(value, expected - 0.05 * 0.01)
        assert ours == pytest.approx(expected, abs=1e-9)


def test_loads_of_all_instants_go_evenly_through_travels(short):
    history = short.history
    runs, travel = np.flatnonzero(history.run >= 0), np.flatnonzero(history.run < 0)
    some = runs[::97]
    np.testing.assert_allclose(history.thrust_n[some], history.leg_force_n(some), rtol=1e-12)
    first = travel[: np.flatnonzero(np.diff(travel) > 1)[0] + 1] if np.any(np.diff(travel) > 1) else travel
    ends = history.thrust_n[[first[0] - 1, first[-1] + 1]]
    assert np.all(history.thrust_n[first] >= ends.min(axis=0) - 1e-9)
    assert np.all(history.thrust_n[first] <= ends.max(axis=0) + 1e-9)
    # A pair's sliders are pushed apart: their legs lean towards each other.
    assert np.all(history.push_n[some, 0] < history.push_n[some, 1])


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
