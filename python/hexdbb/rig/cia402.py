"""The power drive state machine of CiA 402 as a table.

Model: a controlword is decoded into one command; each row of `TRANSITIONS` maps one state and command to the next
state. A command that skips a state (ready to switch on, then enable operation) passes through the table once per state.
Transitions 13 to 15 (fault, end of its reaction, reset by a rising edge of bit 7) follow from no command and are part
of `DriveNode`.
Source: CiA 402-2, state machine with transitions 0 to 16, coding of controlword 6040h and statusword 6041h.
"""

from __future__ import annotations

from enum import Enum, IntEnum


class DriveState(IntEnum):
    """States; the value is their coding in the statusword (bits 0-3, 5 and 6)."""

    NOT_READY = 0x0000
    SWITCH_ON_DISABLED = 0x0040
    READY_TO_SWITCH_ON = 0x0021
    SWITCHED_ON = 0x0023
    OPERATION_ENABLED = 0x0027
    QUICK_STOP_ACTIVE = 0x0007
    FAULT_REACTION_ACTIVE = 0x000F
    FAULT = 0x0008


VOLTAGE_ENABLED, REMOTE, INTERNAL_LIMIT, FOLLOWS_COMMAND, FOLLOWING_ERROR, HOMED = (
    1 << 4,
    1 << 9,
    1 << 11,
    1 << 12,
    1 << 13,
    1 << 15,
)

FAULT_RESET_BIT, HALT_BIT = 1 << 7, 1 << 8


class Command(Enum):
    """Device control commands as (mask, value) of the controlword, in the order in which they are matched."""

    DISABLE_VOLTAGE = (0x0002, 0x0000)
    QUICK_STOP = (0x0006, 0x0002)
    SHUTDOWN = (0x0007, 0x0006)
    SWITCH_ON = (0x000F, 0x0007)
    ENABLE_OPERATION = (0x000F, 0x000F)


_S, _C = DriveState, Command
TRANSITIONS: dict[tuple[DriveState, Command], tuple[int, DriveState]] = {
    (_S.SWITCH_ON_DISABLED, _C.SHUTDOWN): (2, _S.READY_TO_SWITCH_ON),
    (_S.READY_TO_SWITCH_ON, _C.SWITCH_ON): (3, _S.SWITCHED_ON),
    (_S.READY_TO_SWITCH_ON, _C.ENABLE_OPERATION): (3, _S.SWITCHED_ON),
    (_S.SWITCHED_ON, _C.ENABLE_OPERATION): (4, _S.OPERATION_ENABLED),
    (_S.OPERATION_ENABLED, _C.SWITCH_ON): (5, _S.SWITCHED_ON),
    (_S.SWITCHED_ON, _C.SHUTDOWN): (6, _S.READY_TO_SWITCH_ON),
    (_S.READY_TO_SWITCH_ON, _C.QUICK_STOP): (7, _S.SWITCH_ON_DISABLED),
    (_S.READY_TO_SWITCH_ON, _C.DISABLE_VOLTAGE): (7, _S.SWITCH_ON_DISABLED),
    (_S.OPERATION_ENABLED, _C.SHUTDOWN): (8, _S.READY_TO_SWITCH_ON),
    (_S.OPERATION_ENABLED, _C.DISABLE_VOLTAGE): (9, _S.SWITCH_ON_DISABLED),
    (_S.SWITCHED_ON, _C.DISABLE_VOLTAGE): (10, _S.SWITCH_ON_DISABLED),
    (_S.SWITCHED_ON, _C.QUICK_STOP): (10, _S.SWITCH_ON_DISABLED),
    (_S.OPERATION_ENABLED, _C.QUICK_STOP): (11, _S.QUICK_STOP_ACTIVE),
    (_S.QUICK_STOP_ACTIVE, _C.DISABLE_VOLTAGE): (12, _S.SWITCH_ON_DISABLED),
    (_S.QUICK_STOP_ACTIVE, _C.ENABLE_OPERATION): (16, _S.OPERATION_ENABLED),
}
"""(state, command) -> (number of the transition in CiA 402, next state); other pairs are no transition."""

_COMMANDS: list[Command | None] = [
    next((command for command in Command if word & command.value[0] == command.value[1]), None) for word in range(16)
]


_NEXT: dict[DriveState, list[DriveState | None]] = {
    state: [None if command is None else TRANSITIONS.get((state, command), (0, None))[1] for command in _COMMANDS]
    for state in DriveState
}
"""Next states by bits 0 to 3 of the controlword."""


def decode(controlword: int) -> Command | None:
    """Return the command coded in bits 0 to 3 of a controlword, or None."""
    return _COMMANDS[controlword & 0x0F]


def next_state(state: DriveState, controlword: int) -> DriveState | None:
    """Return the state after one transition, or None if the controlword causes no transition in this state."""
    return _NEXT[state][controlword & 0x0F]
