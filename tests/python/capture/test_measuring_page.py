"""docs/measuring.md against the code: its timeouts, limits and checks are those of the controller."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hexdbb.capture.bus_load import MAX_LOAD
from hexdbb.capture.checks import CHECKS
from hexdbb.capture.clock import Deadlines, Lockstep
from hexdbb.capture.motion import STEP_TIMEOUT_S, STOP_TIMEOUT_S
from hexdbb.capture.sdo import SDO_TIMEOUT_S, SDO_TRIES
from hexdbb.capture.settings import FOLLOWING_ERROR_TIME_MS
from hexdbb.capture.supervision import SILENT_AFTER
from hexdbb.capture.watch import MAX_MISSED
from hexdbb.machine import shipped_machine

PAGE = (Path(__file__).parents[3] / "docs" / "measuring.md").read_text(encoding="utf-8")
COUNTS = {2: "two", 3: "three", 4: "four"}


def rows(heading: str) -> dict[str, list[str]]:
    """Return the table rows below a heading by their first cell, without emphasis."""
    section = PAGE.partition(f"## {heading}\n")[2].partition("\n## ")[0].replace("**", "")
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in re.findall(r"(?m)^\|.*\|$", section)]
    return {first: rest for first, *rest in cells[2:]}


CAN = shipped_machine().can_setup
LIMITS = CAN.limits


@pytest.mark.parametrize(
    ("row", "default"),
    [
        ("answer to an SDO request", f"{SDO_TIMEOUT_S:g} s, {COUNTS[SDO_TRIES]} tries"),
        (
            "answers to a SYNC: in lockstep, in real time",
            f"{Lockstep().answer_timeout_s():g} s, {4 * Deadlines.ANSWER_SHARE:g}/4 of the cycle",
        ),
        ("unanswered SYNCs of a node", f"{SILENT_AFTER}"),
        (
            "heartbeat of a node or of the controller",
            f"{CAN.heartbeat_producer_ms} ms, lost after {CAN.heartbeat_consumer_ms} ms",
        ),
        (
            "time without a target after which a drive stops on its own; longest stall of the controller",
            f"{CAN.rpdo_timeout_ms} ms",
        ),
        ("missed cycles in one run", f"{MAX_MISSED}"),
        ("following error", f"{LIMITS.following_error_mm:g} mm"),
        ("reading", f"±{LIMITS.gauge_range_um:g} µm"),
        (
            "velocity, acceleration, jerk of a slider",
            f"{LIMITS.velocity_mm_s:g} mm/s, {LIMITS.acceleration_mm_s2:g} mm/s², {LIMITS.jerk_mm_s3:g} mm/s³",
        ),
        ("bus load", f"{100 * MAX_LOAD:g} %"),
    ],
)
def test_timeouts_and_limits_are_those_of_the_code(row: str, default: str) -> None:
    assert rows("Timeouts and limits")[row][0] == default


def test_the_two_times_of_the_drives_are_those_of_the_code() -> None:
    row = rows("Timeouts and limits")["one transition of the drives; quick stop to standstill"]
    assert row[0] == f"{STEP_TIMEOUT_S:g} s each"
    assert STEP_TIMEOUT_S == STOP_TIMEOUT_S
    assert f"for {FOLLOWING_ERROR_TIME_MS} ms in the drive" in rows("Timeouts and limits")["following error"][1]


def test_faults_are_the_checks_in_their_order() -> None:
    assert list(rows("Faults")) == [check.name for check in CHECKS]
