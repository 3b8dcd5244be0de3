"""Machine files: dimensions, limits, CAN set-up of the axes."""

from hexdbb.machine.can_setup import CanSetup, Limits
from hexdbb.machine.dimensions import Base, Legs, Platform, Sliders
from hexdbb.machine.file import MachineFile, load_machine, machine_beside, shipped_machine
from hexdbb.machine.home import home_heights_mm
from hexdbb.machine.limits_of_use import Joints, Workspace
from hexdbb.machine.shipped import SHIPPED_MACHINE, shipped, shipped_names, shipped_or_own
from hexdbb.machine.tolerance import Tolerance
from hexdbb.machine.watch import Watch

__all__ = [
    "SHIPPED_MACHINE",
    "Base",
    "CanSetup",
    "Joints",
    "Legs",
    "Limits",
    "MachineFile",
    "Platform",
    "Sliders",
    "Tolerance",
    "Watch",
    "Workspace",
    "home_heights_mm",
    "load_machine",
    "machine_beside",
    "shipped",
    "shipped_machine",
    "shipped_names",
    "shipped_or_own",
]
