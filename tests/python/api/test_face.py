"""`import hexdbb as hx` offers what its page lists, loads nothing before it is used, and says what the commands say."""

from __future__ import annotations

import inspect
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import hexdbb as hx
from hexdbb_truth.cases import case

NAMES = [name for name in hx.__all__ if not name.startswith("_")]


@pytest.mark.parametrize("name", NAMES)
def test_name_is_there_with_a_docstring(name: str) -> None:
    assert inspect.getdoc(getattr(hx, name))


def test_first_page_lists_every_name() -> None:
    assert hx.__doc__ is not None
    assert set(NAMES) - set(re.findall(r"[A-Za-z_]+", hx.__doc__)) == set()


@pytest.mark.parametrize("name", NAMES)
def test_name_stays_a_function_after_its_package_is_imported(name: str) -> None:
    assert not inspect.ismodule(getattr(hx, name))


def test_importing_hexdbb_loads_neither_engine_nor_matplotlib() -> None:
    code = "import sys, hexdbb; print([m for m in ('hexdbb._core', 'matplotlib', 'scipy', 'can') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_version_is_the_packages() -> None:
    assert re.fullmatch(r"\d+\.\d+\.\d+", hx.__version__)


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a record of a machine whose slider has play, and a model that lacks it."""
    folder = tmp_path_factory.mktemp("face")
    hx.write_record(case("backlash-x3-s1").record(), folder / "today.parquet")
    return folder


def printed_by(command: str, folder: Path) -> dict[str, Any]:
    words = [sys.executable, "-m", "hexdbb.cli", *command.split(), "--json"]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=True)
    said: dict[str, Any] = json.loads(done.stdout)
    return said


def test_diagnose_and_discover_say_what_the_commands_say(place: Path) -> None:
    record = hx.read_record(place / "today.parquet")
    found = hx.diagnose(record, hx.new_model(record.machine))
    assert printed_by("diagnose today.parquet -m model.toml", place) == json.loads(json.dumps(found.to_json()))
    model = hx.load_model(place / "model.toml")
    said = printed_by("discover today.parquet -m model.toml", place)
    assert said == json.loads(json.dumps(hx.discover(record, model).to_json()))


def test_a_record_or_a_table_gives_the_same(place: Path) -> None:
    record = hx.read_record(place / "today.parquet")
    model = hx.new_model(record.machine, [])
    one = hx.predict(record, model)
    same = hx.predict(hx.Samples.of([record]), model)
    assert (one.reading_mm == same.reading_mm).all()


def test_no_record_is_refused() -> None:
    with pytest.raises(hx.InputError, match="no record"):
        hx.predict([], hx.new_model(hx.shipped_machine(), []))
