"""The gauge's deflection as geometry and set-up predict it: near the true one, whatever the gauge adds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from tests.python.samples.test_state import COUNT, MACHINE, record_of

from hexdbb.model import new_model
from hexdbb.plan import load_plan
from hexdbb.record import Record
from hexdbb.samples import Samples, predict


def _with_reading(record: Record, reading_mm: np.ndarray) -> Samples:
    return Samples.of([replace(record, columns={**record.columns, "reading_um": 1e3 * reading_mm})])


def _deflected_mm(record: Record) -> np.ndarray:
    """Return the readings of a machine with errors of geometry and set-up."""
    samples = Samples.of([record])
    model = new_model(MACHINE).with_mounts(samples.mounts)
    draw = np.random.default_rng(2)
    true = model.with_values(np.where(model.free, model.prior_sigma * draw.normal(size=len(model.values)), 0.0))
    return predict(samples, true).reading_mm


def test_it_is_what_the_machine_deflects_and_not_what_the_gauge_adds() -> None:
    record = record_of(7)
    deflection_mm = _deflected_mm(record)
    assert np.ptp(deflection_mm) > 0.1
    found = _with_reading(record, deflection_mm)["deflection_mm"]
    assert np.std(found - deflection_mm) < 0.02 * np.std(deflection_mm)
    hum_mm = 0.02 * np.sin(50.0 * Samples.of([record])["time_s"])
    disturbed = _with_reading(record, deflection_mm + hum_mm)["deflection_mm"]
    assert np.std(disturbed - found) < 0.3 * np.std(hum_mm)


def test_the_gauge_stands_where_it_reads() -> None:
    record = record_of(7)
    reading_mm = _deflected_mm(record)
    np.testing.assert_allclose(_with_reading(record, reading_mm)["gauge_scale_mm"], reading_mm, rtol=0.0, atol=1e-12)


def test_a_scale_that_bends_leaves_it_a_function_of_the_true_deflection() -> None:
    """A curve of the true deflection is all that a function of it needs; geometry alone is bent beside any curve."""
    record = record_of(7)
    true_mm = _deflected_mm(record)
    largest_mm = np.abs(true_mm).max()
    found_mm = _with_reading(record, true_mm - 0.15 * largest_mm * (true_mm / largest_mm) ** 3)["deflection_mm"]
    curve = np.polynomial.Legendre.fit(true_mm, found_mm, 7)
    assert np.std(found_mm - curve(true_mm)) < 1e-3 * np.std(found_mm)


def test_planned_samples_deflect_the_gauge_as_the_nominal_machine_does() -> None:
    plan = load_plan("standard")
    runs = [run for run in plan.runs() if run.circle.id < 2]
    angle = np.linspace(0.0, 2.0 * np.pi, COUNT, endpoint=False)
    planned = Samples.planned(MACHINE, runs, angle, plan.gauge.bar_length_mm)
    for name in ("deflection_mm", "gauge_scale_mm"):
        np.testing.assert_array_equal(planned[name], planned["nominal_reading_mm"])


def test_the_turning_deflection_is_it_with_the_sense_in_which_it_changes() -> None:
    record = record_of(7)
    samples = _with_reading(record, _deflected_mm(record))
    deflection_mm, turning_mm = samples["deflection_mm"], samples["deflection_turning_mm"]
    np.testing.assert_array_equal(turning_mm, samples["deflection_direction"] * deflection_mm)
    assert {*np.unique(np.sign(turning_mm * deflection_mm))} >= {-1.0, 1.0}
