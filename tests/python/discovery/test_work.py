"""How much work a discovery does, counted: times depend on the machine, passes over the readings do not."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hexdbb.discovery import discover
from hexdbb.model import new_model
from hexdbb.samples import Samples, whole
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE


def test_records_are_prepared_once_for_all_fits(monkeypatch: pytest.MonkeyPatch) -> None:
    record = case("backlash-x3-s1", replace(PACE, rate_hz=0.25 * PACE.rate_hz)).record()
    derived: list[int] = []
    complete = whole.state_columns

    def counted(records):
        derived.append(len(records))
        return complete(records)

    monkeypatch.setattr(whole, "state_columns", counted)
    discover(Samples.of([record]), new_model(record.machine))
    assert derived == [1]
