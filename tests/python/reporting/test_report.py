"""What a report says, and what it refuses."""

from __future__ import annotations

import csv
import io
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from tests.python.reporting.conftest import HOSTILE

import hexdbb as hx
from hexdbb.charts.colours import STYLE, resolved
from hexdbb.cli import cli
from hexdbb.errors import InputError
from hexdbb.machine import Tolerance
from hexdbb.model import Model, save_model
from hexdbb.record import Record, write_record
from hexdbb.reporting import Report, make_report, page_html, parse_tolerance
from hexdbb.samples import Samples

ORDER = ("conditions", "tolerance", "fall", "contributions", "circles", "predictors", "values", "open", "next")


def sections(page: str) -> list[str]:
    return re.findall(r'<section id="([a-z]+)"', page)


def test_the_parts_stand_in_the_order_of_a_reader(page_file: Path) -> None:
    page = page_file.read_text(encoding="utf-8")
    assert page.index('class="verdict') < page.index("<section")
    assert sections(page) == [*ORDER, "numbers"]


def test_the_page_fetches_nothing(page_file: Path) -> None:
    page = page_file.read_text(encoding="utf-8")
    assert not re.search(r'(?:src|href)="(?!#)', page)
    assert "default-src 'none'" in page
    assert "url(" not in page
    assert "@import" not in page


def test_names_are_escaped_everywhere(page_file: Path) -> None:
    page = page_file.read_text(encoding="utf-8")
    assert "<img" not in page
    assert "<b>" not in page
    assert page.count("&lt;img") > 4
    assert "today&lt;b&gt;.parquet" in page


def test_the_verdict_says_what_counts(report: Report, record: Record, without: Model) -> None:
    assert report.verdict.startswith("Fails its tolerance: F ")
    assert "leg_length alone would make" in report.verdict
    assert "nothing that matters is missing" in report.verdict
    lacking = make_report(Samples.of([record]), without, tolerance=Tolerance(radial_deviation_um=500.0))
    assert lacking.verdict.startswith("Passes its tolerances: F ")
    assert "slider 4 has" in lacking.verdict
    assert "hexdbb discover" in lacking.next_steps[0].command
    assert "backlash:4" in lacking.next_steps[1].command


def test_numbers_are_those_of_the_readings(page_file: Path, record: Record, report: Report) -> None:
    page = page_file.read_text(encoding="utf-8")
    (text,) = re.findall(r'<script type="text/csv" id="csv-0">(.*?)</script>', page, flags=re.DOTALL)
    rows = list(csv.DictReader(io.StringIO(text.strip())))
    assert len(rows) == len(record)
    assert [float(each["measured_um"]) for each in rows] == pytest.approx(record.columns["reading_um"], abs=1e-3)
    left = [float(each["residual_um"]) for each in rows]
    assert left == pytest.approx(1e3 * report.comparison.residual_mm, abs=1e-3)
    assert {int(each["circle"]) for each in rows} == set(np.unique(record.columns["circle"]))


def test_35000_readings_make_a_page_of_less_than_5_mb(page_file: Path, record: Record) -> None:
    """Charts are screened, so that only the numbers grow: 14 circles and feeds of the standard plan, 35,000 rows."""
    page = page_file.read_text(encoding="utf-8")
    (text,) = re.findall(r'<script type="text/csv" id="csv-0">(.*?)</script>', page, flags=re.DOTALL)
    numbers, rest = len(text.encode()), len(page.encode()) - len(text.encode())
    assert rest < 2_000_000
    assert 35_000 * numbers / len(record) + rest * 14 / 8 < 5_000_000


def test_two_records_are_compared(record: Record, model: Model) -> None:
    later = replace(
        record,
        columns={**record.columns, "reading_um": 0.5 * record.columns["reading_um"]},
        metadata={"compensation": {"file": HOSTILE}},
        path=Path("after.parquet"),
    )
    found = make_report(Samples.of([record, later]), model, find_cause=False)
    page = page_html(found)
    assert sections(page)[2] == "change"
    assert re.search(r"radial error [\d.]+ µm -> [\d.]+ µm RMS", found.verdict)
    assert "<img" not in page
    assert len(found.judged) == 2
    assert page.count("Not ranked:") == 1


def test_one_direction_of_one_lap_asks_for_more(record: Record, model: Model) -> None:
    one = record.part((record.columns["direction"] == 1) & (record.columns["feed_mm_min"] < 1000.0))
    said = " ".join(each.sentence for each in make_report(Samples.of([one]), model, find_cause=False).next_steps)
    for wanted in ("both directions", "two feeds", "two laps", "plan standard"):
        assert wanted in said


def test_an_arc_and_a_model_without_values(record: Record) -> None:
    arc = record.part(np.abs(record.columns["angle_deg"] % 360.0 - 90.0) < 60.0)
    found = make_report(Samples.of([arc]), hx.new_model(record.machine, []), find_cause=False)
    assert found.judged[0].word == "not evaluated"
    assert "no full circle" in page_html(found)
    found.to_json()


@pytest.mark.parametrize("text", ["G", "G=", "G=-1", "H=3", "G=3,G=4", "F=nan", "G=inf"])
def test_a_tolerance_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="expected G=UM"):
        parse_tolerance([text])


def test_tolerances_of_all_quantities() -> None:
    assert parse_tolerance([]) is None
    assert parse_tolerance(["G=20, g(B)=25", "F=30"]) == Tolerance(
        circular_deviation_um=20.0, bidirectional_circular_deviation_um=25.0, radial_deviation_um=30.0
    )


def test_the_command_writes_refuses_and_replaces(record: Record, model: Model, tmp_path: Path) -> None:
    write_record(replace(record, path=None), tmp_path / "today.parquet")
    save_model(model, tmp_path / "model.toml")
    line = ["report", str(tmp_path / "today.parquet"), "-m", str(tmp_path / "model.toml"), "--no-cause"]
    done = CliRunner().invoke(cli, line, catch_exceptions=False)
    assert done.exit_code == 0
    assert done.stdout.startswith("Fails its tolerance")
    assert "<!doctype html>" in (tmp_path / "today-report.html").read_text(encoding="utf-8")
    for words, said in (
        ([], "exists already"),
        (["-o", "report.txt"], "expected .html"),
        (["-o", str(tmp_path / "new.html"), "--pdf", "x.ps"], "expected .pdf"),
        (["--overwrite", "--tolerance", "D=4"], "expected G=UM"),
    ):
        with pytest.raises(InputError, match=said):
            CliRunner().invoke(cli, [*line, *words], catch_exceptions=False)


def test_colours_of_page_and_pictures_are_one() -> None:
    assert resolved("a{color:var(--measured-ccw)}") == f"a{{color:{STYLE['measured-ccw']}}}"
    assert "var(" not in resolved(" ".join(f"var(--{name})" for name in STYLE))
