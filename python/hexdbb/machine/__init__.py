"""Machine files: dimensions, limits, CAN set-up of the axes."""

from hexdbb.machine.can_setup import CanSetup, Limits
from hexdbb.machine.file import (
    Base,
    Legs,
    MachineFile,
    Platform,
    Sliders,
    load_machine,
    machine_beside,
    shipped_machine,
)
from hexdbb.machine.shipped import SHIPPED_MACHINE, shipped
from hexdbb.machine.tolerance import Tolerance
from hexdbb.machine.watch import Watch

__all__ = [
    "SHIPPED_MACHINE",
    "Base",
    "CanSetup",
    "Legs",
    "Limits",
    "MachineFile",
    "Platform",
    "Sliders",
    "Tolerance",
    "Watch",
    "load_machine",
    "machine_beside",
    "shipped",
    "shipped_machine",
]
