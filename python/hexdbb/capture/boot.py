"""Before motion: find the seven nodes, see that they are what the machine file says, configure them, read back.

Nothing moves here. Source: CiA 301 (NMT, 1000h, 1018h), CiA 402 and CiA 404 (device types, 6502h).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import canopen

from hexdbb.capture.cia402 import CYCLIC_SYNCHRONOUS_POSITION
from hexdbb.capture.sdo import RemoteDevice, name
from hexdbb.capture.settings import configure_drive, configure_gauge
from hexdbb.errors import RunError
from hexdbb.machine import MachineFile

ALL_NODES = 0
NMT_START, NMT_PRE_OPERATIONAL = 0x01, 0x80
DRIVE_PROFILE, GAUGE_PROFILE = 402, 404
IDENTITY = {1: "vendor", 2: "product"}
"""Sub-indices of 1018h compared with the EDS; 0 in the EDS stands for any."""


@dataclass(frozen=True)
class Devices:
    """The nodes of the rig."""

    drives: tuple[RemoteDevice, ...]
    gauge: RemoteDevice

    def __iter__(self) -> Iterator[RemoteDevice]:
        yield from (*self.drives, self.gauge)


def add_devices(network: canopen.Network, machine: MachineFile) -> Devices:
    """Enter the nodes of a machine file into a network.

    Raises
    ------
    InputError
        An EDS is not there or cannot be read.
    """
    can = machine.can_setup
    drives = tuple(
        RemoteDevice(network, node, f"slider {k}", machine.eds_path(eds))
        for k, (node, eds) in enumerate(zip(can.drive_nodes, can.drive_eds, strict=True), start=1)
    )
    return Devices(drives, RemoteDevice(network, can.gauge_node, "gauge", machine.eds_path(can.gauge_eds)))


def boot(network: canopen.Network, devices: Devices, machine: MachineFile, cycle_s: float) -> list[str]:
    """Identify and configure every node and start it.

    Returns
    -------
    list of str
        What devices lack, and what that means.

    Raises
    ------
    RunError
        A node is missing, is another than expected, or does not take a setting: nothing has moved.
    """
    for device in devices:
        identify(device, DRIVE_PROFILE if device in devices.drives else GAUGE_PROFILE)
    network.nmt.send_command(NMT_PRE_OPERATIONAL)
    notes: list[str] = []
    for drive in devices.drives:
        check_mode_offered(drive)
        notes += configure_drive(drive, machine, cycle_s)
    notes += configure_gauge(devices.gauge, machine, cycle_s)
    network.nmt.send_command(NMT_START)
    return notes


def identify(device: RemoteDevice, profile: int) -> None:
    """Compare device type and identity with profile and EDS; raises `RunError` where they differ."""
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
            raise RunError(f"{device.label}: {where} (expected {expected}, as in {device.eds.name})")


def check_mode_offered(drive: RemoteDevice) -> None:
    """Refuse a drive that says it has no cyclic synchronous position mode; one without 6502h is tried."""
    if drive.has(0x6502, 0):
        modes = int(drive.read(0x6502))
        if not modes >> (CYCLIC_SYNCHRONOUS_POSITION - 1) & 1:
            raise RunError(
                f"{drive.label}: modes {modes:X}h in object 6502:00 (expected bit 7, cyclic synchronous position)"
            )


def release(network: canopen.Network, devices: Sequence[RemoteDevice]) -> None:
    """Put nodes back to pre-operational; their settings stay."""
    for device in devices:
        network.send_message(0x000, bytes([NMT_PRE_OPERATIONAL, device.node_id]))
