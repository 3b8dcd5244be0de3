"""`hexdbb compare` as a user calls it, on a record made with the engine: known errors, two circles, noise."""

from __future__ import annotations

import json
import re
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.programs import called

from hexdbb import kinematics
from hexdbb.comparison import compare
from hexdbb.diagnosis import diagnose
from hexdbb.model import load_model, new_model, save_model
from hexdbb.plan import Plan, load_plan
from hexdbb.record import Record, read_record, write_record
from hexdbb.samples import Samples, predict

NOISE_UM = 0.5
SAMPLES_PER_LAP = 360


def run_compare(*arguments: object) -> subprocess.CompletedProcess[str]:
    return called("hexdbb", "compare", *arguments)


def measured(plan: Plan, circles: int, seed: int) -> Record:
    """Drive the plan's first circles on a machine with leg errors of tens of micrometres, with noise."""
    runs = [run for run in plan.runs() if run.circle.id in {circle.id for circle in plan.circles[:circles]}]
    machine = plan.machine_file()
    blocks = []
    for run in runs:
        angle_deg = np.mod(run.direction * np.arange(SAMPLES_PER_LAP) * 360.0 / SAMPLES_PER_LAP, 360.0)
        position_mm = run.circle.poses(np.radians(angle_deg), run.mount.cup_mm)
        sliders_mm, status = kinematics.inverse(machine, position_mm, run.circle.platform_rpy_rad)
        assert not status.any()
        same = np.broadcast_arrays(run.circle.id, run.sweep, run.direction, 0, angle_deg, run.feed_mm_min)
        blocks.append(np.column_stack([*same, sliders_mm]))
    names = ["circle", "sweep", "direction", "lap", "angle_deg", "feed_mm_min", *(f"s{k}_mm" for k in range(1, 7))]
    columns = dict(zip(names, np.concatenate(blocks).T, strict=True))
    count = len(columns["circle"])
    columns |= {"t_s": 0.004 * np.arange(count), "reading_um": np.zeros(count)}
    record = Record(columns, plan.gauge, plan.mounts, plan.circles, machine)
    rng = np.random.default_rng(seed)
    truth = new_model(machine, ["leg_length"])
    truth = truth.with_values(0.02 * rng.standard_normal(len(truth.values)), truth.sigma, np.ones(6, bool))
    noisy_um = 1e3 * predict(Samples.of([record]), truth).reading_mm + NOISE_UM * rng.standard_normal(count)
    return replace(record, columns=record.columns | {"reading_um": noisy_um})


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Hold a record of one circle and one of two, the nominal model, and one diagnosed from the two circles."""
    folder = tmp_path_factory.mktemp("compare")
    plan = load_plan("standard")
    one, two = measured(plan, 1, seed=1), measured(plan, 2, seed=2)
    write_record(one, folder / "one.parquet")
    write_record(two, folder / "two.parquet")
    save_model(new_model(plan.machine_file(), []), folder / "nominal.toml")
    save_model(diagnose(Samples.of([two]), new_model(plan.machine_file())).model, folder / "diagnosed.toml")
    return folder


def test_a_diagnosed_model_leaves_the_noise(folder: Path) -> None:
    done = run_compare(folder / "two.parquet", "-m", folder / "diagnosed.toml", "--json", "--no-plot")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["rms_um"] == pytest.approx(NOISE_UM, rel=0.05)
    assert len(found["circles"]) == 8
    for entry in found["circles"]:
        assert entry["circular_deviation_um"] > entry["predicted"]["circular_deviation_um"] - 0.5
        assert entry["predicted"]["circular_deviation_um"] > 5.0
    assert not list(folder.glob("two-compare*"))


def test_a_new_mount_is_fitted_first_and_said(folder: Path) -> None:
    """The nominal machine's circle is shifted onto the measured one: the offset goes, the shape stays unexplained."""
    done = run_compare(folder / "one.parquet", "-m", folder / "nominal.toml", "--json", "--no-plot")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    (said,) = found["fitted_mounts"]
    place, _, values = said.partition(": not known to the model, so its set-up was fitted first: ")
    assert place.endswith("one.parquet, mount 0")
    effects = [re.findall(r"^\w+|(?<= )[xyz](?= [+-]\d+\.\d µm)", each) for each in values.split("; ")]
    assert effects == [["cup_position", "x", "y", "z"], ["ball_eccentricity", "x", "y", "z"]]
    assert found["rms_um"] > 4 * NOISE_UM
    assert found["circles"][0]["predicted"]["circular_deviation_um"] < 0.1


@pytest.mark.parametrize("names", [("two.parquet",), ("one.parquet", "two.parquet")])
def test_the_command_prints_what_the_function_returns(folder: Path, names: tuple[str, ...]) -> None:
    """Known mounts and unknown ones: JSON, tables and the sentence on the set-up fitted first."""
    paths = [folder / name for name in names]
    comparison = compare(Samples.of([read_record(path) for path in paths]), load_model(folder / "diagnosed.toml"))
    assert len(comparison.fitted_mounts) == len(names) - 1
    printed = run_compare(*paths, "-m", folder / "diagnosed.toml", "--json", "--no-plot")
    assert json.loads(printed.stdout) == comparison.to_json()
    # The readings are drawn at random, at times no machine keeps: commands warn of that.
    assert [each for each in printed.stderr.splitlines() if not each.startswith("warning: ")] == []
    tables = run_compare(*paths, "-m", folder / "diagnosed.toml", "--no-plot")
    assert all(sentence in " ".join(tables.stdout.split()) for sentence in comparison.fitted_mounts)
    assert comparison.to_json()["schema"] == "hexdbb.compare/1"


def test_tables_and_pictures(folder: Path, tmp_path: Path) -> None:
    done = run_compare(
        folder / "two.parquet", "-m", folder / "diagnosed.toml", "--plot", tmp_path / "week", "--pages", "all"
    )
    assert done.returncode == 0, done.stderr
    assert "Largest residuals (arcs of ten degrees):" in done.stdout
    assert "…" not in done.stdout
    names = {"week.png", "week.pdf"}
    assert {path.name for path in tmp_path.iterdir()} == names
    assert all(str(tmp_path / name) in done.stderr for name in names)


def test_pictures_go_beside_the_first_record(folder: Path) -> None:
    done = run_compare(folder / "one.parquet", "-m", folder / "diagnosed.toml")
    assert done.returncode == 0, done.stderr
    assert [path.name for path in folder.glob("one-compare*")] == ["one-compare.png"]


def test_a_folder_takes_pictures_of_the_records_name(folder: Path, tmp_path: Path) -> None:
    done = run_compare(folder / "one.parquet", "-m", folder / "diagnosed.toml", "--no-cause", "--plot", tmp_path)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["one-compare.png"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["one.parquet", "-m", "absent.toml"], "absent.toml: no such model"),
        (["absent.parquet", "-m", "nominal.toml"], "absent.parquet"),
        (["one.parquet", "-m", "nominal.toml", "--plot", "nowhere/week"], "no such directory"),
        (["one.parquet", "-m", "nominal.toml", "--plot", "week", "--no-plot"], "expected one of them"),
        (["one.parquet", "-m", "nominal.toml", "--pages", "all", "--no-plot"], "expected one of them"),
    ],
)
def test_wrong_use_is_one_line_and_writes_nothing(folder: Path, arguments: list[str], words: str) -> None:
    before = sorted(folder.rglob("*"))
    named = [folder / word if word.endswith((".parquet", ".toml", "week")) else word for word in arguments]
    done = run_compare(*named)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1
    assert words in done.stderr
    assert sorted(folder.rglob("*")) == before


def test_help_shows_examples_on_lines_of_their_own() -> None:
    done = run_compare("--help")
    assert done.returncode == 0
    assert "    hexdbb compare demo.parquet -m model.toml\n" in done.stdout
