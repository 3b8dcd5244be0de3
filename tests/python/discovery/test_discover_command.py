"""The command: JSON as published, --auto writes the model step by step, --effects beside the catalogue."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from click.testing import CliRunner, Result

from hexdbb.cli import cli
from hexdbb.cli.schemas import json_schema
from hexdbb.errors import InputError
from hexdbb.model import load_model, new_model, save_model
from hexdbb.record import Record, write_record

MINE = """
from hexdbb.effects import effect

@effect(port="slider", unit="mm", prior_sigma=0.01, elements=6)
def my_play(samples):
    '''Play between slider and screw.'''
    return 0.5 * samples["travel_direction"]
"""


@pytest.fixture
def folder(measured: Callable[[str], Record], tmp_path: Path) -> Path:
    """Return a folder with a record, the nominal machine's model, and an effect of the user's own."""
    record = measured("backlash-x3-s1")
    write_record(record, tmp_path / "run.parquet")
    save_model(new_model(record.machine), tmp_path / "model.toml")
    (tmp_path / "mine.py").write_text(MINE)
    return tmp_path


def run(folder: Path, line: str) -> Result:
    words = [str(folder / word) if Path(word).suffix else word for word in line.split()]
    return CliRunner().invoke(cli, words)


def refusal(done: Result) -> str:
    """Return the line a refused command would end with (`hexdbb.cli.exits`)."""
    assert isinstance(done.exception, InputError)
    return str(done.exception)


def printed(done: Result) -> Any:
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_what_is_missing_in_json_and_in_words(folder: Path) -> None:
    before = (folder / "model.toml").read_bytes()
    found = printed(run(folder, "discover run.parquet -m model.toml --json"))
    jsonschema.validate(found, json_schema("discover"), jsonschema.Draft202012Validator)
    assert found["verdict"] == "effect"
    best = found["causes"][0]
    assert found["candidates"][0]["names"] == [best["choice"]] == ["backlash:4"]
    assert (best["effect"], best["elements"]) == ("backlash", [4])
    assert [each["name"] for each in best["parameters"]] == ["play"]
    assert found.keys() == json_schema("discover")["properties"].keys()
    assert found["steps"] == [] and found["closing"] is None
    assert (folder / "model.toml").read_bytes() == before


def test_draft_and_pictures_are_written_beside_the_verdict(folder: Path) -> None:
    line = f"discover run.parquet -m model.toml --draft cause.py --plot {folder / 'pictures'}"
    done = run(folder, line)
    assert done.exit_code == 0, done.output
    assert done.stdout.startswith("Slider 4 has ")
    assert "cause.py: draft of learned:slider:4:" in done.stderr
    assert "the best learned function; the main cause is backlash:4" in done.stderr
    assert {each.name for each in (folder / "pictures").iterdir()} == {
        f"{name}{suffix}" for name in ("cause-backlash-4", "residual") for suffix in (".png", ".svg")
    }
    again = printed(run(folder, "discover run.parquet -m model.toml --effects cause.py --json"))
    assert any(name.startswith("learned_slider_4_") for each in again["candidates"] for name in each["names"])
    assert "cause.py: exists already" in refusal(run(folder, line))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ("--draft cause.txt", "cause.txt: cannot hold an effect (expected the name of a Python file, NAME.py)"),
        ("--plot model.toml", "model.toml: is a file (expected the name of a folder)"),
    ],
)
def test_what_cannot_be_written_is_refused_before_anything_is_computed(folder: Path, options: str, words: str) -> None:
    before = sorted(folder.iterdir())
    assert refusal(run(folder, f"discover run.parquet -m model.toml {options}")).endswith(words)
    assert sorted(folder.iterdir()) == before


def test_forms_are_added_by_auto_alone(folder: Path) -> None:
    before = (folder / "model.toml").read_bytes()
    done = run(folder, "discover run.parquet -m model.toml --forms")
    assert done.exit_code == 2
    assert "--forms: nothing is added without --auto (expected both)" in done.stderr
    assert (folder / "model.toml").read_bytes() == before


def test_auto_adds_until_nothing_is_missing(folder: Path) -> None:
    found = printed(run(folder, "discover run.parquet -m model.toml --effects mine.py --auto --json"))
    jsonschema.validate(found, json_schema("discover"), jsonschema.Draft202012Validator)
    assert found["verdict"] == "none"
    (step,) = found["steps"]
    jsonschema.validate({"schema": "hexdbb.add/1", **step}, json_schema("add"), jsonschema.Draft202012Validator)
    assert step["effect"] == "backlash"
    assert found["closing"].startswith("found and added: backlash:4; nothing ")
    model = load_model(folder / "model.toml")
    assert [each.what for each in model.ledger] == ["add"]
    again = run(folder, "discover run.parquet -m model.toml --auto")
    assert again.exit_code == 0
    assert again.stdout.startswith(("nothing is missing: what is left is noise", "nothing that matters is missing"))
    assert load_model(folder / "model.toml").ledger == model.ledger


def test_an_own_effect_in_every_command(folder: Path) -> None:
    added = printed(run(folder, "add my_play:4 run.parquet -m model.toml --effects mine.py --json"))
    assert added["rms_after_um"] < 0.6 < 1.2 < added["rms_before_um"]
    fitted = printed(run(folder, "diagnose run.parquet -m model.toml --effects mine.py --json"))
    assert fitted["rms_after_um"] == pytest.approx(added["rms_after_um"], rel=0.01)
    compared = printed(run(folder, "compare run.parquet -m model.toml --effects mine.py --json --no-plot"))
    assert compared
    for line in ("discover run.parquet -m model.toml", "history -m model.toml", "undo -m model.toml"):
        said = refusal(run(folder, line))
        assert "my_play" in said and "--effects FILE.py" in said
    assert "added my_play of slider 4" in run(folder, "history -m model.toml --effects mine.py").stdout
    for _ in ("diagnose", "add"):
        assert run(folder, "undo -m model.toml --effects mine.py").exit_code == 0
    assert "my_play" not in (folder / "model.toml").read_text()


def test_a_file_that_does_not_run_is_named_and_nothing_changes(folder: Path) -> None:
    before = (folder / "model.toml").read_bytes()
    (folder / "mine.py").write_text("import numpy as np\nraise RuntimeError('no luck')\n")
    said = refusal(run(folder, "discover run.parquet -m model.toml --effects mine.py --auto"))
    assert said == f"{folder / 'mine.py'}:2: RuntimeError: no luck"
    assert (folder / "model.toml").read_bytes() == before
