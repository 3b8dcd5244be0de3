"""The record of a run, from `hexdbb-run` through real CAN frames to the file: pairing, angles, times, both paces."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from datetime import date
from pathlib import Path

import numpy as np
import pytest
from tests.programs import called
from tests.python.capture.conftest import EXACT, PLAN

from hexdbb.plan import Conditions
from hexdbb.record import TARGET_COLUMNS, Record, read_record

Run = Callable[..., subprocess.CompletedProcess[str]]
RATE_HZ = 50.0
FEED_MM_S = 150.0
HALF_A_COUNT_MM = 0.5 / 10000.0


def recorded(done: subprocess.CompletedProcess[str], tmp_path: Path) -> Record:
    assert done.returncode == 0, done.stderr
    return read_record(tmp_path / "run.parquet")


@pytest.fixture(scope="module")
def ideal(tmp_path_factory: pytest.TempPathFactory) -> Record:
    """Return the record of the small plan on a machine without errors."""
    folder = tmp_path_factory.mktemp("ideal")
    (folder / "plan.toml").write_text(PLAN)
    (folder / "truth.toml").write_text(EXACT)
    words = ("--plan", "plan.toml", "--rate", RATE_HZ, "--truth", "truth.toml", "-o", "run.parquet")
    return recorded(called("hexdbb-run", *words, folder=folder), folder)


def test_exact_machine_stands_at_its_targets_and_reads_zero(ideal: Record) -> None:
    record = ideal
    targets = np.column_stack([record.columns[name] for name in TARGET_COLUMNS])
    # One SYNC of wrong pairing would be 1.5 mm of feed; half a count is the encoder's rounding.
    assert np.abs(record.sliders_mm - targets).max() <= HALF_A_COUNT_MM * (1 + 1e-6)
    assert np.abs(record.reading_mm).max() < 6 * HALF_A_COUNT_MM


def test_columns_of_one_lap(ideal: Record) -> None:
    record, columns = ideal, ideal.columns
    n = len(record)
    assert n == int(2 * np.pi * 100.0 / FEED_MM_S * RATE_HZ) + 1
    assert np.diff(columns["t_s"]) == pytest.approx(1.0 / RATE_HZ)
    assert columns["angle_deg"] == pytest.approx(np.degrees(np.arange(n) * FEED_MM_S / RATE_HZ / 100.0), abs=1e-6)
    for name, value in {"circle": 0, "sweep": 0, "lap": 0, "direction": 1, "status": 0, "feed_mm_min": 9000}.items():
        assert set(columns[name]) == {value}, name
    assert record.complete
    assert record.metadata["cycle_rate_hz"] == RATE_HZ


def test_same_seed_same_record_and_the_next_command(run: Run, tmp_path: Path) -> None:
    first = run("--seed", 5)
    record = recorded(first, tmp_path)
    path = tmp_path / "run.parquet"
    assert first.stdout.splitlines()[-1] == f"next: hexdbb diagnose {path} -m {path.with_suffix('')}-model.toml"
    refused = run("--seed", 5)
    assert refused.returncode == 2
    assert refused.stderr.startswith(f"error: {path}: exists already")
    said = ("--operator", "A. <b>", "--note", "one", "--note", "two", "--temperature-c", 21.5)
    said += ("--machine-serial", "SP-3", "--gauge-serial", "QC-17", "--gauge-calibrated", "2026-03-01")
    again = recorded(run("--seed", 5, "--overwrite", *said), tmp_path)
    assert again.content_hash() == record.content_hash()
    assert again.conditions == Conditions(operator="A. <b>", notes="one\ntwo", temperature_c=21.5)
    assert (again.gauge.serial_number, again.gauge.calibrated) == ("QC-17", date(2026, 3, 1))
    assert again.machine.serial_number == "SP-3"
    assert record.conditions == Conditions()
    other = recorded(run("--seed", 6, "--overwrite"), tmp_path)
    assert other.content_hash() != record.content_hash()


BUSY = ("planned samples are missing", "controller: stalled")
"""How a run in real time may end on a computer that does other work: too many samples lost, or too long a stall."""
ATTEMPTS = 3


def test_real_time_and_lockstep_give_the_same_samples(run: Run, tmp_path: Path) -> None:
    slow = ("--seed", 5, "--rate", 25, "--overwrite")
    lockstep = recorded(run(*slow), tmp_path).columns
    rows = {place: row for row, place in enumerate(zip(lockstep["sweep"], lockstep["angle_deg"], strict=True))}
    common: list[int] = []
    for _ in range(ATTEMPTS):
        done = run(*slow, "--realtime")
        assert done.returncode == 0 or any(words in done.stderr for words in BUSY), done.stderr
        paced = read_record(tmp_path / "run.parquet").columns
        # On a busy computer answers may come late; such rows are left out and take a cycle more, none is another.
        common = [rows[place] for place in zip(paced["sweep"], paced["angle_deg"], strict=True)]
        for name, values in paced.items():
            if name not in ("status", "t_s"):
                assert np.array_equal(values, lockstep[name][common]), name
        if len(common) > len(rows) / 2:
            break
    assert len(common) > len(rows) / 2


def test_every_mount_is_announced_to_the_gauge(run: Run, plan: Path, exact: Path, tmp_path: Path) -> None:
    mounts = "[[mount]]\nid = 0\ncup_mm = [0, 0, 340]\n[[mount]]\nid = 1\ncup_mm = [8, -5, 345]\n"
    circles = "".join(
        f"[[circle]]\nid = {k}\nmount = {k}\nradius_mm = 100\nball_offset_mm = {offset}\nfeeds_mm_min = [7500]\n"
        for k, offset in enumerate(([0, 0, 60], [3, 0, 55]))
    )
    head = [line for line in plan.read_text().splitlines() if not line.startswith(("mount", "circle"))]
    plan.write_text("\n".join([*head, mounts, circles]))
    record = recorded(run("--truth", exact), tmp_path)
    assert set(record.columns["circle"]) == {0, 1}
    assert np.abs(record.reading_mm).max() < 6 * HALF_A_COUNT_MM


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--bus", "socketcand:127.0.0.1:1"], "--bus socketcand:127.0.0.1:1: cannot be opened: "),
        (["--bus", "can0"], "--bus can0: cannot be parsed (expected interface:channel"),
        (["--rate", "700"], "cycle rate 700 Hz at 1e+06 bit/s: bus load 112%"),
        (["--rate", "333"], "cycle rate 333 Hz: the period 3.003 ms does not fit object 60C2h"),
        (["--plan", "no-such-plan"], "no-such-plan: no such file"),
        (["--truth", "no-such-truth.toml"], "the simulated rig did not start: no-such-truth.toml: "),
        (["--fault", "no-such-fault"], "the simulated rig did not start: --fault no-such-fault: "),
        (["--bus", "socketcan:can0", "--seed", "1"], "--seed: option of the simulated rig"),
    ],
)
def test_wrong_use_is_one_line_and_leaves_nothing(words: list[str], said: str, run: Run, tmp_path: Path) -> None:
    done = run(*words)
    assert done.returncode == 2, done.stderr
    message = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert len(message) == 1
    assert message[0].startswith(f"error: {said}")
    assert list(tmp_path.glob("run*")) == []


def test_plan_out_of_reach_is_refused_before_a_bus_is_looked_for(run: Run, plan: Path, tmp_path: Path) -> None:
    plan.write_text(plan.read_text().replace("ball_offset_mm", "platform_rpy_deg = [40, 0, 0], ball_offset_mm"))
    done = run("--bus", "socketcand:127.0.0.1:1")
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: {plan}: circle 0, 9000 mm/min, direction +1, arc at ")
    assert list(tmp_path.glob("run*")) == []
