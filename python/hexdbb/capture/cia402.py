"""The state machine of a CiA 402 drive: what a statusword says, which controlword leads on.

Source: CiA 402-2 (IEC 61800-7-201), tables of statusword bits 0-6 and of controlword commands.
"""

from __future__ import annotations

import enum

CYCLIC_SYNCHRONOUS_POSITION = 8
"""Mode of operation, objects 6060h and 6061h."""

FOLLOWING_ERROR = 1 << 13
INTERNAL_LIMIT = 1 << 11
FOLLOWS_COMMAND = 1 << 12
HOMED = 1 << 15
"""Position referenced to home; the profile leaves this bit to the manufacturer."""


class State(enum.Enum):
    """States of the drive: (mask, value) of the statusword."""

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
    (Command.SHUTDOWN, State.READY_TO_SWITCH_ON),
    (Command.SWITCH_ON, State.SWITCHED_ON),
    (Command.ENABLE_OPERATION, State.OPERATION_ENABLED),
)
"""Commands in order, each with the state that answers it."""


def state_of(statusword: int) -> State:
    """Return the state a statusword shows; an undefined pattern counts as not ready."""
    for state in State:
        mask, value = state.value
        if statusword & mask == value:
            return state
    return State.NOT_READY
