"""State of a record's samples: what stands in the record in the engine's units, parts of a record as of the whole."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics import inverse
from hexdbb.model import new_model
from hexdbb.plan import load_plan
from hexdbb.record import SLIDER_COLUMNS, Record
from hexdbb.samples import Samples, predict
from hexdbb.samples.state import planned_columns, state_columns

PLAN = load_plan("standard")
MACHINE = PLAN.machine_file()
COUNT = 60


def record_of(plan_circles: int, start_s: float = 100.0) -> Record:
    """Nominal laps of the plan's first circles, one sweep each direction, warming from 21 °C by 1 K a minute."""
    runs = [run for run in PLAN.runs() if run.circle.id < plan_circles and run.feed_mm_min < 1000.0]
    angle = np.linspace(0.0, 2.0 * np.pi, COUNT, endpoint=False)
    planned = planned_columns(runs, angle)
    tables = [
        inverse(MACHINE, run.circle.poses(run.direction * angle, run.mount.cup_mm), run.circle.platform_rpy_rad)[0]
        for run in runs
    ]
    columns: dict[str, NDArray[np.float64]] = {
        "t_s": planned["time_s"] + start_s,
        "circle": np.repeat([run.circle.id for run in runs], COUNT),
        "sweep": planned["sweep"],
        "direction": planned["direction"],
        "lap": planned["lap"],
        "angle_deg": np.degrees(planned["angle_rad"]),
        "feed_mm_min": planned["feed_mm_s"] * 60.0,
        "temperature_c": 21.0 + planned["time_s"] / 60.0,
        "reading_um": np.zeros(len(planned["time_s"])),
        **dict(zip(SLIDER_COLUMNS, np.vstack(tables).T, strict=True)),
    }
    return Record(columns, PLAN.gauge, PLAN.mounts, PLAN.circles, MACHINE)


def test_columns_are_in_the_engines_units() -> None:
    record = record_of(2)
    state = Samples.of([record])
    assert state["time_s"][0] == 0.0
    np.testing.assert_allclose(state["time_s"], record.columns["t_s"] - 100.0)
    np.testing.assert_allclose(state["warming_k"], state["time_s"] / 60.0, atol=1e-12)
    np.testing.assert_allclose(state["feed_mm_s"], 753.98 / 60.0)
    np.testing.assert_allclose(state["angle_rad"], np.radians(record.columns["angle_deg"]))
    speed = np.linalg.norm(np.diff(record.sliders_mm[:COUNT], axis=0), axis=1) / np.diff(state["time_s"][:COUNT])
    found = np.linalg.norm(state["velocity_mm_s"][:COUNT], axis=1)
    np.testing.assert_allclose(0.5 * (found[1:] + found[:-1]), speed, rtol=0.02)


def test_sweeps_and_circles_of_several_records() -> None:
    first, second = record_of(2), record_of(3, start_s=7.0)
    state = {name: make() for name, make in state_columns([first, second]).items()}
    sweeps = [len(record.sweeps()) for record in (first, second)]
    assert state["sweep"].max() + 1 == sum(sweeps)
    assert (np.diff(state["sweep"]) >= 0).all()
    assert state["time_s"][len(first)] == 0.0
    ids = np.concatenate([first.columns["circle"], second.columns["circle"]])
    np.testing.assert_array_equal(state["circle"], ids)


def test_part_of_a_record_has_the_state_of_the_whole() -> None:
    record = record_of(3)
    rows = record.columns["circle"] == 2
    whole, part = Samples.of([record]), Samples.of([record.part(rows)])
    for name in ("time_s", "warming_k", "since_reversal_mm", "velocity_mm_s", "leg_force", "circle"):
        np.testing.assert_allclose(part[name], whole[name][rows], rtol=0, atol=1e-9, err_msg=name)


def test_record_without_a_thermometer_has_no_temperature() -> None:
    record = record_of(1)
    without = {name: column for name, column in record.columns.items() if name != "temperature_c"}
    state = Samples.of([replace(record, columns=without, origin=None)])
    assert np.isnan(state["temperature_c"]).all() and np.isnan(state["warming_k"]).all()


def test_every_effect_of_the_catalogue_predicts_a_record() -> None:
    record = record_of(2)
    samples = Samples.of([record])
    nominal = predict(samples, new_model(MACHINE, []).with_mounts(samples.mounts)).reading_mm
    for name in _core.effect_names("catalogue"):
        model = new_model(MACHINE, [name]).with_mounts(samples.mounts)
        changed = model.with_values(model.prior_sigma)
        change = np.abs(predict(samples, changed).reading_mm - nominal).max()
        assert name == "bar_gain" or change > 1e-7, name


def test_new_model_has_geometry_and_set_up_alone() -> None:
    terms = [term.effect for term in new_model(MACHINE).terms]
    assert terms == [*_core.effect_names("geometry"), *_core.effect_names("set-up")]


def test_state_with_a_column_that_is_none() -> None:
    anywhere = _core.SetUp(cup_mm=np.zeros(3), ball_offset_mm=np.zeros(3), bar_length_mm=100.0)
    rows = np.zeros(1, np.int32)
    with pytest.raises(ValueError, match="a sample's state has no column speed"):
        _core.Samples(
            sliders_mm=np.ones((1, 6)), set_up=rows, mount=rows, set_ups=[anywhere], state={"speed": np.zeros(1)}
        )
