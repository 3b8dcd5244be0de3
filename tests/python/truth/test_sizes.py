"""Truth with forms: what geometry leaves of a fault is as large as its case says."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.diagnosis import diagnose
from hexdbb.model import new_model
from hexdbb.rig.truth import random_truth
from hexdbb.samples import Samples
from hexdbb_truth.forms import plans
from hexdbb_truth.forms.cases import (
    case,
)
from hexdbb_truth.forms.fit import fitted, geometry_readings_mm, true_values
from hexdbb_truth.forms.lists import reachable
from hexdbb_truth.forms.measure import Measured
from hexdbb_truth.forms.sizes import UnreachableSizeError, remaining


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
