"""`hexdbb thesis`: files and tables it writes, and what it refuses, run as a program."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
from tests.programs import called

from hexdbb.record import write_record
from hexdbb.studies.thesis.circular_test import joint_plane_circle
from hexdbb.studies.thesis.simulated import simulated_record
from hexdbb.studies.thesis.tables import GIVEN, SEVEN, all_values


def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return called("hexdbb", "thesis", *arguments)


@pytest.fixture
def record_path(tmp_path: Path) -> Path:
    values = all_values(SEVEN, np.array([GIVEN[name] for name in SEVEN]))
    path = tmp_path / "circle.parquet"
    write_record(simulated_record(*joint_plane_circle(), values, seed=11), path)
    return path


def test_contours_as_table_and_picture(tmp_path: Path) -> None:
    ended = run("contours", "--plan", "standard", "--circle", "5", "--errors", "leg1, y1", "-o", tmp_path / "c")
    assert (ended.returncode, ended.stdout) == (0, "")
    assert ended.stderr.startswith("2 contours: ")
    lines = (tmp_path / "c.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + 2 * 360
    assert (tmp_path / "c.png").read_bytes().startswith(b"\x89PNG")
    assert "<svg" in (tmp_path / "c.svg").read_text(encoding="utf-8")


def test_existing_files_are_kept(tmp_path: Path) -> None:
    (tmp_path / "c.csv").write_text("mine")
    ended = run("contours", "--no-plot", "-o", tmp_path / "c")
    assert (ended.returncode, (tmp_path / "c.csv").read_text()) == (2, "mine")
    assert "c.csv: exists already" in ended.stderr
    assert run("contours", "--no-plot", "--overwrite", "-o", tmp_path / "c").returncode == 0
    assert len((tmp_path / "c.csv").read_text(encoding="utf-8").splitlines()) == 1 + 33 * 360


def test_estimate_as_table_and_json(record_path: Path) -> None:
    shown = run("estimate", record_path, "--errors", ",".join(SEVEN))
    assert shown.returncode == 0
    assert "leg1" in shown.stdout
    assert "hexdbb diagnose assumes neither" in shown.stdout
    found = json.loads(run("estimate", record_path, "--errors", ",".join(SEVEN), "--json").stdout)
    assert found["rank"] == 7
    leg = found["parameters"][0]
    assert (leg["error"], leg["effect"], leg["element"], leg["unit"]) == ("leg1", "leg_length", "1", "um")
    assert leg["value"] == pytest.approx(50.0, abs=5.0)
    assert found["rms_after_um"] == pytest.approx(0.5, rel=0.1)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["estimate", "{record}", "--errors", "leg1,leg2"], "singular, rank 1 of 2: leg2 = -1.000 leg1"),
        (["estimate", "{record}", "--errors", "leg1,foot"], 'error "foot": not known (expected one of: leg1'),
        (["contours", "-o", "{tmp}/c", "--circle", "0"], "--circle 0 without --plan"),
        (["contours", "-o", "{tmp}/c", "--plan", "standard", "--circle", "99"], "circle 99: not in the plan"),
        (["contours", "-o", "{tmp}/none/c"], "no such directory"),
    ],
)
def test_wrong_use_is_one_line_and_writes_nothing(
    record_path: Path, tmp_path: Path, arguments: list[str], message: str
) -> None:
    before = sorted(tmp_path.iterdir())
    ended = run(*(each.format(record=record_path, tmp=tmp_path) for each in arguments))
    assert (ended.returncode, ended.stdout) == (2, "")
    assert message in ended.stderr
    assert ended.stderr.count("\n") == 1
    assert sorted(tmp_path.iterdir()) == before


def test_minimum_norm_names_dependent_contours(record_path: Path) -> None:
    ended = run("estimate", record_path, "--errors", "leg1,leg2,y1", "--minimum-norm")
    assert ended.returncode == 0
    assert "dependent contours, in unit errors: leg2 = -1.000 leg1" in ended.stdout
