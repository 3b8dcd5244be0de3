"""`hexdbb plan check`: reach and limits of a plan, for people and for programs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from hexdbb.cli.plan import command
from hexdbb.errors import InputError


def test_shipped_plan_is_within_reach_and_limits() -> None:
    done = CliRunner().invoke(command, ["check", "thesis", "--json"], catch_exceptions=False)
    told = json.loads(done.stdout)
    assert told["reachable"]
    assert told["bus_load"] == pytest.approx(0.4)
    assert [(run["circle"], run["direction"], run["samples"]) for run in told["runs"]] == [
        (0, -1, 12501),
        (0, 1, 12501),
    ]
    for run in told["runs"]:
        assert 0 < run["velocity_mm_s"] < 250
        assert 0 < run["acceleration_mm_s2"] < 2500
        assert run["to_end_of_travel_mm"] > 0
        assert run["to_min_gap_mm"] > 0


def test_table_fits_eighty_columns() -> None:
    done = CliRunner().invoke(command, ["check", "thesis"], catch_exceptions=False, env={"COLUMNS": "80"})
    assert done.exit_code == 0
    assert "753.98" in done.stdout
    assert "…" not in done.stdout


def test_plan_out_of_reach_says_so_in_both_forms(plan: Path) -> None:
    plan.write_text(plan.read_text().replace("ball_offset_mm", "platform_rpy_deg = [40, 0, 0], ball_offset_mm"))
    done = CliRunner().invoke(command, ["check", str(plan), "--json"])
    assert isinstance(done.exception, InputError)
    told = json.loads(done.stdout)
    assert told["reachable"] is False
    assert told["reason"] == str(done.exception)
    assert told["reason"].startswith(f"{plan}: circle 0, 9000 mm/min, direction +1, arc at ")
