"""A year of one machine whose truth is known, in a logbook; fitted once."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest
from tests.programs import called

from hexdbb.record import write_record
from hexdbb_truth.months import Year

LIMITS = """
[[watch]]
what = "backlash"
limit = 9.0
unit = "um"

[[watch]]
what = "leg_length"
limit = 12.0
alarm = 100.0
unit = "um"
change = true

[[watch]]
what = "G(b)"
limit = 60.0
unit = "um"
"""


@pytest.fixture(scope="session")
def year() -> Year:
    return Year(5)


@pytest.fixture(scope="session")
def glider(year: Year, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A logbook with the year's records and limits."""
    folder = tmp_path_factory.mktemp("year")
    names = [f"month-{month + 1:02}.parquet" for month in range(len(year.play_um))]
    for name, record in zip(names, year.records(), strict=True):
        write_record(record, folder / name)
    added = called("hexdbb", "log", "add", "glider", *reversed(names), folder=folder)
    assert added.returncode == 0, added.stderr
    with (folder / "glider" / "machine.toml").open("a") as file:
        file.write(LIMITS)
    return folder / "glider"


@pytest.fixture(scope="session")
def done(glider: Path) -> subprocess.CompletedProcess[str]:
    return called("hexdbb", "trend", "glider", "--json", folder=glider.parent)


@pytest.fixture(scope="session")
def found(done: subprocess.CompletedProcess[str]) -> dict[str, Any]:
    result: dict[str, Any] = json.loads(done.stdout)
    return result
