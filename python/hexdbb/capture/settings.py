"""What every node is told before motion: a table of objects, values, and what follows where a device lacks one.

Source: CiA 301 (1006h, 1016h, 1017h, 1400h:05), CiA 402 (6007h, 605Ah, 6060h, 6065h, 6066h, 607Dh, 60C2h), CiA 404
(6131h).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from hexdbb.capture.cia402 import CYCLIC_SYNCHRONOUS_POSITION
from hexdbb.capture.pdo import DRIVE_RPDO, DRIVE_TPDO, GAUGE_TPDO, NOT_VALID, SYNCHRONOUS, PdoLayout
from hexdbb.capture.sdo import RemoteDevice, name
from hexdbb.errors import InputError, RunError
from hexdbb.machine import MachineFile

CONTROLLER_NODE = 127
QUICK_STOP_AND_STAY = 6
"""605Ah: slow down on the quick stop ramp and stay in quick stop active, position held."""
ABORT_CONNECTION_QUICK_STOP = 3
"""6007h: quick stop when the connection is lost."""
FOLLOWING_ERROR_TIME_MS = 10
MAX_COUNTS = 2**31 - 1
MICROMETRE = 0xFA010000
"""Unit of CiA 303-2: prefix 10^-6, metre."""


@dataclass(frozen=True)
class Setting:
    """One value a node must hold: where, what, and what it means where the device has no such object."""

    index: int
    subindex: int
    value: int
    without: str
    required: bool = False


@dataclass(frozen=True)
class Expected:
    """One value a node must already hold, not written."""

    index: int
    subindex: int
    value: int
    meaning: str


GAUGE_UNIT = Expected(0x6131, 1, MICROMETRE, "micrometre")


def drive_settings(machine: MachineFile, cycle_s: float) -> list[Setting]:
    """Settings of a drive, for this machine's travel and limits and this cycle time."""
    can, scale = machine.can_setup, machine.can_setup.counts_per_mm
    low, high = sorted(round(s * scale) for s in machine.sliders.travel_mm)
    period, exponent = interpolation_period(cycle_s)
    window = round(can.limits.following_error_mm * abs(scale))
    return [
        *communication_settings(machine, cycle_s),
        Setting(0x6007, 0, ABORT_CONNECTION_QUICK_STOP, "it does what its maker chose when the connection is lost"),
        Setting(0x605A, 0, QUICK_STOP_AND_STAY, "it stops as its maker chose"),
        Setting(0x6065, 0, window, "following error is watched by the controller alone"),
        Setting(0x6066, 0, FOLLOWING_ERROR_TIME_MS, "it reports a following error after a time of its own"),
        Setting(0x607D, 1, low, "the lower end of travel is watched by the controller alone"),
        Setting(0x607D, 2, high, "the upper end of travel is watched by the controller alone"),
        Setting(0x60C2, 1, period, "it interpolates over a time of its own"),
        Setting(0x60C2, 2, exponent, "it interpolates over a time of its own"),
        Setting(0x6060, 0, CYCLIC_SYNCHRONOUS_POSITION, "it cannot be driven by cyclic targets", required=True),
    ]


def communication_settings(machine: MachineFile, cycle_s: float) -> list[Setting]:
    """Settings of every node: SYNC period, heartbeats both ways."""
    can = machine.can_setup
    watched = CONTROLLER_NODE << 16 | can.heartbeat_consumer_ms
    return [
        Setting(0x1006, 0, round(cycle_s * 1e6), "it does not know the SYNC period"),
        Setting(0x1016, 1, watched, "it does not notice when the controller is gone"),
        Setting(0x1017, 0, can.heartbeat_producer_ms, "its loss is noticed by missing process data alone"),
    ]


def interpolation_period(cycle_s: float) -> tuple[int, int]:
    """Express a cycle time as object 60C2h holds it: units of 10^exponent s, at most 255 of them.

    Raises
    ------
    InputError
        No such pair gives the cycle time.
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
    """Raise `InputError` where the travel, in counts, does not fit the 32 bits of object 607Ah."""
    scale = machine.can_setup.counts_per_mm
    for end_mm in machine.sliders.travel_mm:
        if abs(end_mm * scale) > MAX_COUNTS:
            raise InputError(
                f"{machine.path or machine.name}: can.counts_per_mm: {scale:g} "
                f"(expected at most {MAX_COUNTS / abs(end_mm):.0f}: {end_mm:g} mm must fit 32 bits)"
            )


def apply(device: RemoteDevice, settings: Iterable[Setting]) -> Iterator[str]:
    """Write settings, read each back, and yield what a missing object means.

    Raises
    ------
    RunError
        A required object is missing, or a node does not take a value.
    """
    for setting in settings:
        if device.has(setting.index, setting.subindex):
            device.write(setting.index, setting.subindex, setting.value)
            continue
        note = (
            f"{device.label}: no object {name(setting.index, setting.subindex)} in {device.eds.name}: {setting.without}"
        )
        if setting.required:
            raise RunError(note)
        yield note


def expect(device: RemoteDevice, expected: Expected) -> None:
    """Read a value that must be there already.

    Raises
    ------
    RunError
        It is another.
    """
    found = int(device.read(expected.index, expected.subindex))
    if found != expected.value:
        raise RunError(
            f"{device.label}: object {name(expected.index, expected.subindex)} is {found:X}h "
            f"(expected {expected.value:X}h, {expected.meaning})"
        )


def map_pdo(device: RemoteDevice, layout: PdoLayout, deadline_ms: int | None = None) -> Iterator[str]:
    """Set one PDO up in the order CiA 301 asks for, and read everything back; `deadline_ms` goes to sub-index 5.

    Raises
    ------
    RunError
        The node refuses or reads back another value.
    """
    cob_id = layout.cob_id(device.node_id)
    device.send(layout.communication, 1, cob_id | NOT_VALID)
    device.write(layout.communication, 2, SYNCHRONOUS)
    device.send(layout.mapping, 0, 0)
    for subindex, mapped in enumerate(layout.objects, start=1):
        device.write(layout.mapping, subindex, mapped.entry)
    device.write(layout.mapping, 0, len(layout.objects))
    if deadline_ms is not None:
        without = "it does not notice when targets stay out"
        yield from apply(device, [Setting(layout.communication, 5, deadline_ms, without)])
    device.write(layout.communication, 1, cob_id)


def configure_drive(device: RemoteDevice, machine: MachineFile, cycle_s: float) -> Iterator[str]:
    """Tell a drive everything; yields notes on what it lacks."""
    yield from apply(device, drive_settings(machine, cycle_s))
    yield from map_pdo(device, DRIVE_RPDO, machine.can_setup.rpdo_timeout_ms)
    yield from map_pdo(device, DRIVE_TPDO)


def configure_gauge(device: RemoteDevice, machine: MachineFile, cycle_s: float) -> Iterator[str]:
    """Tell the gauge everything, and check that it speaks micrometres; yields notes on what it lacks."""
    expect(device, GAUGE_UNIT)
    yield from apply(device, communication_settings(machine, cycle_s))
    yield from map_pdo(device, GAUGE_TPDO)
