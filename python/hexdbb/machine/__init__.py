"""The machine: its dimensions, its limits, the CAN set-up of its axes."""

from hexdbb.machine.can_setup import CanSetup, Limits
from hexdbb.machine.file import (
    SHIPPED_MACHINE,
    Base,
    Legs,
    MachineFile,
    Platform,
    Sliders,
    load_machine,
    machine_beside,
    shipped,
    shipped_machine,
)

__all__ = [
    "SHIPPED_MACHINE",
    "Base",
    "CanSetup",
    "Legs",
    "Limits",
    "MachineFile",
    "Platform",
    "Sliders",
    "load_machine",
    "machine_beside",
    "shipped",
    "shipped_machine",
]
