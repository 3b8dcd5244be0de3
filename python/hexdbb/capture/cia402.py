"""The state machine of a CiA 402 drive as the controller sees it: state from the statusword, controlwords to enable.

The simulated drive has an implementation of its own (`hexdbb.rig.cia402`), so that an error in one of them shows as a
disagreement.
Source: CiA 402-2 (IEC 61800-7-201): statusword 6041h bits 0-6, controlword 6040h commands, mode 6060h.
"""

from __future__ import annotations

import enum

CYCLIC_SYNCHRONOUS_POSITION = 8
"""Mode of operation in objects 6060h and 6061h."""

FOLLOWING_ERROR = 1 << 13
INTERNAL_LIMIT = 1 << 11
FOLLOWS_COMMAND = 1 << 12
"""Statusword bit in cyclic synchronous position mode: the drive follows the target position."""
HOMED = 1 << 15
"""Statusword bit: position referenced to home; the profile leaves bit 15 to the manufacturer."""


class DriveState(enum.Enum):
    """States of the drive as (mask, value) of the statusword."""

    NOT_READY = (0x4F, 0x00)
    SWITCH_ON_DISABLED = (0x4F, 0x40)
    READY_TO_SWITCH_ON = (0x6F, 0x21)
    SWITCHED_ON = (0x6F, 0x23)
    OPERATION_ENABLED = (0x6F, 0x27)
    QUICK_STOP_ACTIVE = (0x6F, 0x07)
    FAULT_REACTION = (0x4F, 0x0F)
    FAULT = (0x4F, 0x08)

    @property
    def label(self) -> str:
        """Name as the profile writes it."""
        return self.name.lower().replace("_", " ")


class Command(enum.IntEnum):
    """Controlwords."""

    DISABLE_VOLTAGE = 0x00
    QUICK_STOP = 0x02
    SHUTDOWN = 0x06
    SWITCH_ON = 0x07
    ENABLE_OPERATION = 0x0F
    FAULT_RESET = 0x80


ENABLE_SEQUENCE = (
    (Command.SHUTDOWN, DriveState.READY_TO_SWITCH_ON),
    (Command.SWITCH_ON, DriveState.SWITCHED_ON),
    (Command.ENABLE_OPERATION, DriveState.OPERATION_ENABLED),
)
"""Commands in order, each with the state it leads to (transitions 2, 3 and 4)."""


def state_of(statusword: int) -> DriveState:
    """Return the state coded in a statusword (6041h); an undefined pattern counts as not ready."""
    for state in DriveState:
        mask, value = state.value
        if statusword & mask == value:
            return state
    return DriveState.NOT_READY
