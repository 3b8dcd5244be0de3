"""The table of samples: one vocabulary of columns, views of it, one evaluation for all that is asked of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.python.samples.test_state import COUNT, MACHINE, record_of

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.kinematics import engine_machine
from hexdbb.model import Model, new_model
from hexdbb.record import Record
from hexdbb.samples import PUSH_SHAPES, Samples, linearise, normal_equations, port_sensitivity, predict

OWN_COLUMNS = {"record", "set_up", "sliders_mm", "reading_mm", "mount"}


@pytest.fixture(scope="module")
def records() -> tuple[Record, Record]:
    return record_of(3), record_of(2, start_s=7.0)


@pytest.fixture(scope="module")
def samples(records: tuple[Record, Record]) -> Samples:
    return Samples.of(records)


@pytest.fixture(scope="module")
def model(samples: Samples) -> Model:
    wrong = new_model(MACHINE, ["leg_length", "backlash", "cup_position"]).with_mounts(samples.mounts)
    return wrong.with_values(0.1 * wrong.prior_sigma * np.random.default_rng(4).normal(size=len(wrong.values)))


def test_the_columns_are_those_of_the_engine_and_their_own(samples: Samples) -> None:
    made = _core.Samples(
        sliders_mm=samples["sliders_mm"],
        set_up=samples["set_up"],
        mount=samples["mount"],
        set_ups=list(samples.set_ups),
        state={name: samples[name] for name in ("time_s", "sweep", "direction", "angle_rad")},
    )
    made.derive(engine_machine(MACHINE))
    derived = set(made.state)
    assert derived < set(samples.column_names)
    assert set(samples.column_names) >= OWN_COLUMNS
    for name in derived:
        np.testing.assert_array_equal(samples[name], made.state[name], err_msg=name)


def test_set_ups_records_and_mounts_number_the_rows(samples: Samples, records: tuple[Record, Record]) -> None:
    first, second = records
    assert len(samples) == len(first) + len(second)
    np.testing.assert_array_equal(samples["record"], np.repeat([0, 1], [len(first), len(second)]))
    assert len(samples.set_ups) == 3 + 2
    for row in (0, len(first) - 1, len(first), len(samples) - 1):
        record = records[samples["record"][row]]
        circle = record.circle(int(samples["circle"][row]))
        np.testing.assert_array_equal(samples.set_ups[samples["set_up"][row]].ball_offset_mm, circle.ball_offset_mm)
        key = samples.mounts[samples["mount"][row]]
        assert (key.record_hash, key.mount_id) == (record.content_hash(), circle.mount)


def test_a_column_that_is_not_there_is_named_with_those_that_are(samples: Samples) -> None:
    with pytest.raises(KeyError, match=r"no column 'speed' \(expected one of record, .*velocity_mm_s"):
        samples["speed"]


def test_a_part_is_a_view_of_the_whole(samples: Samples, model: Model) -> None:
    chosen = samples["circle"] == 1
    part = samples.part(chosen)
    every_third = part.part(np.arange(0, len(part), 3))
    rows = np.flatnonzero(chosen)[::3]
    np.testing.assert_array_equal(every_third.row_numbers, rows)
    for name in samples.column_names:
        np.testing.assert_array_equal(every_third[name], samples[name][rows], err_msg=name)
    np.testing.assert_allclose(
        predict(every_third, model).reading_mm, predict(samples, model).reading_mm[rows], rtol=0, atol=1e-12
    )
    np.testing.assert_allclose(every_third.position_mm, samples.position_mm[rows])


def test_every_record_has_its_rows(samples: Samples, records: tuple[Record, Record]) -> None:
    for (record, part), expected in zip(samples.of_each_record(), records, strict=True):
        assert record is expected
        np.testing.assert_array_equal(part["sliders_mm"], expected.sliders_mm)
        assert [len(rows) for rows in part.sweeps()] == [len(rows) for rows in expected.sweeps()]


def test_mounts_are_numbered_as_the_model_numbers_them(samples: Samples, model: Model) -> None:
    turned = replace(model, mounts=model.mounts[::-1])
    cups = np.split(model.values[-3 * len(model.mounts) :], len(model.mounts))
    values = np.concatenate([model.values[: -3 * len(model.mounts)], *cups[::-1]])
    expected = predict(samples, model).reading_mm
    np.testing.assert_allclose(predict(samples, turned.with_values(values)).reading_mm, expected, rtol=0, atol=1e-12)
    assert np.abs(predict(samples, turned).reading_mm - expected).max() > 1e-4


def test_a_mount_the_model_does_not_know_is_refused_where_it_counts(
    samples: Samples, records: tuple[Record, Record]
) -> None:
    first = new_model(MACHINE).with_mounts(samples.mounts[:1])
    known = samples.part(samples["mount"] == 0)
    assert len(predict(known, first).reading_mm) == len(known)
    with pytest.raises(InputError, match=r"record: mount 0: not known to the model"):
        predict(samples, first)


def test_no_record_and_two_machines_are_refused(records: tuple[Record, Record]) -> None:
    with pytest.raises(InputError, match="no record"):
        Samples.of([])
    longer = MACHINE.model_copy(update={"legs": MACHINE.legs.model_copy(update={"length_mm": 401.0})})
    with pytest.raises(InputError, match=r"legs.length_mm: 40[01] .*they do not belong together"):
        Samples.of([records[0], replace(records[1], machine=longer)])


def test_a_sample_out_of_reach_is_named_by_record_and_row(records: tuple[Record, Record]) -> None:
    second = records[1]
    columns = {**second.columns, "s1_mm": second.columns["s1_mm"].copy()}
    columns["s1_mm"][7] += 600.0
    samples = Samples.of([records[0], replace(second, columns=columns, path=None)])
    for some in (samples, samples.part(samples["record"] == 1)):
        with pytest.raises(InputError, match=r"^record: row 8: the sliders' place has no pose"):
            predict(some, new_model(MACHINE, []))


def test_derivatives_are_those_of_differences(samples: Samples, model: Model) -> None:
    few = samples.part(np.arange(0, len(samples), 11))
    found = linearise(few, model)
    np.testing.assert_array_equal(found.reading_mm, predict(few, model).reading_mm)
    np.testing.assert_allclose(found.residual_mm, few.reading_mm - found.reading_mm)
    step = 1e-4
    for index in (0, 7, len(model.values) - 1):
        moved = [model.values + sign * step * np.eye(len(model.values))[index] for sign in (1.0, -1.0)]
        above, below = (predict(few, model.with_values(values)).reading_mm for values in moved)
        np.testing.assert_allclose(found.jacobian[:, index], (above - below) / (2.0 * step), atol=1e-6)
    equations = normal_equations(few, model)
    np.testing.assert_allclose(equations.information, found.jacobian.T @ found.jacobian, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(equations.gradient, found.jacobian.T @ found.residual_mm, rtol=1e-9, atol=1e-9)


def test_ports_have_the_shapes_they_state_and_a_leg_answers_as_its_length(samples: Samples, model: Model) -> None:
    ports = port_sensitivity(samples, model)
    assert {name: column.shape[1:] for name, column in ports.items()} == PUSH_SHAPES
    assert sum(int(np.prod(shape, dtype=int)) for shape in PUSH_SHAPES.values()) == sum(
        width for _, width in _core.PORTS.values()
    )
    np.testing.assert_allclose(ports["leg"], linearise(samples, model).jacobian[:, :6], atol=1e-12)


def test_a_frame_has_a_row_for_each_sample_and_numbered_columns(samples: Samples) -> None:
    frame = samples.part(samples["circle"] == 1).to_frame()
    assert len(frame) == int((samples["circle"] == 1).sum())
    np.testing.assert_array_equal(frame["velocity_mm_s_4"], samples["velocity_mm_s"][samples["circle"] == 1, 3])
    assert set(frame["record"]) == {"record"}
    assert "velocity_mm_s" not in frame.columns


def test_samples_and_models_show_themselves(samples: Samples, model: Model) -> None:
    assert repr(samples).startswith(f"<Samples: {len(samples)} samples of record, record, 5 set-ups, 10 sweeps")
    assert f"<Samples: {COUNT} of {len(samples)} samples" in repr(samples.part(np.arange(COUNT)))
    assert samples._repr_html_().count("<tr>") == 1 + 5
    assert repr(model).startswith(f"<Model of {MACHINE.name}: {len(model.values)} values ")
    assert model._repr_html_().count("<tr>") == 1 + len(model.values)


def test_planned_samples_are_those_of_a_nominal_record() -> None:
    from hexdbb.plan import load_plan

    plan = load_plan("standard")
    runs = [run for run in plan.runs() if run.circle.id < 2 and run.feed_mm_min < 1000.0]
    angle = np.linspace(0.0, 2.0 * np.pi, COUNT, endpoint=False)
    planned, recorded = Samples.planned(MACHINE, runs, angle, plan.gauge.bar_length_mm), Samples.of([record_of(2)])
    assert np.isnan(planned.reading_mm).all()
    nominal = new_model(MACHINE, [])
    np.testing.assert_array_equal(predict(planned, nominal).reading_mm, predict(recorded, nominal).reading_mm)
    for name in ("angle_rad", "velocity_mm_s", "since_reversal_mm", "leg_force", "nominal_reading_mm"):
        np.testing.assert_allclose(planned[name], recorded[name], atol=1e-9, err_msg=name)
