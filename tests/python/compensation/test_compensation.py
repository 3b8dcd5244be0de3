"""Compensation through Python and the command line: a model becomes a file, a header, targets of a path."""

from __future__ import annotations

import json
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.programs import called

from hexdbb import _core
from hexdbb.compensation import (
    POSE_COLUMNS,
    make_compensation,
    path_targets,
    read_compensation,
    read_poses,
    write_compensation,
)
from hexdbb.effects import load_effects
from hexdbb.errors import InputError
from hexdbb.kinematics import inverse
from hexdbb.ledger import fit_model
from hexdbb.machine import shipped_machine
from hexdbb.model import Model, new_model, new_term, save_model
from hexdbb.plan import load_plan
from hexdbb.record import read_record, write_record
from hexdbb.rig.mechanisms import MECHANISMS
from hexdbb.rig.truth import TruthFile
from hexdbb.samples import Samples
from hexdbb_truth.simulate import simulate

EFFECTS = ["leg_length", "guideway_rotation_xy", "backlash", "gravity_sag", "cup_position", "reversal_spike"]


def wrong_model() -> Model:
    """Every value at half its prior standard deviation, signs in turn."""
    model = new_model(shipped_machine(), EFFECTS)
    sizes = np.array([each.prior_sigma for each in model.parameters()])
    values = 0.5 * sizes * np.where(np.arange(len(sizes)) % 2, -1.0, 1.0)
    return model.with_values(values, np.full(len(sizes), np.nan), np.ones(len(sizes), bool))


def circle(count: int = 200) -> np.ndarray:
    angle = np.linspace(0.0, 2.0 * np.pi, count)
    return np.column_stack([80.0 * np.cos(angle), 80.0 * np.sin(angle), np.full(count, 285.0)])


@pytest.fixture
def model_path(tmp_path: Path) -> Path:
    path = tmp_path / "model.toml"
    save_model(wrong_model(), path)
    return path


def hexdbb(*arguments: object, folder: Path) -> subprocess.CompletedProcess[str]:
    return called("hexdbb", *arguments, folder=folder)


def test_what_is_corrected_and_what_is_left_out() -> None:
    data = make_compensation(wrong_model())
    assert {"leg_length", "backlash", "gravity_sag"} <= set(data.effects)
    assert dict(data.left_out) == {
        "cup_position": "belongs to the measurement, not to the machine",
        "reversal_spike": "depends on since_reversal_s, which is not known to a controller",
    }


def test_file_there_and_back(tmp_path: Path) -> None:
    data = make_compensation(wrong_model(), max_correction_mm=0.7)
    path = tmp_path / "sp120.hexcomp"
    write_compensation(data, path)
    again = read_compensation(path, shipped_machine())
    assert again.text() == data.text()
    assert again.max_correction_mm == 0.7


def test_targets_along_a_path_undo_the_errors() -> None:
    data = make_compensation(wrong_model(), max_correction_mm=2.0)
    targets = path_targets(data, circle(), [0.05, 0.0, 0.1])
    nominal, _ = inverse(shipped_machine(), circle(), [0.05, 0.0, 0.1])
    np.testing.assert_allclose(targets.sliders_mm - targets.correction_mm, nominal, atol=1e-9)
    assert np.abs(targets.correction_mm).max() > 0.02
    compensator = _core.Compensator(data, "test")
    for row in range(1, 200):  # directions of travel as they were along the path
        rpy = np.array([[0.05, 0.0, 0.1]] * 2)
        sliders, _, _, _ = compensator.sliders_along(
            circle()[row - 1 : row + 1], rpy, np.array([0.0, 1e6]), np.full(2, np.nan)
        )
        pose, status = compensator.poses_of(sliders[1:])
        assert status[0] == 0
        np.testing.assert_allclose(pose[0, :3], circle()[row], atol=1e-5)


def test_a_path_out_of_reach_names_row_and_slider() -> None:
    poses = circle(4)
    poses[2, 2] = 900.0
    with pytest.raises(InputError, match=r"my path: row 3: slider \d: unreachable"):
        path_targets(make_compensation(wrong_model()), poses, [0.0, 0.0, 0.0], name="my path")


def test_more_correction_than_allowed_is_refused() -> None:
    with pytest.raises(InputError, match="correction limit"):
        path_targets(make_compensation(wrong_model(), max_correction_mm=1e-3), circle(), [0.0, 0.0, 0.0])


def test_command_writes_file_and_header(model_path: Path) -> None:
    folder = model_path.parent
    done = hexdbb("compensate", model_path, "-o", "a.hexcomp", "--header", "a.h", "--json", folder=folder)
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    assert "leg_length" in summary["corrected"]
    assert [each["effect"] for each in summary["left_out"]] == ["cup_position", "reversal_spike"]
    assert read_compensation(folder / "a.hexcomp").model_sha256
    assert "hexdbb_compensation_values" in (folder / "a.h").read_text()
    again = hexdbb("compensate", "a.hexcomp", "--header", "b.h", folder=folder)
    assert again.returncode == 0, again.stderr
    assert (folder / "b.h").read_text() == (folder / "a.h").read_text()


def test_command_corrects_a_path(model_path: Path) -> None:
    folder = model_path.parent
    rows = [",".join(POSE_COLUMNS), *(f"{x},{y},{z},2.0,0,1.0" for x, y, z in circle(50))]
    (folder / "path.csv").write_text("\n".join(rows) + "\n")
    done = hexdbb("compensate", model_path, "--poses", "path.csv", "-o", "sliders.csv", folder=folder)
    assert done.returncode == 0, done.stderr
    table = np.loadtxt(folder / "sliders.csv", delimiter=",", skiprows=1)
    expected = path_targets(make_compensation(wrong_model()), circle(50), np.radians([2.0, 0.0, 1.0])).sliders_mm
    np.testing.assert_allclose(table, expected, atol=1e-6)
    assert (folder / "sliders.csv").read_text().startswith("s1_mm,s2_mm,s3_mm,s4_mm,s5_mm,s6_mm\n")


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (lambda text: text[: len(text) // 2], "truncated"),
        (lambda text: text.replace("1.longer = ", "1.longer = -"), "altered"),
        (lambda text: text.replace("compensation/1", "compensation/9"), "later version"),
        (lambda text: "[nothing]\n", "not a compensation file"),
    ],
    ids=["truncated", "altered", "later_version", "something_else"],
)
def test_a_wrong_file_is_refused_by_name(tmp_path: Path, change: object, expected: str) -> None:
    assert callable(change)
    path = tmp_path / "wrong.hexcomp"
    path.write_text(change(make_compensation(wrong_model()).text()))
    done = hexdbb("compensate", path, "--header", "out.h", folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: {path}: ")
    assert expected in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "out.h").exists()


def test_the_file_of_another_machine_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "sp120.hexcomp"
    write_compensation(make_compensation(wrong_model()), path)
    ours = shipped_machine()
    other = ours.model_copy(update={"legs": ours.legs.model_copy(update={"length_mm": 401.0})})
    with pytest.raises(InputError, match=r"of another machine: leg_length_mm is 400 \(expected 401\)"):
        read_compensation(path, other)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", r"columns  \(expected x_mm"),
        ("x_mm,y_mm\n1,2\n", r"columns x_mm,y_mm \(expected"),
        (",".join(POSE_COLUMNS) + "\n", "no poses"),
        (",".join(POSE_COLUMNS) + "\n1,2,3,4,5,six\n", 'line 2: yaw_deg: "six"'),
        (",".join(POSE_COLUMNS) + "\n1,2,285,0,0,0\n1,nan,285,0,0,0\n", 'line 3: y_mm: "nan"'),
        (",".join(POSE_COLUMNS) + "\n1,2,285,0,0,\n", 'line 2: yaw_deg: ""'),
        (",".join(POSE_COLUMNS) + "\n1,2,285,0,0\n", r"line 2: cells: 5 \(expected 6, as the first line has\)"),
        (",".join(POSE_COLUMNS) + "\n10,5,20,285,0,0,0\n", "line 2: cells: 7 .*the decimal mark is a point"),
        (",".join(POSE_COLUMNS) + "\n10,20,285,0,0,0\n11,20,285,0,0,0,5\n", "line 3: cells: 7"),
        (",".join(POSE_COLUMNS) + '\n10,20,285,0,0,"0\n', "line 2: a stray quote"),
    ],
)
def test_a_wrong_table_of_poses_is_refused(tmp_path: Path, text: str, expected: str) -> None:
    path = tmp_path / "path.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=expected):
        read_poses(path)


OWN = '''
from hexdbb.effects import effect
from hexdbb.samples import Samples


@effect(port="slider", unit="mm", prior_sigma=0.01, elements=6)
def dent(state):
    """A dent."""
    return (abs(state.sliders_mm - 300.0) < 5.0) * 1.0
'''


def test_effects_of_ones_own_that_are_no_table_are_left_out_by_name(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(OWN)
    own = load_effects(tmp_path / "mine.py")
    known = wrong_model().knowing_effects(own)
    dent = replace(new_term("dent", 6), values=np.full(6, 0.01))
    save_model(replace(known, terms=(*known.terms, dent)), tmp_path / "model.toml")
    refused = hexdbb("compensate", "model.toml", "-o", "a.hexcomp", folder=tmp_path)
    assert refused.returncode == 2
    assert "--effects" in refused.stderr
    line = ("compensate", "model.toml", "--effects", "mine.py", "-o", "a.hexcomp", "--json")
    done = hexdbb(*line, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    left_out = {each["effect"]: each["reason"] for each in json.loads(done.stdout)["left_out"]}
    assert left_out["dent"].startswith("jumps at sliders_mm = ")
    written = read_compensation(tmp_path / "a.hexcomp")
    assert dict(written.left_out)["dent"] == left_out["dent"]
    assert written.effects == make_compensation(wrong_model()).effects


@pytest.fixture(scope="module")
def warmed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A record of a machine whose legs grow with a thermometer, and the model diagnosed from it."""
    folder = tmp_path_factory.mktemp("warmed")
    plan = load_plan("thesis").model_copy(update={"feeds_mm_min": (6000.0,), "laps": 1})
    table = {"kind": "leg_thermal", "growth_um": 60.0, "time_constant_s": 60.0}
    growth = MECHANISMS["leg_thermal"].model_validate(table)
    record = simulate(TruthFile(mechanism=(growth,)), plan, 1, temperature=True)
    write_record(record, folder / "warm.parquet")
    write_record(simulate(TruthFile(mechanism=(growth,)), plan, 2), folder / "other.parquet")
    samples = Samples.of([read_record(folder / "warm.parquet")])
    found = fit_model(samples, new_model(record.machine, ["leg_thermal", "cup_position"]))
    save_model(found.model, folder / "model.toml")
    return folder


def test_the_reference_temperature_is_that_of_the_records_first_sample(warmed: Path) -> None:
    done = hexdbb("compensate", "model.toml", "--reference", "warm.parquet", "-o", "a.hexcomp", folder=warmed)
    assert done.returncode == 0, done.stderr
    first = read_record(warmed / "warm.parquet").columns["temperature_c"][0]
    assert read_compensation(warmed / "a.hexcomp").reference_temperature_c == first
    assert "leg_thermal" in read_compensation(warmed / "a.hexcomp").effects


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--reference", "other.parquet"), "other.parquet: the model was not fitted to it"),
        (("--reference", "gone.parquet"), "gone.parquet: no such file"),
        (("--reference", "warm.parquet", "--reference-temperature-c", "20"), "expected one of them"),
    ],
)
def test_a_wrong_reference_is_refused(warmed: Path, words: tuple[str, ...], message: str) -> None:
    done = hexdbb("compensate", "model.toml", *words, "-o", "b.hexcomp", folder=warmed)
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (warmed / "b.hexcomp").exists()


def test_command_names_the_missing_option(model_path: Path) -> None:
    assert "nothing to write" in hexdbb("compensate", model_path, folder=model_path.parent).stderr
    done = hexdbb("compensate", model_path, "--poses", "p.csv", "--header", "a.h", folder=model_path.parent)
    assert done.returncode == 2
    assert "--poses without -o" in done.stderr
