"""Effects of the user's own: tried in a process of its own, stopped where they do not end."""

from __future__ import annotations

from pathlib import Path

import pytest

import hexdbb as hx
from hexdbb.workbench import Session
from hexdbb.workbench.outputs import write_effects
from hexdbb.workbench.own_code import require_ending

GOOD = """
import numpy as np
from hexdbb import effect

@effect(port="slider", unit="mm", prior_sigma=0.01, elements=6)
def lost_motion(samples):
    "Half the width of a play, by the direction of travel."
    return -0.5 * samples["travel_direction"]
"""
LOOPS_IN_FUNCTION = GOOD.replace("    return", "    while True: pass\n    return")
STARTS_A_CHILD = "import subprocess, sys\nsubprocess.run([sys.executable, '-c', 'import time; time.sleep(600)'])\n"


@pytest.mark.parametrize("source", [LOOPS_IN_FUNCTION, STARTS_A_CHILD])
def test_what_does_not_end_is_stopped(folder: Path, source: str) -> None:
    (folder / "mine.py").write_text(source, encoding="utf-8")
    with pytest.raises(hx.InputError, match=r"mine\.py: did not end and was stopped"):
        require_ending(Path("mine.py"), [Path("today.parquet")], computing_s=4, waiting_s=6.0)


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("x = 1\n", "declares no effect"),
        ("import nonsense\n", r"mine\.py:1: ModuleNotFoundError"),
        (GOOD.replace("travel_direction", "nonsense"), r"mine\.py:\d+: effect lost_motion.*no column 'nonsense'"),
        ("import os\nos._exit(3)\n", "ended the process with status 3"),
    ],
)
def test_what_cannot_be_used_is_refused_with_its_line(folder: Path, source: str, message: str) -> None:
    session = Session([Path("today.parquet")], Path("model.toml"))
    with pytest.raises(hx.InputError, match=message):
        write_effects(session, Path("mine.py"), source)
    assert session.own_effects == []
    assert session.changes.busy == ""


def test_an_effect_of_ones_own_competes_and_is_in_the_script(folder: Path) -> None:
    session = Session([Path("today.parquet")], Path("model.toml"))
    with pytest.raises(hx.InputError, match=r"model\.toml: not written"):
        write_effects(session, Path("model.toml"), GOOD)
    assert write_effects(session, Path("mine.py"), GOOD) == ["lost_motion"]
    session.preview("lost_motion:4")
    assert session.prediction.rms_um < 1.0
    session.add("lost_motion:4")
    assert session.model.ledger[-1].effect == "lost_motion"
    Path("copied.py").write_text(session.script.text, encoding="utf-8")
    assert "hx.load_effects('mine.py')" in session.script.text


def test_a_draft_needs_a_question(folder: Path) -> None:
    with pytest.raises(hx.InputError, match="nothing was asked yet"):
        Session([Path("today.parquet")], Path("model.toml")).drafted()
