"""An effect that was added, off its formula: what it leaves is its form; what is none of it is missing all the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hexdbb.discovery import Discovery, discover
from hexdbb.ledger import add_effect
from hexdbb.model import new_model
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb_truth.forms.cases import case

JITTERS = "sample_delay-d10-x10-calibrate-s1114"
"""A gauge that is read when the bus is free: later or sooner from reading to reading."""
RIPPLE_UM, RIPPLES = 1.2, 40
"""What differs from lap to lap and has nothing to do with the delay: waves finer than a contour's."""


def after_adding(record: Record, effect: str) -> Discovery:
    samples = Samples.of([record])
    model = add_effect(samples, new_model(samples.machine).with_mounts(samples.mounts), effect).model
    return discover(samples, model, candidates=("backlash",), with_tables=False)


@pytest.mark.long
def test_what_a_large_lag_leaves_is_its_form() -> None:
    found = after_adding(case("servo_lag-d10-x100-calibrate-s1165").record(), "servo_lag:6")
    assert found.verdict == "none"
    assert "the form of servo_lag:6" in found.sentence


def test_a_delay_that_jitters_changes_from_lap_to_lap_and_is_known() -> None:
    assert after_adding(case(JITTERS).record(), "sample_delay").verdict == "none"


def test_what_changes_from_lap_to_lap_at_rest_too_is_no_jitter() -> None:
    record = case(JITTERS).record()
    angle_rad, lap = np.radians(record.columns["angle_deg"]), record.columns["lap"]
    phase_rad = np.random.default_rng(4).uniform(0.0, 2.0 * np.pi, (len(record.circles), int(lap.max()) + 1))
    shifted = phase_rad[np.searchsorted(np.unique(record.columns["circle"]), record.columns["circle"]), lap]
    changed_um = record.columns["reading_um"] + RIPPLE_UM * np.sin(RIPPLES * angle_rad + shifted)
    found = after_adding(replace(record, columns={**record.columns, "reading_um": changed_um}), "sample_delay")
    assert found.verdict == "unknown"
    assert "changes from lap to lap" in found.sentence
