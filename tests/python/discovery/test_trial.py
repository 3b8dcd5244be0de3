"""Candidates in a fit of their own: elements that hardly contribute go, p-values are corrected as Holm says."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from hexdbb.diagnosis import noise_of
from hexdbb.discovery import Candidate
from hexdbb.discovery.trial import fitted_base, holm, try_effect
from hexdbb.model import new_model
from hexdbb.record import Record
from hexdbb.samples import Samples


def candidate(record: Record, p_value: float) -> Candidate:
    return Candidate("backlash", ("1",), 1.0, 50.0, 40.0, p_value, 0.5, (), new_model(record.machine))


def test_holm_by_hand(record: Record) -> None:
    tried = [candidate(record, p) for p in (0.03, 0.001, 0.02, 0.9)]
    corrected = {each.p_value for each in holm(tried, 10)}
    # 0.001 * 10, 0.02 * 9, 0.03 * 8, 0.9 * 7 cut at 1
    assert sorted(corrected) == pytest.approx([0.01, 0.18, 0.24, 1.0])


def test_holm_never_turns_the_order(record: Record) -> None:
    first, second = holm([candidate(record, p) for p in (0.010, 0.011)], 2)
    assert first.p_value == pytest.approx(0.020)
    assert second.p_value == pytest.approx(0.020)  # not 0.011


def test_elements_that_hardly_contribute_are_left_out(measured: Callable[[str], Record]) -> None:
    record = measured("backlash-x3-s1")
    samples = Samples.of([record])
    base = fitted_base(samples, new_model(record.machine).with_mounts(samples.mounts), noise_of(samples))
    found, result = try_effect(base, "backlash", ("1", "4", "6"))
    assert found.elements == ("4",)
    assert [each.element for each in found.values] == ["4"]
    assert found.choice == "backlash:4"
    assert found.share > 0.95
    assert replace(found, elements=("1", "2", "3", "4", "5", "6")).choice == "backlash"
    assert found.rms_after_um == pytest.approx(1e3 * result.rms_after_mm)
