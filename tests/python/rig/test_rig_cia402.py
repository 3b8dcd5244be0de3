"""The CiA 402 state machine: the standard's transitions, its coding, and nothing else."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hexdbb.rig.cia402 import TRANSITIONS, Command, DriveState, decode, next_state

# CiA 402-2: number, from, controlword that makes it, to.
STANDARD = [
    (2, DriveState.SWITCH_ON_DISABLED, 0x06, DriveState.READY_TO_SWITCH_ON),
    (3, DriveState.READY_TO_SWITCH_ON, 0x07, DriveState.SWITCHED_ON),
    (4, DriveState.SWITCHED_ON, 0x0F, DriveState.OPERATION_ENABLED),
    (5, DriveState.OPERATION_ENABLED, 0x07, DriveState.SWITCHED_ON),
    (6, DriveState.SWITCHED_ON, 0x06, DriveState.READY_TO_SWITCH_ON),
    (7, DriveState.READY_TO_SWITCH_ON, 0x00, DriveState.SWITCH_ON_DISABLED),
    (7, DriveState.READY_TO_SWITCH_ON, 0x02, DriveState.SWITCH_ON_DISABLED),
    (8, DriveState.OPERATION_ENABLED, 0x06, DriveState.READY_TO_SWITCH_ON),
    (9, DriveState.OPERATION_ENABLED, 0x00, DriveState.SWITCH_ON_DISABLED),
    (10, DriveState.SWITCHED_ON, 0x00, DriveState.SWITCH_ON_DISABLED),
    (10, DriveState.SWITCHED_ON, 0x02, DriveState.SWITCH_ON_DISABLED),
    (11, DriveState.OPERATION_ENABLED, 0x02, DriveState.QUICK_STOP_ACTIVE),
    (12, DriveState.QUICK_STOP_ACTIVE, 0x00, DriveState.SWITCH_ON_DISABLED),
    (16, DriveState.QUICK_STOP_ACTIVE, 0x0F, DriveState.OPERATION_ENABLED),
]


@pytest.mark.parametrize(("number", "source", "controlword", "target"), STANDARD)
def test_transition(number, source, controlword, target):
    assert next_state(source, controlword) is target
    command = decode(controlword)
    assert command is not None
    assert TRANSITIONS[source, command] == (number, target)


def test_table_has_the_standards_numbers_and_no_others():
    assert {number for number, _ in TRANSITIONS.values()} == {*range(2, 13), 16}


def test_no_command_leaves_a_fault_or_wakes_a_disabled_drive():
    for word in range(0x10000):
        assert next_state(DriveState.FAULT, word) is None
        assert next_state(DriveState.FAULT_REACTION_ACTIVE, word) is None
        assert next_state(DriveState.SWITCH_ON_DISABLED, word) in (None, DriveState.READY_TO_SWITCH_ON)


def test_status_coding_is_unique():
    assert all(state.value & ~0x006F == 0 for state in DriveState)
    assert len({state.value for state in DriveState}) == len(DriveState)


@given(word=st.integers(0, 0xFFFF))
def test_decoding_looks_at_the_low_bits_alone_and_never_enables_by_accident(word):
    command = decode(word)
    assert command is decode(word & 0x0F)
    assert (command is Command.ENABLE_OPERATION) == (word & 0x0F == 0x0F)
    if not word & 0x02:
        assert command is Command.DISABLE_VOLTAGE
