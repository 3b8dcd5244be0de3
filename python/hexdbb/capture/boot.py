"""Configuration before motion: identify the seven nodes, write their settings, read every setting back.

Nothing moves here.
Source: CiA 301 (NMT commands, device type 1000h, identity 1018h), CiA 402 (supported modes 6502h), CiA 404.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import canopen

from hexdbb.capture.cia402 import CYCLIC_SYNCHRONOUS_POSITION
from hexdbb.capture.configuration import configure_drive, configure_gauge
from hexdbb.capture.fitness import DRIVE_PROFILE, GAUGE_PROFILE, Level, findings
from hexdbb.capture.link import Link
from hexdbb.capture.sdo import RemoteDevice, name
from hexdbb.capture.sync_counter import configure_sync_counter
from hexdbb.errors import InputError, RunError
from hexdbb.machine import MachineFile

NMT_START, NMT_PRE_OPERATIONAL = 0x01, 0x80
"""NMT command specifiers (CiA 301)."""
IDENTITY = {1: "vendor", 2: "product"}
"""Sub-indices of 1018h that are compared with the EDS; 0 in the EDS matches any device (CiA 306)."""


@dataclass(frozen=True)
class Devices:
    """The nodes of the rig.

    Attributes
    ----------
    drives : tuple of RemoteDevice
        Drives of sliders 1 to 6.
    gauge : RemoteDevice
        The ball bar's length gauge.
    """

    drives: tuple[RemoteDevice, ...]
    gauge: RemoteDevice

    def __iter__(self) -> Iterator[RemoteDevice]:
        yield from (*self.drives, self.gauge)


def add_devices(network: Link, machine: MachineFile) -> Devices:
    """Add the nodes of a machine file to a network.

    Parameters
    ----------
    network : Link
        The network of the bus; nothing is sent.
    machine : MachineFile
        Its ``[can]`` section names node ids and EDS files.

    Returns
    -------
    Devices

    Raises
    ------
    InputError
        An EDS does not exist or cannot be parsed.
    """
    can = machine.can_setup
    drives = tuple(
        RemoteDevice(network, node, f"slider {k}", machine.eds_path(eds))
        for k, (node, eds) in enumerate(zip(can.drive_nodes, can.drive_eds, strict=True), start=1)
    )
    return Devices(drives, RemoteDevice(network, can.gauge_node, "gauge", machine.eds_path(can.gauge_eds)))


def refuse_unfit(devices: Devices, machine: MachineFile, cycle_s: float) -> None:
    """Check by the EDS files that every device can run the test; nothing is sent.

    Raises
    ------
    InputError
        One cannot; names the device, its EDS, the object and what that means.
    """
    for device in devices:
        profile = DRIVE_PROFILE if device in devices.drives else GAUGE_PROFILE
        for found in findings(device.eds, profile, machine, cycle_s):
            if found.level is Level.REFUSED:
                line = "" if found.line is None else f":{found.line}"
                raise InputError(f"{device.label}: {device.eds.path}{line}: object {found.place} {found}")


def boot(
    network: canopen.Network, devices: Devices, machine: MachineFile, cycle_s: float, timed: bool
) -> tuple[list[str], int]:
    """Identify, configure and start every node.

    Parameters
    ----------
    network : canopen.Network
        The network the devices are on, with a thread that receives.
    devices : Devices
        From `add_devices`.
    machine : MachineFile
        Travel, limits and supervision times to be written.
    cycle_s : float
        Time from one target to the next, s.
    timed : bool
        Whether SYNC comes once in that time; not in lockstep.

    Returns
    -------
    notes : list of str
        One line for each object a device lacks, with the consequence.
    sync_overflow : int
        Largest number that SYNCs carry; 0 where they carry none.

    Raises
    ------
    RunError
        A node does not answer, is not the expected device, or refuses a setting. Nothing has moved.
    """
    for device in devices:
        identify(device, DRIVE_PROFILE if device in devices.drives else GAUGE_PROFILE)
    network.nmt.send_command(NMT_PRE_OPERATIONAL)
    sync_overflow, notes = configure_sync_counter(tuple(devices))
    for slider, drive in enumerate(devices.drives, start=1):
        check_mode_offered(drive)
        notes += configure_drive(drive, machine, cycle_s, timed, slider)
    notes += configure_gauge(devices.gauge, machine, cycle_s, timed)
    network.nmt.send_command(NMT_START)
    return notes, sync_overflow


def identify(device: RemoteDevice, profile: int) -> None:
    """Check device type (1000h) and identity (1018h) of a node against its profile and EDS.

    Parameters
    ----------
    device : RemoteDevice
    profile : int
        Expected device profile: 402 or 404.

    Raises
    ------
    RunError
        They differ; names object, value and expectation.
    """
    found = int(device.read(0x1000)) & 0xFFFF
    if found != profile:
        raise RunError(f"{device.label}: device type {found} in object 1000:00 (expected a CiA {profile} device)")
    for subindex, what in IDENTITY.items():
        expected = device.default(0x1018, subindex)
        if not expected:
            continue
        number = device.read(0x1018, subindex)
        if number != expected:
            where = f"{what} {number} in object {name(0x1018, subindex)}"
            raise RunError(f"{device.label}: {where} (expected {expected}, as in {device.eds.path.name})")


def check_mode_offered(drive: RemoteDevice) -> None:
    """Check that a drive offers cyclic synchronous position mode (bit 7 of 6502h); a drive without 6502h passes.

    Raises
    ------
    RunError
        The mode is not offered.
    """
    if drive.has(0x6502, 0):
        modes = int(drive.read(0x6502))
        if not modes >> (CYCLIC_SYNCHRONOUS_POSITION - 1) & 1:
            raise RunError(
                f"{drive.label}: modes {modes:X}h in object 6502:00 (expected bit 7, cyclic synchronous position)"
            )


def release(network: canopen.Network, devices: Sequence[RemoteDevice]) -> None:
    """Return nodes to pre-operational; their settings remain."""
    for device in devices:
        network.send_message(0x000, bytes([NMT_PRE_OPERATIONAL, device.node_id]))
