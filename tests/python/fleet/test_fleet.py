"""A fleet judged and reported on: what was hidden is found, what cannot be judged says why, others read the rows."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import duckdb
import jsonschema
import pandas as pd
import pytest
from tests.fleet.made import GROWING_MACHINE, GROWTH_UM_YEAR, STEADY_UM, WEAK_BATCH, WEAK_SLIDER, WEAK_UM, machine_file
from tests.programs import called

from hexdbb.cli.schemas import json_schema
from hexdbb.files.validation import dump_toml
from hexdbb.fleet.columns import fleet_results, machine_key

from .conftest import COPY, CUT, FLEET, NO_MACHINE, SAME, Judged


def test_every_record_is_a_row_for_each_value_or_for_its_reason(judged: Judged) -> None:
    assert judged.run.returncode == 0, judged.run.stderr
    assert "2 workers on this computer, at most " in judged.run.stderr
    assert (
        f"{judged.records / COPY}: a copy of {judged.records / 'm003/00000.parquet'}: judged once" in judged.run.stderr
    )
    frame = fleet_results(str(judged.results)).table().to_pandas()
    reasons = frame[frame["error"].notna()].set_index("source")["error"]
    assert set(reasons.index) == {str(judged.records / CUT), str(judged.records / NO_MACHINE)}
    assert "not a whole Parquet file" in reasons[str(judged.records / CUT)]
    assert "loose.machine.toml" in reasons[str(judged.records / NO_MACHINE)]
    good = frame[frame["error"].isna()]
    assert good["source"].nunique() == FLEET.records + 1  # the same readings in another form
    assert set(good.groupby("source").size()) == {39}
    play = good[(good["effect"] == "backlash") & (good["element"] == str(WEAK_SLIDER))]
    for batch, expected in ((WEAK_BATCH, WEAK_UM), ("A", STEADY_UM), ("C", STEADY_UM)):
        own = play[play["batch"] == batch]
        assert ((own["value"] - expected).abs() < 5 * own["sigma"]).all()


def test_pandas_and_duckdb_read_the_rows_as_they_are(judged: Judged) -> None:
    ours = fleet_results(str(judged.results)).table()
    frame = pd.read_parquet(judged.results)
    assert len(frame) == ours.num_rows
    asked = duckdb.sql(
        f"SELECT machine, month, count(*) AS values, max(bidirectional_circular_deviation_um) AS worst"
        f" FROM read_parquet('{judged.results}/**/*.parquet', hive_partitioning = true)"
        " WHERE error IS NULL GROUP BY machine, month"
    ).fetchall()
    assert sum(row[2] for row in asked) == len(frame[frame["error"].isna()])
    assert {(row[0], row[1]) for row in asked} == {
        (str(machine), str(month)) for machine, month in zip(frame["machine"], frame["month"], strict=True)
    } - {("unknown", "unknown")}


def test_the_report_finds_what_was_hidden(judged: Judged, tmp_path: Path) -> None:
    page = tmp_path / "fleet.html"
    run = called("hexdbb", "fleet", "report", judged.results, "-o", page, "--json")
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    jsonschema.validate(found, json_schema("fleet"))
    assert found["records"] == FLEET.records
    assert [each["records"] for each in found["machines"]] == [6] * 9
    growing = found["growing"][0]
    assert (growing["machine"][-3:], growing["effect"], growing["element"]) == (
        f"{GROWING_MACHINE:03d}",
        "backlash",
        "5",
    )
    assert growing["low"] < GROWTH_UM_YEAR < growing["high"]
    shared = found["shared_values"][0]
    assert (shared["kind"], shared["group"]) == ("batch", WEAK_BATCH)
    assert (shared["effect"], shared["element"]) == ("backlash", str(WEAK_SLIDER))
    assert shared["low"] < WEAK_UM - STEADY_UM < shared["high"]
    assert {Path(each["source"]).name for each in found["not_judged"]} == {Path(CUT).name, Path(NO_MACHINE).name}
    assert [(each["source"], each["of"]) for each in found["copies"]] == [
        (str(judged.records / SAME), str(judged.records / "m004/00003.parquet"))
    ]
    html = page.read_text()
    assert "<svg" in html
    assert "batch B" in html
    assert str(judged.records / CUT) in html
    text = called("hexdbb", "fleet", "report", judged.results)
    assert text.stdout.startswith("54 records of 9 machines, 2 could not be judged; worst SP-120-")


def test_run_again_judges_what_is_new_alone(judged: Judged) -> None:
    again = called("hexdbb", "fleet", "diagnose", judged.records, "-o", judged.results, "-m", judged.model)
    assert again.stdout.strip().endswith("57 of 57 were done before: nothing to do")
    other = called(
        "hexdbb", "fleet", "diagnose", judged.records / "m000/*0.parquet", "-o", judged.results, "--workers", 1
    )
    assert "1 done in " in other.stdout  # another model is another result


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("diagnose", "nothing", "-o", "out"), "nothing: no record there (expected files .parquet, .csv, .xlsx"),
        (("diagnose", "gopher://a/b", "-o", "out"), "gopher://a/b: Protocol not known: gopher"),
        (("report", "nothing"), "nothing: no results (expected a folder of hexdbb.fleet.rows/1)"),
        (("report", "nothing", "-o", "page.txt"), "-o page.txt: suffix '.txt' (expected .html)"),
        (("diagnose", ".", "-o", "out", "-m", "none.toml"), "none.toml: no such file (expected a model file or"),
    ],
)
def test_bad_input_is_one_line(words: tuple[str, ...], said: str, tmp_path: Path) -> None:
    run = called("hexdbb", "fleet", *words, folder=tmp_path)
    assert run.returncode == 2
    assert run.stderr.startswith(f"error: {said}")
    assert len(run.stderr.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "serial", "key"),
    [
        ("SP-120 (assumed dimensions)", None, "SP-120-assumed-dimensions"),
        ("SP-120 (assumed)", "a/7", "SP-120-assumed-a-7"),
        ("120", "17", "machine-120-17"),
        ("Größe", None, "Gr-e"),
        ("µ", None, "unknown"),
    ],
)
def test_machines_are_folders_that_every_store_takes(name: str, serial: str | None, key: str) -> None:
    assert machine_key(name, serial) == key


def test_discoveries_are_rows_of_causes(judged: Judged, tmp_path: Path) -> None:
    (tmp_path / "machine.toml").write_text(dump_toml(machine_file()))
    weak, steady = judged.records / "m001/00000.parquet", judged.records / "m000/00000.parquet"
    words = ("fleet", "discover", weak, steady, "-o", tmp_path / "results", "-m", tmp_path / "machine.toml")
    run = called("hexdbb", *words, "--workers", 2)
    assert run.returncode == 0, run.stderr
    frame = fleet_results(str(tmp_path / "results")).table().to_pandas()
    assert set(frame["command"]) == {"discover"}
    found = frame[frame["source"] == str(weak)].iloc[0]
    assert (found["effect"], found["element"]) == ("backlash", str(WEAK_SLIDER))
    assert frame["error"].isna().all()
    assert abs(found["value"] - WEAK_UM) < 1.0
    report = json.loads(called("hexdbb", "fleet", "report", tmp_path / "results", "--json").stdout)
    assert {each["effect"] for each in report["causes"]} == set(frame["effect"].dropna())


def test_a_missing_extra_is_one_line(judged: Judged, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("fsspec", "distributed"):
        monkeypatch.setitem(sys.modules, module, None)
        run = called("hexdbb", "fleet", "diagnose", judged.records, "-o", judged.folder / "other")
        assert run.returncode == 2
        assert run.stderr.splitlines()[-1] == (
            f"error: {module} is not installed (expected: pip install 'hexdbb[cluster]')"
        )
        monkeypatch.undo()
