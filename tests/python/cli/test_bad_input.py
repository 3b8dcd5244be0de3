"""Bad input through the commands: one clear line, exit status 2, nothing written, nothing moved."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tests.programs import called

from hexdbb.kinematics import inverse
from hexdbb.machine import shipped
from hexdbb.model import new_model, save_model
from hexdbb.plan import load_plan
from hexdbb.record import SLIDER_COLUMNS, Record, write_record

SHIPPED = {"plan.toml": shipped("plans", "thesis.toml"), "machine.toml": shipped("sp120.toml")}


@pytest.fixture
def folder(record: Record, tmp_path: Path) -> Path:
    """Everything a user might have, all of it good: machine, plan, record in both forms, model."""
    for name, source in SHIPPED.items():
        (tmp_path / name).write_text(source.read_text(encoding="utf-8"), encoding="utf-8")
    put_on_circle(record)
    write_record(record, tmp_path / "run.parquet")
    write_record(record, tmp_path / "text.csv")
    save_model(new_model(record.machine, ["leg_length", "cup_position"]), tmp_path / "model.toml")
    return tmp_path


def put_on_circle(record: Record) -> None:
    """Let the sliders stand where the record's circle is."""
    (circle,), (mount,) = record.circles, record.mounts
    position_mm = circle.poses(np.radians(record.columns["angle_deg"]), mount.cup_mm)
    sliders_mm, status = inverse(record.machine, position_mm, circle.platform_rpy_rad)
    assert not status.any()
    record.columns.update(zip(SLIDER_COLUMNS, sliders_mm.T, strict=True))


def run(folder: Path, line: str) -> subprocess.CompletedProcess[str]:
    """Run a command line in a folder."""
    return called(*line.split(), folder=folder)


def contents(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def replacing(name: str, old: str, new: str) -> Callable[[Path], None]:
    """Make a file bad by changing the first place of a text in it."""

    def change(folder: Path) -> None:
        text = (folder / name).read_text(encoding="utf-8")
        assert old in text
        (folder / name).write_text(text.replace(old, new, 1), encoding="utf-8")

    return change


def cell(row: int, column: str, value: str) -> Callable[[Path], None]:
    """Make a text-form record bad in one cell."""

    def change(folder: Path) -> None:
        path = folder / "text.csv"
        rows = [line.split(",") for line in path.read_text(encoding="utf-8").splitlines()]
        rows[row][rows[0].index(column)] = value
        path.write_text("\n".join(map(",".join, rows)) + "\n", encoding="utf-8")

    return change


def second_circle(name: str) -> Callable[[Path], None]:
    """Append the only circle of a file once more."""

    def change(folder: Path) -> None:
        text = (folder / name).read_text(encoding="utf-8")
        (folder / name).write_text(text + text[text.index("[[circle]]") :], encoding="utf-8")

    return change


def nothing(folder: Path) -> None:
    """Leave all files good: the command line itself is bad."""


OWN_ID = "circle[1].id: 0 (expected an id of its own: circle[0] has this one)"
MEASURE, DIAGNOSE = "hexdbb-run --plan plan.toml -o new.parquet", "hexdbb diagnose text.csv -m new.toml"
COMPARE = "hexdbb compare run.parquet -m model.toml"
NEVER_REACHED = "(expected every pose within reach and travel)"

BAD = {
    "unknown key, plan": (
        replacing("plan.toml", "laps =", "lapz ="),
        MEASURE,
        "plan.toml: lapz: unknown key (expected laps)",
    ),
    "unknown key, machine": (
        replacing("machine.toml", "min_gap_mm", "gap_mm"),
        "hexdbb model new machine.toml -o new.toml",
        "machine.toml: sliders.gap_mm: unknown key (expected min_gap_mm)",
    ),
    "unknown key, measurement": (
        replacing("text.toml", "noise_um", "nose_um"),
        DIAGNOSE,
        "text.toml: gauge.nose_um: unknown key (expected noise_um)",
    ),
    "unknown key, model": (
        replacing("model.toml", 'name = "leg_length"', 'effect_name = "leg_length"'),
        COMPARE,
        "model.toml: effect[0].effect_name: unknown key (expected one of name, learned, parameter)",
    ),
    "unit of a key": (
        replacing("plan.toml", "radius_mm = 100.0", "radius_um = 100000.0"),
        MEASURE,
        "plan.toml: circle[0].radius_um: unknown key (expected radius_mm: the unit is part of the key)",
    ),
    "unit of a column": (
        replacing("text.csv", "s4_mm", "s4_um"),
        DIAGNOSE,
        "text.csv: column s4_um (expected s4_mm: the unit is part of the name)",
    ),
    "unit of a model's value": (
        replacing("model.toml", 'unit = "um"', 'unit = "mm"'),
        COMPARE,
        "model.toml: effect[0].parameter[0]: 1 longer mm (expected 1 longer um)",
    ),
    "unit of a value's size": (
        cell(7, "s1_mm", "170118.8"),
        DIAGNOSE,
        "text.csv: row 7 (line 8): s1_mm: 170118.8 (expected within the travel of the machine's sliders, 20 to 846 mm)",
    ),
    "plan out of reach": (
        replacing("plan.toml", "[0.0, 0.0, 340.0]", "[0.0, 0.0, 500.0]"),
        MEASURE,
        f"plan.toml: circle 0, 753.98 mm/min, direction -1, arc at 0.00 deg: unreachable: a leg is too short"
        f" {NEVER_REACHED}",
    ),
    "plan out of reach, checked": (
        replacing("plan.toml", "[0.0, 0.0, 340.0]", "[0.0, 0.0, 500.0]"),
        "hexdbb plan check plan.toml",
        NEVER_REACHED,
    ),
    "plan too fast": (
        replacing("plan.toml", "[753.98]", "[75398.0]"),
        MEASURE,
        "mm/s (expected at most 250 mm/s)",
    ),
    "missing column": (
        replacing("text.csv", "reading_um", "measured"),
        DIAGNOSE,
        "text.csv: missing column reading_um (columns present: t_s, ",
    ),
    "NaN": (
        cell(9, "reading_um", "nan"),
        DIAGNOSE,
        "text.csv: row 9 (line 10): reading_um: nan (expected a finite number)",
    ),
    "time that stands still": (
        cell(9, "t_s", "0.0"),
        DIAGNOSE,
        "text.csv: row 9 (line 10): t_s: 0 (expected a time after ",
    ),
    "two circles of one id, plan": (second_circle("plan.toml"), MEASURE, f"plan.toml: {OWN_ID}"),
    "two circles of one id, measurement": (second_circle("text.toml"), DIAGNOSE, f"text.toml: {OWN_ID}"),
    "record and model of two machines": (
        replacing("model.toml", "length_mm = 400.0", "length_mm = 410.0"),
        "hexdbb diagnose run.parquet -m model.toml",
        "model.toml: legs.length_mm: 410 (expected 400, as in run.parquet: they do not belong together)",
    ),
    "record and model of two machines, compared": (
        replacing("model.toml", "length_mm = 400.0", "length_mm = 410.0"),
        COMPARE,
        "model.toml: legs.length_mm: 410 (expected 400, as in run.parquet: they do not belong together)",
    ),
    "bus that is not there": (
        nothing,
        f"{MEASURE} --bus socketcand:127.0.0.1:9",
        "--bus socketcand:127.0.0.1:9: cannot be opened: ",
    ),
    "bus of no kind": (
        nothing,
        f"{MEASURE} --bus nonsense:0",
        "--bus nonsense:0: cannot be parsed (expected interface:",
    ),
    "no such record": (nothing, "hexdbb diagnose none.parquet -m model.toml", "none.parquet: no such file"),
    "no such model": (nothing, "hexdbb compare run.parquet -m none.toml", "none.toml: no such model (expected "),
    "no such plan": (
        nothing,
        "hexdbb-run --plan none -o new.parquet",
        "none: no such file (expected a plan file, or a shipped plan: standard, thesis)",
    ),
    "nowhere to write a model": (
        nothing,
        "hexdbb diagnose run.parquet -m none/model.toml",
        "none/model.toml: no such directory none",
    ),
    "nowhere to write a record": (
        nothing,
        "hexdbb-run --plan plan.toml -o none/new.parquet",
        "none/new.parquet: no such directory none",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_line_and_status_2_and_nothing_is_written(folder: Path, case: str) -> None:
    spoil, line, message = BAD[case]
    spoil(folder)
    before = contents(folder)
    done = run(folder, line)
    assert (done.returncode, done.stdout) == (2, ""), done.stderr
    (error,) = [each for each in done.stderr.splitlines() if not re.search("new model of|^warning: ", each)]
    assert error.startswith("error: ")
    assert message in error
    assert contents(folder) == before


def test_the_good_files_these_were_made_of_are_accepted(folder: Path) -> None:
    assert load_plan(str(folder / "plan.toml")).machine_file().name.startswith("SP-120")
    assert run(folder, "hexdbb plan check plan.toml").returncode == 0
    assert run(folder, f"{COMPARE} --no-plot").returncode == 0
    assert run(folder, "hexdbb convert text.csv new.parquet").returncode == 0
    assert np.array_equal(sorted(contents(folder)), sorted({*contents(folder), folder / "new.parquet"}))
