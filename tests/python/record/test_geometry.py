"""Circles that fit neither bar nor machine are refused wherever a record is read or written."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from hexdbb.cli import diagnose
from hexdbb.errors import InputError
from hexdbb.record import Record, read_record, write_record


def with_circle(record: Record, **changed: object) -> Record:
    return replace(record, circles=tuple(circle.model_copy(update=changed) for circle in record.circles))


@pytest.mark.parametrize("radius_mm", [0.5, 93.9, 106.1, 1e18])
def test_a_radius_that_does_not_fit_the_bar_is_refused_on_writing(record: Record, radius_mm: float) -> None:
    with pytest.raises(
        InputError, match=r"^record: circle 0: radius_mm: \S+ \(expected (the bar's length, 100|at most)"
    ):
        write_record(with_circle(record, radius_mm=radius_mm), "never.parquet")


@pytest.mark.parametrize("radius_mm", [94.1, 100.4, 105.9])
def test_a_radius_within_the_gauge_and_the_machine_is_taken(record: Record, tmp_path: Path, radius_mm: float) -> None:
    write_record(with_circle(record, radius_mm=radius_mm), tmp_path / "a.csv")
    assert read_record(tmp_path / "a.csv").circles[0].radius_mm == radius_mm


@pytest.mark.parametrize(
    ("line", "wrong", "message"),
    [
        (
            "radius_mm = 100.0",
            "radius_mm = 0.5",
            "circle 0: radius_mm: 0.5 (expected the bar's length, 100, within",
        ),
        ("radius_mm = 100.0", "radius_mm = 1e18", "circle 0: radius_mm: 1e+18 (expected at most "),
        ("range_um = 1000.0", "range_um = 1e9", "circle 0: range_um of the gauge: 1e+09 (expected less than the bar's"),
        ("bar_length_mm = 100.0", "bar_length_mm = 0.1", "circle 0: range_um of the gauge: 1000 (expected less than"),
        (
            "bar_length_mm = 100.0",
            "bar_length_mm = 150.0",
            "radius_mm: 100 (expected the bar's length, 150, within",
        ),
        ("ball_offset_mm = [0.0, 0.0, 60.0]", "ball_offset_mm = [0, 0, 1e9]", "circle 0: ball_offset_mm: "),
        ("cup_mm = [0.0, 0.0, 340.0]", "cup_mm = [0, 1e12, 0]", "circle 0: cup_mm of mount 0: "),
    ],
)
def test_diagnose_refuses_it_with_circle_value_and_expectation(
    record: Record, tmp_path: Path, line: str, wrong: str, message: str
) -> None:
    write_record(record, tmp_path / "a.csv")
    toml = (tmp_path / "a.toml").read_text()
    assert line in toml
    (tmp_path / "a.toml").write_text(toml.replace(line, wrong))
    done = CliRunner().invoke(diagnose.command, [str(tmp_path / "a.csv"), "-m", str(tmp_path / "model.toml")])
    assert isinstance(done.exception, InputError)
    assert str(done.exception).startswith(f"{tmp_path / 'a.csv'}: ")
    assert message in str(done.exception)
    assert "\n" not in str(done.exception)
    assert not (tmp_path / "model.toml").exists()
