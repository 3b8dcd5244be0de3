"""`hexdbb-run` with slaves that are not ours: a generic CiA 301 stack as six drives and a gauge."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tests.foreign.stack import foreign_nodes, why_not

from hexdbb.machine import shipped_machine
from hexdbb.record import TARGET_COLUMNS, read_record
from hexdbb.rig.bus import start_sliders_mm
from hexdbb.rig.geometry import rotation_rpy
from hexdbb.rig.truth import random_truth

# `make foreign` installs the stack and says so: a test that is skipped all the same would not be noticed there.
MUST_RUN = os.environ.get("HEXDBB_FOREIGN") == "ON"
pytestmark = pytest.mark.skipif(why_not() is not None and not MUST_RUN, reason=str(why_not()))

ABSENT = [word for node in range(1, 8) for word in ("--fault", f"node-missing:{node}")]
"""The rig serves the bus only."""


def start_counts() -> list[int]:
    """Positions of the drives with the platform at its start pose."""
    machine, start = shipped_machine(), random_truth(0).start
    rotation = rotation_rpy(*np.radians(start.rpy_deg))
    sliders_mm = start_sliders_mm(machine, np.array(start.position_mm), rotation)
    return [round(slider_mm * machine.can_setup.counts_per_mm) for slider_mm in sliders_mm]


def test_a_stack_that_is_not_ours_runs_the_test(
    start_rig: Callable[..., object], run: Callable[..., subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    with start_rig(*ABSENT) as rig, foreign_nodes(int(rig.address.rpartition(":")[2]), start_counts(), tmp_path):
        done = run("--bus", rig.bus, "--yes")
    assert done.returncode == 0, done.stderr
    assert "EMCY" not in (tmp_path / "nodes.log").read_text()
    record = read_record(tmp_path / "run.parquet")
    assert record.complete
    targets = np.column_stack([record.columns[name] for name in TARGET_COLUMNS])
    assert np.abs(record.sliders_mm - targets).max() <= 0.5 / shipped_machine().can_setup.counts_per_mm * (1 + 1e-6)
    assert len(np.unique(record.columns["reading_um"])) > len(record) / 2
