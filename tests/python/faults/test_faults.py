"""No wrong sample is kept and every fault is named: faults on the bus and in the rig, tried in lockstep.

A fault is required to leave no wrong sample in the record, to be named with its node where it stops the run, and to
stop all six axes; `tests.faults.catalogue` holds what else is required of each. `python -m tests.faults` tries them
all.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.faults.catalogue import fault_named
from tests.faults.runs import run
from tests.faults.trials import try_faults

TRIED = (
    "answer lost",
    "answers in another order",
    "answer twice",
    "answer after the next SYNC",
    "answers always 1.25 cycles late",
    "answers too short",
    "position jumps 2.85 mm",
    "reading 60 µm off",
    "reading 60 µm off from then on",
    "homing lost (bit 15)",
    "drive ignores targets (bit 12)",
    "EMCY of two bytes",
    "heartbeat empty",
    "NMT command of one byte",
    "SYNC of another node, once",
    "SYNCs of another node",
    "message that is no frame",
    "flood of other frames, a node silent",
    "gauge frozen",
    "gauge stuck at 0.0",
    "gauge out of range",
)
"""Faults tried in every test run."""


@pytest.mark.parametrize("name", TRIED)
def test_fault_leaves_no_wrong_sample_and_has_its_name(name: str) -> None:
    trial = try_faults([fault_named(name)], lockstep=True, seed=1)
    assert trial.unmet == (), trial.message


def test_what_was_skipped_while_moving_is_noted_in_the_record(tmp_path: Path) -> None:
    done = run(tmp_path, fault_named("message that is no frame").rules(True))
    assert done.fired > 0
    assert done.record is not None
    assert any(
        note.startswith("bus: skipped, message that cannot be parsed: ") for note in done.record.metadata["notes"]
    )
