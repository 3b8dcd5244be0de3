"""From a truth file over real CAN frames between processes to the errors it holds.

The rig computes its readings with a solver and a geometry of its own; nothing of the engine is in them. What the
readings can tell must come back within the uncertainty the diagnosis states; what they cannot is compared nowhere.
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from tests.programs import called

from hexdbb.diagnosis import diagnose
from hexdbb.files.validation import dump_toml
from hexdbb.model import new_model
from hexdbb.plan import load_plan
from hexdbb.record import Record, read_record
from hexdbb.rig.truth import random_truth
from hexdbb.samples import Samples

TRUTH_SEED = 20060701
RATE_HZ = 40.0
FEED_MM_MIN = 3000.0


def command(*words: str | Path) -> list[str]:
    """Return the command line of `hexdbb`."""
    return [sys.executable, "-m", "hexdbb.cli", *map(str, words)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Return a folder with a plan of the seven standard circles, one lap each way, and a truth file."""
    folder = tmp_path_factory.mktemp("end_to_end")
    plan = load_plan("standard").model_copy(update={"feeds_mm_min": (FEED_MM_MIN,), "laps": 1})
    (folder / "plan.toml").write_text(dump_toml(plan))
    (folder / "truth.toml").write_text(dump_toml(random_truth(TRUTH_SEED)))
    return folder


@pytest.fixture(scope="module")
def record(folder) -> Record:
    """Start the rig as a process, drive the plan over its bus as another, read what was recorded."""
    rig = subprocess.Popen(
        command("rig", "--truth", folder / "truth.toml", "--exit-with-parent"), stdout=subprocess.PIPE, text=True
    )
    try:
        channel = rig.stdout.readline().split()[-1]
        run = [Path(sys.executable).with_name("hexdbb-run"), "--plan", folder / "plan.toml"]
        run += ["--bus", f"socketcand:{channel}", "--lockstep", "--yes", "--rate", RATE_HZ]
        run += ["-o", folder / "run.parquet"]
        subprocess.run(list(map(str, run)), check=True, timeout=300, capture_output=True)
    finally:
        rig.terminate()
        rig.wait(timeout=10)
        rig.stdout.close()
    return read_record(folder / "run.parquet")


def true_values(model) -> np.ndarray:
    """Lay the truth file's values out as the model's, in mm and rad."""
    truth = random_truth(TRUTH_SEED)
    by_effect = {
        name.rpartition("_")[0]: np.ravel(value) * 1e-3 if name.endswith("_um") else np.ravel(value) * 1e-6
        for name, value in truth.geometry.model_dump().items()
    }
    by_effect["cup_position"] = np.array(truth.setup.cup_error_um[0]) * 1e-3
    by_effect["ball_offset"] = np.array(truth.setup.ball_offset_error_um) * 1e-3
    by_effect["bar_length"] = np.zeros(1)
    return np.concatenate([by_effect[term.effect] for term in model.terms])


def test_record_holds_every_sample(record):
    circles, laps, directions = 7, 1, 2
    lap_s = 2 * np.pi * 100.0 / (FEED_MM_MIN / 60.0)
    assert record.complete
    assert len(record.columns["t_s"]) == pytest.approx(circles * laps * directions * lap_s * RATE_HZ, rel=0.01)
    assert len(record.sweeps()) == circles * directions


def test_truth_is_recovered_within_stated_uncertainty(record):
    found = diagnose(Samples.of([record]), new_model(record.machine))
    assert found.rank == 21
    assert found.rms_before_um > 50.0
    assert found.rms_after_um < 1.1 * found.noise_um
    known = ~np.isnan(found.model.sigma)
    assert known.sum() >= 10, "legs, ball offset and the cup's place must be known on their own"
    missed = (found.model.values - true_values(found.model))[known] / found.model.sigma[known]
    assert np.abs(missed).max() < 4.0
    assert 0.3 < np.sqrt(np.mean(missed**2)) < 1.7


def test_commands_tell_the_same_story(record, folder):
    model = folder / "model.toml"
    diagnosis = json.loads(called("hexdbb", "diagnose", record.path, "-m", model, "--json").stdout)
    assert diagnosis["rank"] == 21
    assert diagnosis["usable"]
    compared = json.loads(called("hexdbb", "compare", record.path, "-m", model, "--json", "--no-plot").stdout)
    assert compared["rms_um"] == pytest.approx(diagnosis["rms_after_um"], rel=1e-6)
