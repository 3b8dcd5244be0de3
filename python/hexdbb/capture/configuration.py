"""Settings and PDO mappings of a node, written and read back; what a device fixes is read and compared.

Source: CiA 301, order in which a PDO mapping is changed.
"""

from __future__ import annotations

from collections.abc import Iterator

from hexdbb.capture.pdo import DRIVE_RPDO, DRIVE_TPDO, GAUGE_TPDO, NOT_VALID, SYNCHRONOUS, WITHOUT_REMOTE, PdoLayout
from hexdbb.capture.sdo import RemoteDevice, name
from hexdbb.capture.settings import GAUGE_UNIT, apply, communication_settings, drive_settings, expect, rpdo_deadline
from hexdbb.errors import RunError
from hexdbb.machine import MachineFile


def map_pdo(device: RemoteDevice, layout: PdoLayout, deadline_ms: int | None = None) -> Iterator[str]:
    """Configure one PDO in the order that CiA 301 prescribes, and read every value back.

    Parameters that the device fixes are read only, and must be what would have been written.

    Parameters
    ----------
    device : RemoteDevice
    layout : PdoLayout
    deadline_ms : int, optional
        Event timer of an RPDO (1400h:05): time without the PDO after which the device reacts, ms.

    Yields
    ------
    str
        The consequence if the device has no event timer.

    Raises
    ------
    RunError
        The node refuses a value or reads back another.
    """
    cob_id = layout.cob_id(device.node_id)
    fixed = not all(device.writable(layout.mapping, subindex) for subindex in layout.entries)
    if device.writable(layout.communication, 1):
        device.send(layout.communication, 1, cob_id | NOT_VALID)
    write_or_expect(device, layout.communication, 2, SYNCHRONOUS)
    if fixed:
        for subindex, value in layout.entries.items():
            expect_fixed(device, layout.mapping, subindex, value)
    else:
        device.send(layout.mapping, 0, 0)
        for subindex, mapped in enumerate(layout.objects, start=1):
            device.write(layout.mapping, subindex, mapped.entry)
        device.write(layout.mapping, 0, len(layout.objects))
    if deadline_ms is not None:
        yield from apply(device, [rpdo_deadline(deadline_ms)])
    if device.writable(layout.communication, 1):
        device.write(layout.communication, 1, cob_id)
    else:
        expect_fixed(device, layout.communication, 1, cob_id, ignored=WITHOUT_REMOTE)


def write_or_expect(device: RemoteDevice, index: int, subindex: int, value: int) -> None:
    """Write an object and read it back, or check the value of one that is read-only."""
    if device.writable(index, subindex):
        device.write(index, subindex, value)
    else:
        expect_fixed(device, index, subindex, value)


def expect_fixed(device: RemoteDevice, index: int, subindex: int, value: int, ignored: int = 0) -> None:
    """Check the value of a read-only object; raises `RunError` if it differs in bits that are not `ignored`."""
    found = int(device.read(index, subindex))
    if (found ^ value) & ~ignored:
        place = name(index, subindex)
        raise RunError(f"{device.label}: object {place} is {found:X}h and read-only (expected {value:X}h)")


def configure_drive(
    device: RemoteDevice, machine: MachineFile, cycle_s: float, timed: bool, slider: int
) -> Iterator[str]:
    """Write all settings and PDO mappings of a slider's drive (1 to 6); yield one line for each object it lacks."""
    yield from apply(device, drive_settings(machine, cycle_s, timed, slider))
    yield from map_pdo(device, DRIVE_RPDO, machine.can_setup.rpdo_timeout_ms)
    yield from map_pdo(device, DRIVE_TPDO)


def configure_gauge(device: RemoteDevice, machine: MachineFile, cycle_s: float, timed: bool) -> Iterator[str]:
    """Check the unit of the gauge and write its settings and PDO mapping; yield one line for each object it lacks."""
    expect(device, GAUGE_UNIT)
    yield from apply(device, communication_settings(machine, cycle_s, timed))
    yield from map_pdo(device, GAUGE_TPDO)
