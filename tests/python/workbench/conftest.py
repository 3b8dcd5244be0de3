"""A machine whose slider 4 has play, measured at a third of the usual pace, and a model of geometry fitted to it."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

import hexdbb as hx
from hexdbb_truth.cases import case
from hexdbb_truth.plans import PACE


@pytest.fixture(scope="session")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with `today.parquet` and `model.toml`, which lacks the play; copied, not changed."""
    folder = tmp_path_factory.mktemp("measured")
    record = case("backlash-x3-s1", replace(PACE, rate_hz=PACE.rate_hz / 3.0)).record()
    hx.write_record(record, folder / "today.parquet")
    hx.save_model(hx.diagnose(record, hx.new_model(record.machine)).model, folder / "model.toml")
    return folder


@pytest.fixture
def folder(measured: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a copy of it, which is the working directory."""
    for each in measured.iterdir():
        shutil.copy2(each, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path
