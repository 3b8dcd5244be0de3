"""The display: a live bar with two lines on a terminal, plain lines elsewhere, notes in both."""

from __future__ import annotations

import io
import time

import pytest
from rich.console import Console

from hexdbb.capture.display import LIVE_PERIOD_S, display
from hexdbb.capture.request import RunProgress
from hexdbb.plan import load_plan
from hexdbb.trajectory import Phase, Programme, plan_programme


@pytest.fixture(scope="module")
def programme() -> Programme:
    plan = load_plan("thesis")
    return plan_programme(plan, plan.machine_file(), 0.02, "thesis")


@pytest.mark.parametrize("terminal", [True, False])
def test_display_says_where_the_run_is(terminal: bool, programme: Programme) -> None:
    out = io.StringIO()
    console = Console(file=out, force_terminal=terminal, width=80)
    progress = RunProgress(notes=["node 3 (slider 3): no object 60C2:01"])
    wanted = ["note: node 3 (slider 3): no object 60C2:01", "run 2/2, circle 0, counter-clockwise, 753.98 mm/min: arc"]
    wanted += ["reading +12.5 µm", "ms/cycle, 3 missed"]
    with display(progress, console):
        progress.rows, progress.programme = len(programme), programme
        progress.place = (Phase.ARC, 1)
        progress.row = len(programme) // 2
        progress.stage, progress.reading_um, progress.missed = "moving", 12.5, 3
        end_s = time.monotonic() + 20.0
        while not all(words in out.getvalue() for words in wanted) and time.monotonic() < end_s:
            progress.cycle_index += 25
            # A stage of its own makes the plain display speak at once, as a new run would.
            progress.stage = "moving" if progress.cycle_index % 100 else "waiting"
            time.sleep(LIVE_PERIOD_S)
    for words in wanted:
        assert words in out.getvalue()
    assert ("━" in out.getvalue()) == terminal
