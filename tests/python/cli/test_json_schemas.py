"""What commands print with --json is what the published schemas say, with no key left out and none unnamed."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from click.testing import CliRunner

from hexdbb.cli import cli
from hexdbb.cli.schemas import COMMANDS, DECLARED, json_schema, schema_text
from hexdbb.diagnosis import diagnose
from hexdbb.errors import InputError
from hexdbb.machine import shipped
from hexdbb.model import new_model
from hexdbb.record import Record, write_record
from hexdbb.rig.truth import random_truth
from hexdbb.samples import Samples
from hexdbb_truth.plans import discovery_plan
from hexdbb_truth.simulate import Pace, simulate

PACE = Pace(rate_hz=1.0, instants_per_sample=1, travel_s=1.0)


def strict(schema: Any) -> Any:
    """Refuse keys that a schema does not name: a test must not overlook one."""
    if isinstance(schema, dict):
        closed = {"additionalProperties": False} if "properties" in schema else {}
        return {key: strict(value) for key, value in schema.items()} | closed
    return [strict(each) for each in schema] if isinstance(schema, list) else schema


@pytest.fixture(scope="module")
def record() -> Record:
    plan = discovery_plan()
    fewer = plan.model_copy(update={"laps": 1, "circles": plan.circles[:3], "feeds_mm_min": (3000.0,)})
    return simulate(random_truth(5), fewer, pace=PACE)


@pytest.fixture(scope="module")
def printed(record: Record, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Any]:
    """Run a command line in a folder with a record and a model, and give the JSON it prints."""
    folder = tmp_path_factory.mktemp("json")
    write_record(record, folder / "run.parquet")

    def run(line: str) -> Any:
        words = [str(folder / word) if Path(word).suffix else word for word in line.split()]
        done = CliRunner().invoke(cli, words, catch_exceptions=False)
        assert done.exit_code == 0
        return json.loads(done.stdout)

    return run


def test_every_file_is_a_schema_and_every_schema_a_command() -> None:
    files = {path.name.removesuffix(".schema.json") for path in shipped("schemas").glob("*.json")}
    assert files == set(COMMANDS)
    for command in COMMANDS:
        jsonschema.Draft202012Validator.check_schema(json_schema(command))
        assert command in cli.list_commands(None)


def test_the_files_are_those_of_the_declared_results() -> None:
    for command in DECLARED:
        written = shipped("schemas", f"{command}.schema.json").read_text(encoding="utf-8")
        assert written == schema_text(command), "write them anew: python -m hexdbb.cli.schemas"


def test_an_unknown_command_is_named() -> None:
    with pytest.raises(InputError, match=r'no JSON schema of "rig" \(expected one of diagnose'):
        json_schema("rig")


def test_what_is_printed_is_what_the_schemas_say(printed: Callable[[str], Any]) -> None:
    model = "-m model.toml"
    for command, line in (
        ("diagnose", f"diagnose run.parquet {model} --json"),
        ("compare", f"compare run.parquet {model} --json --no-plot"),
        ("add", f"add bar_length run.parquet {model} --json"),
        ("report", f"report run.parquet {model} --json -o run.html --tolerance F=20"),
        ("history", f"history {model} --json"),
        ("undo", f"undo {model} --json"),
    ):
        jsonschema.validate(printed(line), strict(json_schema(command)), jsonschema.Draft202012Validator)


def test_a_key_that_is_missing_or_unnamed_is_seen(printed: Callable[[str], Any]) -> None:
    data = printed("diagnose run.parquet -m other.toml --json")
    schema = strict(json_schema("diagnose"))
    for wrong in ({**data, "rms": 1.0}, {key: data[key] for key in data if key != "rank"}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(wrong, schema, jsonschema.Draft202012Validator)


def test_a_diagnosis_shows_itself_in_a_notebook(record: Record) -> None:
    found = diagnose(
        Samples.of([record]), new_model(record.machine, ["leg_length", "cup_position"]), check_held_out=False
    )
    frame = found.to_frame()
    assert list(frame["effect"]) == ["leg_length"] * 6 + ["cup_position"] * 3
    assert frame["value"].to_numpy() == pytest.approx(1e3 * found.model.values)
    assert np.array_equal(frame["identifiable"].to_numpy(), np.isfinite(frame["sigma"].to_numpy()))
    shown = found._repr_html_()
    assert shown.count("<tr>") == 1 + 9
    assert "reading error" in shown
    held = replace(found, model=found.model.with_free(np.zeros(9, bool)))
    assert "<td>held</td>" in held._repr_html_()


def test_without_pandas_a_frame_is_refused_in_words(record: Record, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    found = diagnose(Samples.of([record]), new_model(record.machine, ["cup_position"]), check_held_out=False)
    with pytest.raises(InputError, match="pandas is not installed"):
        found.to_frame()
    assert found.columns()["name"].tolist() == ["x", "y", "z"]
