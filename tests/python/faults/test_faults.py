"""No wrong sample is kept and every fault is named: faults on the bus and in the rig, tried in lockstep.

A fault is required to leave no wrong sample in the record, to be named with its node where it stops the run, and to
stop all six axes; `tests.faults.catalogue` holds what else is required of each. `python -m tests.faults` tries them
all.
"""

from __future__ import annotations

import pytest
from tests.faults.catalogue import fault_named
from tests.faults.trials import try_faults

LATE = "answers are not counted and matched with their SYNC"
SHAPE = "the length of an answer is not checked against its mapping by name"
FRAMES = "the CANopen library raises on frames it does not expect"
BITS = "status bits that must hold in motion are not checked"
PLAUSIBLE = "readings and positions are not checked against what is physically possible"
TEXT = "a message that cannot be parsed stops the run with a traceback in its message"

TRIED = {
    "answer lost": "",
    "answers in another order": "",
    "gauge out of range": "",
    "flood of other frames, a node silent": "a flood of other frames keeps a silent node from being noticed",
    "answer twice": LATE,
    "answer after the next SYNC": LATE,
    "answers always 1.25 cycles late": LATE,
    "SYNC of another node, once": LATE,
    "SYNCs of another node": LATE,
    "gauge frozen": PLAUSIBLE,
    "gauge stuck at 0.0": PLAUSIBLE,
    "position jumps 2.85 mm": PLAUSIBLE,
    "reading 60 µm off": PLAUSIBLE,
    "homing lost (bit 15)": BITS,
    "drive ignores targets (bit 12)": BITS,
    "answers too short": SHAPE,
    "EMCY of two bytes": FRAMES,
    "heartbeat empty": FRAMES,
    "NMT command of one byte": FRAMES,
    "message that is no frame": TEXT,
}
"""Faults tried in every test run; with a reason: the check that is still missing."""


def cases() -> list[object]:
    """Return the names of the faults, those expected to fail with their reason."""
    return [
        pytest.param(name, marks=[pytest.mark.xfail(strict=True, reason=reason)] if reason else [], id=name)
        for name, reason in TRIED.items()
    ]


@pytest.mark.parametrize("name", cases())
def test_fault_leaves_no_wrong_sample_and_has_its_name(name: str) -> None:
    trial = try_faults([fault_named(name)], lockstep=True, seed=1)
    assert trial.unmet == (), trial.message
