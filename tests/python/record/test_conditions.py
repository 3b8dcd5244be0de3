"""What a report says of a test: kept in every form of a record, and no part of what makes a record the same."""

from __future__ import annotations

from dataclasses import replace
from datetime import date
from pathlib import Path

import pytest

from hexdbb.errors import InputError
from hexdbb.machine import Tolerance
from hexdbb.plan import Conditions, load_plan
from hexdbb.record import Record, conditions_metadata, read_record, write_record

NASTY = 'J. "Doe" <b>&\n£'
STATED = Conditions(operator=NASTY, notes="after\nthe crash", temperature_c=21.5)


@pytest.fixture
def described(record: Record) -> Record:
    gauge = record.gauge.model_copy(update={"serial_number": "QC-17", "calibrated": date(2026, 3, 1)})
    machine = record.machine.model_copy(
        update={"serial_number": "SP-3", "tolerance": Tolerance(radial_deviation_um=9.0)}
    )
    metadata = {**record.metadata, "started": "2026-03-02", "plan": "thesis", **conditions_metadata(STATED)}
    return replace(record, gauge=gauge, machine=machine, metadata=metadata)


@pytest.mark.parametrize("suffix", [".parquet", ".csv"])
def test_all_of_it_is_read_back(described: Record, tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"today{suffix}"
    write_record(described, path, checked=True)
    found = read_record(path)
    assert found.conditions == STATED
    assert (found.metadata["started"], found.metadata["plan"]) == ("2026-03-02", "thesis")
    assert (found.gauge.serial_number, found.gauge.calibrated) == ("QC-17", date(2026, 3, 1))
    assert found.machine.serial_number == "SP-3"
    assert found.machine.tolerance == Tolerance(radial_deviation_um=9.0)


def test_a_note_leaves_a_record_the_same(described: Record, record: Record) -> None:
    assert described.content_hash() == record.content_hash()


def test_metadata_of_other_programs_are_no_conditions(record: Record) -> None:
    odd = replace(record, metadata={"conditions": {"operator": 5, "notes": "kept", "colour": "red"}})
    assert odd.conditions == Conditions(notes="kept")
    assert replace(record, metadata={"conditions": "none"}).conditions == Conditions()


def test_options_come_before_the_plan() -> None:
    stated = conditions_metadata(Conditions(operator="plan", notes="plan"), None, Conditions(operator="option"))
    assert stated == {"conditions": {"operator": "option", "notes": "plan"}}
    assert conditions_metadata(None, Conditions()) == {}


def test_a_plan_states_gauge_and_conditions(tmp_path: Path) -> None:
    text = (Path(load_plan("thesis").path or "")).read_text(encoding="utf-8")
    written = tmp_path / "plan.toml"
    written.write_text(
        text.replace("[gauge]", '[conditions]\noperator = "A. Gauge"\n\n[gauge]\ncalibrated = 2026-03-01'),
        encoding="utf-8",
    )
    plan = load_plan(written)
    assert plan.conditions == Conditions(operator="A. Gauge")
    assert plan.gauge.calibrated == date(2026, 3, 1)
    written.write_text(text.replace("[gauge]", '[gauge]\ncalibrated = "spring"'), encoding="utf-8")
    with pytest.raises(InputError, match=r"gauge\.calibrated"):
        load_plan(written)
