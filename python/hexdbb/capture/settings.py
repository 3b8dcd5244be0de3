"""Settings written to every node before motion: objects, values, and the consequence if a device lacks an object.

Source: CiA 301 (1006h, 1016h, 1017h, 1400h:05), CiA 402 (6007h, 605Ah, 6060h, 6065h, 6066h, 607Dh, 60C2h), CiA 404
(6131h), CiA 303-2 (unit codes).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from hexdbb.capture.cia402 import CYCLIC_SYNCHRONOUS_POSITION
from hexdbb.capture.pdo import DRIVE_RPDO
from hexdbb.capture.sdo import RemoteDevice, name
from hexdbb.errors import InputError, RunError
from hexdbb.machine import MachineFile

CONTROLLER_NODE = 127
"""Node id in the heartbeat of the controller: the highest, so that it collides with no device."""
QUICK_STOP_AND_STAY = 6
"""Value of 605Ah: slow down on the quick stop ramp and stay in quick stop active, position held."""
ABORT_CONNECTION_QUICK_STOP = 3
"""Value of 6007h: quick stop when the connection is lost."""
FOLLOWING_ERROR_TIME_MS = 10
"""Value of 6066h: time outside the window 6065h before the drive trips, ms; two to three cycles at 250 Hz, so that one
late target does not trip it."""
MAX_COUNTS = 2**31 - 1
"""Largest INTEGER32, the type of 607Ah and 6064h."""
MICROMETRE = 0xFA010000
"""Value of 6131h:01: unit code of CiA 303-2, prefix 10^-6 (FAh), metre (01h)."""


@dataclass(frozen=True)
class Setting:
    """One value that is written to a node.

    Attributes
    ----------
    index, subindex : int
        The object.
    value : int
        Its value.
    without : str
        Consequence if the device has no such object.
    required : bool
        Whether a device without the object is refused.
    """

    index: int
    subindex: int
    value: int
    without: str
    required: bool = False


@dataclass(frozen=True)
class Expected:
    """One value that a node must already have, and that is not written.

    Attributes
    ----------
    index, subindex : int
        The object.
    value : int
        Its value.
    meaning : str
        The value in words.
    without : str
        Consequence if the device has no such object.
    """

    index: int
    subindex: int
    value: int
    meaning: str
    without: str


GAUGE_UNIT = Expected(0x6131, 1, MICROMETRE, "micrometre", "the unit of its readings is not known")


def drive_settings(machine: MachineFile, cycle_s: float, timed: bool = True, slider: int = 1) -> list[Setting]:
    """Return the settings of a drive.

    Parameters
    ----------
    machine : MachineFile
        Travel (mm), encoder scale, limits and supervision times.
    cycle_s : float
        Time from one target to the next, s.
    timed : bool
        Whether SYNC comes once in that time.
    slider : int
        That the drive moves, 1 to 6.

    Raises
    ------
    InputError
        The cycle time does not fit object 60C2h.
    """
    can, scale = machine.can_setup, machine.can_setup.counts_per_mm
    low, high = sorted(round(s * scale) for s in machine.sliders.travels_mm[slider - 1])
    period, exponent = interpolation_period(cycle_s)
    window = round(can.limits.following_error_mm * abs(scale))
    return [
        *communication_settings(machine, cycle_s, timed),
        Setting(0x6007, 0, ABORT_CONNECTION_QUICK_STOP, "it reacts to a lost connection by its factory setting"),
        Setting(0x605A, 0, QUICK_STOP_AND_STAY, "its quick stop follows its factory setting"),
        Setting(0x6065, 0, window, "only the controller supervises the following error"),
        Setting(0x6066, 0, FOLLOWING_ERROR_TIME_MS, "it reports a following error after its factory-set time"),
        Setting(0x607D, 1, low, "only the controller enforces the lower end of travel"),
        Setting(0x607D, 2, high, "only the controller enforces the upper end of travel"),
        Setting(0x60C2, 1, period, "it interpolates over its factory-set time"),
        Setting(0x60C2, 2, exponent, "it interpolates over its factory-set time"),
        Setting(0x6060, 0, CYCLIC_SYNCHRONOUS_POSITION, "it cannot follow cyclic targets", required=True),
    ]


def communication_settings(machine: MachineFile, cycle_s: float, timed: bool = True) -> list[Setting]:
    """Return the settings of every node: SYNC period (1006h), heartbeat consumer (1016h) and producer (1017h).

    In lockstep (not `timed`) SYNC has no period, which is 0: a device that supervises another would report
    communication errors (EMCY 8100h).
    """
    can = machine.can_setup
    period_us = round(cycle_s * 1e6) if timed else 0
    watched = CONTROLLER_NODE << 16 | can.heartbeat_consumer_ms
    return [
        Setting(0x1006, 0, period_us, "it does not know the SYNC period"),
        Setting(0x1016, 1, watched, "it does not detect the loss of the controller"),
        Setting(0x1017, 0, can.heartbeat_producer_ms, "its loss is detected by missing process data only"),
    ]


def rpdo_deadline(deadline_ms: int) -> Setting:
    """Return the setting of a drive's RPDO event timer (1400h:05)."""
    return Setting(DRIVE_RPDO.communication, 5, deadline_ms, "it does not detect missing targets")


def interpolation_period(cycle_s: float) -> tuple[int, int]:
    """Return a cycle time as object 60C2h holds it.

    Parameters
    ----------
    cycle_s : float
        SYNC period, s.

    Returns
    -------
    units, exponent : int
        Period of `units` (1 to 255) times 10^`exponent` s.

    Raises
    ------
    InputError
        No such pair equals the cycle time.
    """
    for exponent in (-3, -4, -5, -6):
        units = cycle_s * 10.0**-exponent
        if abs(units - round(units)) < 1e-6 and 1 <= round(units) <= 255:
            return round(units), exponent
    raise InputError(
        f"cycle rate {1.0 / cycle_s:g} Hz: the period {cycle_s * 1e3:.6g} ms does not fit object 60C2h "
        "(expected a period of 1 to 255 units of 1 ms, 0.1 ms, 0.01 ms or 1 µs, such as 250 Hz)"
    )


def check_counts(machine: MachineFile) -> None:
    """Check that the travel in counts fits the 32 bits of object 607Ah; raises `InputError` otherwise."""
    scale = machine.can_setup.counts_per_mm
    for end_mm in (end for travel in machine.sliders.travels_mm for end in travel):
        if abs(end_mm * scale) > MAX_COUNTS:
            raise InputError(
                f"{machine.path or machine.name}: can.counts_per_mm: {scale:g} "
                f"(expected at most {MAX_COUNTS / abs(end_mm):.0f}: {end_mm:g} mm must fit 32 bits)"
            )


def apply(device: RemoteDevice, settings: Iterable[Setting]) -> Iterator[str]:
    """Write settings and read each back.

    Yields
    ------
    str
        One line for each object that the EDS lacks, or that is read-only with another value, with the consequence.

    Raises
    ------
    RunError
        A required object is missing, or the node refuses a value or reads back another.
    """
    for setting in settings:
        if device.writable(setting.index, setting.subindex):
            device.write(setting.index, setting.subindex, setting.value)
            continue
        place = name(setting.index, setting.subindex)
        if not device.has(setting.index, setting.subindex):
            lack = f"no object {place} in {device.eds.path.name}"
        elif (found := device.read(setting.index, setting.subindex)) != setting.value:
            lack = f"object {place} is {found} and read-only (expected {setting.value})"
        else:
            continue
        note = f"{device.label}: {lack}: {setting.without}"
        if setting.required:
            raise RunError(note)
        yield note


def expect(device: RemoteDevice, expected: Expected) -> None:
    """Check a value that a node must already have.

    Raises
    ------
    RunError
        The value differs.
    """
    found = int(device.read(expected.index, expected.subindex))
    if found != expected.value:
        raise RunError(
            f"{device.label}: object {name(expected.index, expected.subindex)} is {found:X}h "
            f"(expected {expected.value:X}h, {expected.meaning})"
        )
