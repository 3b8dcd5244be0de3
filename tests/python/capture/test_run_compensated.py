"""`hexdbb-run --compensation`: refused by name before anything moves; no jump, no limit exceeded; the error falls."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tests.programs import called
from tests.rigs import rig_in_thread
from tests.truth.held_out import held_out_plans

from hexdbb.compensation import make_compensation, write_compensation
from hexdbb.files.validation import dump_toml
from hexdbb.machine import shipped, shipped_machine
from hexdbb.model import new_model
from hexdbb.plan import Plan, load_plan
from hexdbb.record import TARGET_COLUMNS, read_record
from hexdbb.rig.mechanisms import MECHANISMS
from hexdbb.rig.truth import DriveTruth, TruthFile, random_truth

ROOT = Path(__file__).parents[3]
RATE_HZ = 40.0
NOISE_UM = 0.5
EFFECTS = ("backlash", "pitch_cyclic", "gravity_sag")


def told(program: str, *words: object, folder: Path) -> str:
    done = called(program, *words, folder=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout


# --- refused ----------------------------------------------------------------------------------------------------------


def of_another_machine(folder: Path) -> None:
    text = shipped("sp120.toml").read_text(encoding="utf-8").replace("length_mm = 400.0", "length_mm = 401.0")
    (folder / "machine.toml").write_text(text, encoding="utf-8")
    plan = load_plan("thesis").model_copy(update={"machine": "machine.toml"})
    (folder / "plan.toml").write_text(dump_toml(plan), encoding="utf-8")


def changing(change: Callable[[str], str]) -> Callable[[Path], None]:
    def apply(folder: Path) -> None:
        path = folder / "sp120.hexcomp"
        path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")

    return apply


def gone(folder: Path) -> None:
    (folder / "sp120.hexcomp").unlink()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A plan and a good compensation file."""
    (tmp_path / "plan.toml").write_text(dump_toml(load_plan("thesis")), encoding="utf-8")
    model = new_model(shipped_machine(), ["leg_length"])
    model = model.with_values(np.full(6, 0.1), np.full(6, np.nan), np.ones(6, bool))
    write_compensation(make_compensation(model), tmp_path / "sp120.hexcomp")
    return tmp_path


@pytest.mark.parametrize(
    ("damage", "words", "said"),
    [
        (changing(lambda text: text[: len(text) // 2]), (), "sp120.hexcomp: truncated"),
        (changing(lambda text: text.replace("1.longer = ", "1.longer = -")), (), "sp120.hexcomp: altered"),
        (changing(lambda text: text.replace("compensation/1", "compensation/9")), (), "sp120.hexcomp: .*later version"),
        (changing(lambda text: "[nothing]\n"), (), "sp120.hexcomp: not a compensation file"),
        (of_another_machine, (), r"sp120.hexcomp: of another machine: leg_length_mm is 400 \(expected 401\)"),
        (gone, (), "sp120.hexcomp: cannot be read"),
        (lambda _: None, ("--overwrite", "--compensation", "."), r"\.: cannot be read"),
    ],
    ids=["truncated", "altered", "later_version", "something_else", "other_machine", "gone", "a_folder"],
)
def test_a_wrong_file_is_refused_before_a_bus_is_looked_for(
    folder: Path, damage: Callable[[Path], None], words: tuple[str, ...], said: str
) -> None:
    damage(folder)
    there = sorted(folder.iterdir())
    line = ("--plan", "plan.toml", "--compensation", "sp120.hexcomp", "-o", "after.parquet")
    done = called("hexdbb-run", *line, "--bus", "socketcand:127.0.0.1:1", *words, folder=folder)
    assert done.returncode == 2, done.stderr
    assert done.stderr.count("\n") == 1, done.stderr
    assert re.search(rf"^error: {said}", done.stderr), done.stderr
    assert sorted(folder.iterdir()) == there


def test_more_correction_than_the_file_allows_is_refused_by_place_and_slider(folder: Path) -> None:
    model = new_model(shipped_machine(), ["leg_length"])
    model = model.with_values(np.full(6, 0.5), np.full(6, np.nan), np.ones(6, bool))
    write_compensation(make_compensation(model, max_correction_mm=0.1), folder / "sp120.hexcomp")
    done = called("hexdbb-run", "--compensation", "sp120.hexcomp", "-o", "a.parquet", folder=folder)
    assert done.returncode == 2
    line = (
        r"error: thesis: circle 0, .*: slider \d: correction of \d+\.\d µm"
        r" \(expected at most 100 µm, the limit in sp120.hexcomp"
    )
    assert re.match(line, done.stderr), done.stderr
    assert not (folder / "a.parquet").exists()


# --- closed -----------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def closed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Measure, diagnose, compensate, measure circles that were not fitted, before and after: on the rig, over CAN."""
    folder = tmp_path_factory.mktemp("closed")
    fitted = load_plan(ROOT / "docs" / "plans" / "best-5.toml")
    fast = {"feeds_mm_min": (3000.0,), "laps": 1}
    (folder / "fitted.toml").write_text(dump_toml(fitted.model_copy(update=fast)), encoding="utf-8")
    (folder / "unseen.toml").write_text(dump_toml(unseen_plan({**fast, "directions": (1,)})), encoding="utf-8")
    (folder / "truth.toml").write_text(dump_toml(faulty_truth()), encoding="utf-8")
    measured(folder, "--plan", "fitted.toml", "-o", "fitted.parquet")
    geometry = [term.effect for term in new_model(shipped_machine()).terms if term.effect != "bar_length"]
    effects = ",".join([*geometry, *EFFECTS])
    told("hexdbb", "model", "new", "sp120", "-o", "model.toml", "--effects", effects, folder=folder)
    told("hexdbb", "model", "new", "sp120", "-o", "nominal.toml", "--effects", "none", folder=folder)
    told("hexdbb", "diagnose", "fitted.parquet", "-m", "model.toml", folder=folder)
    told("hexdbb", "compensate", "model.toml", "-o", "sp120.hexcomp", folder=folder)
    measured(folder, "--plan", "unseen.toml", "-o", "before.parquet")
    measured(folder, "--plan", "unseen.toml", "--compensation", "sp120.hexcomp", "-o", "after.parquet")
    return folder


def measured(folder: Path, *words: object) -> None:
    """Measure on a rig with the hidden faults."""
    with rig_in_thread("--truth", folder / "truth.toml") as port:
        bus = ("--bus", f"socketcand:127.0.0.1:{port}", "--yes", "--lockstep", "--rate", RATE_HZ)
        told("hexdbb-run", *words, *bus, folder=folder)


def unseen_plan(fast: dict[str, object]) -> Plan:
    """Three circles of a bar of 80 mm at other heights and tilts."""
    plan = held_out_plans()[1]
    return plan.model_copy(update={**fast, "mounts": plan.mounts[:3], "circles": plan.circles[:3]})


def faulty_truth() -> TruthFile:
    """Return a random machine with play, a pitch error and compliant legs.

    Its drives reach their targets: at `RATE_HZ`, a lag of 2 ms would cut the corners of the circles by 0.7 um.
    """
    tables = [
        {"kind": "backlash", "slider": 4, "width_um": 15.0},
        {"kind": "backlash", "slider": 1, "width_um": 8.0},
        {"kind": "pitch_cyclic", "slider": 2, "amplitude_um": 5.0, "phase_deg": 40.0},
        {"kind": "gravity_sag", "compliance_um_n": 0.4},
    ]
    mechanisms = tuple(MECHANISMS[str(table["kind"])].model_validate(table) for table in tables)
    return random_truth(20060701).model_copy(update={"mechanism": mechanisms, "drive": DriveTruth(lag_s=1e-9)})


def radial(folder: Path, *records: str) -> list[dict[str, object]]:
    words = ("compare", *records, "-m", "nominal.toml", "--json", "--no-plot")
    found = json.loads(told("hexdbb", *words, folder=folder))["radial"]
    assert isinstance(found, list)
    return found


def test_the_error_of_unseen_circles_falls_to_the_noise(closed: Path) -> None:
    before, after = radial(closed, "before.parquet", "after.parquet")
    assert before["compensation"] is None
    assert after["compensation"] == "sp120.hexcomp"
    assert float(str(before["rms_um"])) > 8.0
    assert float(str(after["rms_um"])) < 1.5 * NOISE_UM
    assert float(str(after["peak_to_valley_um"])) < float(str(before["peak_to_valley_um"])) / 8.0


def test_the_record_says_what_was_driven(closed: Path) -> None:
    record = read_record(closed / "after.parquet")
    driven = record.metadata["compensation"]
    assert driven["file"] == "sp120.hexcomp"
    assert set(EFFECTS) <= set(driven["corrected"])
    assert len(driven["sha256"]) == 64
    before = read_record(closed / "before.parquet")
    assert "compensation" not in before.metadata
    moved = np.column_stack([record.columns[name] - before.columns[name] for name in TARGET_COLUMNS])
    assert 0.02 < np.abs(moved).max() < 1.0


def test_a_compensated_record_is_diagnosed_like_any_other(closed: Path) -> None:
    words = ("diagnose", "fitted.parquet", "after.parquet", "-m", "model.toml", "--robust", "--json")
    found = json.loads(told("hexdbb", *words, folder=closed))
    assert found["usable"]
    # Turns of the drives are the one place where few samples a second blur a compensated record.
    assert found["rms_after_um"] < 1.4 * found["noise_um"]
    play = {each["element"]: each["value"] for each in found["parameters"] if each["effect"] == "backlash"}
    assert play["4"] == pytest.approx(15.0, abs=1.0)
    assert play["1"] == pytest.approx(8.0, abs=1.0)
