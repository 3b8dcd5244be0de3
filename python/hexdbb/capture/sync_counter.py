"""SYNC counter: whether SYNCs carry a number, which all nodes must agree on, and writing it to them.

A node that counts SYNCs ignores one that CAN has repeated, and reports one that was lost or that another producer has
sent. All nodes receive the same SYNCs, so all must have the counter; where one has it fixed, its value holds for all.
Source: CiA 301, 1019h (synchronous counter overflow value), which may be changed only while 1006h is 0.
"""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.capture.sdo import RemoteDevice
from hexdbb.errors import RunError

OVERFLOW, PERIOD = 0x1019, 0x1006
LARGEST = 240
"""Largest value of 1019h (CiA 301): two SYNCs of one number are as far apart as can be, a second at 250 Hz."""


def configure_sync_counter(devices: Sequence[RemoteDevice]) -> tuple[int, list[str]]:
    """Agree on the counter of SYNC and write it to every node that has object 1019h.

    Parameters
    ----------
    devices : sequence of RemoteDevice
        All nodes, pre-operational.

    Returns
    -------
    overflow : int
        Value after which the counter begins at 1 again; 0 where SYNCs carry no counter.
    notes : list of str
        One line for each node that lacks the object although others require a counter.

    Raises
    ------
    RunError
        Two nodes have fixed values that differ, or one refuses a value.
    """
    with_counter = [device for device in devices if device.has(OVERFLOW, 0)]
    fixed = [(device, int(device.read(OVERFLOW))) for device in with_counter if not device.writable(OVERFLOW, 0)]
    all_have_it = len(with_counter) == len(devices)
    overflow = max((value for _, value in fixed), default=LARGEST if all_have_it else 0)
    for device, value in fixed:
        if value != overflow:
            raise RunError(
                f"{device.label}: object 1019:00 is {value} and read-only (expected {overflow}, as of another node: "
                "SYNCs carry the same counter for all)"
            )
    for device in with_counter:
        if device.writable(OVERFLOW, 0):
            if device.writable(PERIOD, 0):
                device.write(PERIOD, 0, 0)
            device.write(OVERFLOW, 0, overflow)
    if not overflow:
        return 0, []
    return overflow, [
        f"{device.label}: no object 1019:00 in {device.eds.path.name}: SYNCs carry a counter that it may not expect"
        for device in devices
        if device not in with_counter
    ]
