"""A hidden fault found over real CAN frames: rig, controller, record, compare, discover, add, only noise left.

Rig and controller are processes of their own, every step is a command as a user types it; the rig computes the fault by
stepping a play operator in time, with nothing of the engine in it.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from tests.programs import called

from hexdbb.files.validation import dump_toml
from hexdbb.plan import load_plan
from hexdbb.record import read_record
from hexdbb.rig.truth import random_truth

TRUTH_SEED = 20060702
SLIDER, WIDTH_UM = 4, 15.0
NOISE_UM = 0.5
RATE_HZ = 20
FEEDS_MM_MIN = (1500.0, 3000.0)
"""Two, or play and lag behind the drives would look much alike."""
FAULT = f'\n[[mechanism]]\nkind = "backlash"\nslider = {SLIDER}\nwidth_um = {WIDTH_UM}\n'


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the record of a machine that has a fault, and a model fitted to it that has not."""
    folder = tmp_path_factory.mktemp("hidden_fault")
    plan = load_plan("standard").model_copy(update={"feeds_mm_min": FEEDS_MM_MIN, "laps": 1})
    (folder / "plan.toml").write_text(dump_toml(plan), encoding="utf-8")
    (folder / "truth.toml").write_text(dump_toml(random_truth(TRUTH_SEED)) + FAULT, encoding="utf-8")
    runner = str(Path(sys.executable).with_name("hexdbb-run"))
    words = [runner, "--plan", "plan.toml", "--rate", str(RATE_HZ), "--truth", "truth.toml", "-o", "today.parquet"]
    subprocess.run(words, cwd=folder, check=True, capture_output=True, timeout=300)
    told(folder, "diagnose", "today.parquet", "-m", "model.toml")
    return folder


def told(folder: Path, *words: str) -> dict[str, Any]:
    """Run a command of `hexdbb` in a folder; give the object it prints."""
    done = called("hexdbb", *words, "--json", folder=folder)
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def test_hidden_fault_is_seen_named_and_added_until_only_noise_is_left(folder: Path) -> None:
    record = read_record(folder / "today.parquet")
    assert record.complete
    assert len(record.sweeps()) == 7 * 2 * len(FEEDS_MM_MIN)

    compared = told(folder, "compare", "today.parquet", "-m", "model.toml", "--no-plot")
    assert compared["rms_um"] > 2.0 * NOISE_UM

    missing = told(folder, "discover", "today.parquet", "-m", "model.toml")
    assert missing["verdict"] == "effect"
    assert missing["causes"][0]["effect"] == "backlash"
    assert missing["causes"][0]["elements"] == [SLIDER]

    step = told(folder, "add", f"backlash:{SLIDER}", "-m", "model.toml", "today.parquet")
    assert step["rms_before_um"] > 2.0 * NOISE_UM
    assert step["rms_after_um"] < 1.1 * NOISE_UM
    assert step["heldout_after_um"] < 1.2 * NOISE_UM
    (play,) = step["sizes"]
    assert play["value"] == pytest.approx(WIDTH_UM, abs=max(0.1, 4.0 * play["sigma"]))

    assert told(folder, "discover", "today.parquet", "-m", "model.toml")["verdict"] == "none"
    compared = told(folder, "compare", "today.parquet", "-m", "model.toml", "--no-plot")
    assert compared["rms_um"] < 1.1 * NOISE_UM
    steps = told(folder, "history", "-m", "model.toml")["steps"]
    assert [each["what"] for each in steps] == ["diagnose", "add"]
