"""Set-up changes between runs: the operator mounts cup and bar, and the set-up is written to the gauge.

Object 2100h of the gauge is manufacturer-specific: cup position, ball offset, bar length, then the number of the
set-up, which makes them valid. The simulated gauge gives no reading without it; a real gauge may lack it.
Source: firmware_interfaces/README.md, section Gauge.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping

from hexdbb.capture.sdo import RemoteDevice
from hexdbb.plan import CircleRun, Gauge
from hexdbb.trajectory import Programme

SETUP = 0x2100
FIRST_VALUE, NUMBER = 2, 1
"""Sub-indices of 2100h: the seven values begin at 2; writing the number of the set-up to 1 makes them valid."""

Confirm = Callable[[str], None]
"""Asks the operator to do something and returns when it is done."""


def setup_changes(programme: Programme) -> dict[int, CircleRun]:
    """Return the rows before which the set-up must be changed, each with the first run that needs the new set-up.

    Such a row is the first of a run's feed-in, where the platform is at the mounting position of the bar.
    """
    changes: dict[int, CircleRun] = {}
    known = None
    for run, row in zip(programme.runs, programme.feeds_in, strict=True):
        needed = (run.mount, run.circle.radius_mm, run.circle.ball_offset_mm)
        if needed != known:
            known = needed
            changes[programme.before + int(row)] = run
    return changes


def pauses(
    changes: Mapping[int, CircleRun], gauge: Gauge, device: RemoteDevice, confirm: Confirm | None
) -> dict[int, Callable[[], None]]:
    """Return the work to be done at each set-up change: ask the operator, then write the set-up to the gauge."""

    def change(run: CircleRun) -> Callable[[], None]:
        def work() -> None:
            if confirm is not None:
                x, y, z = run.mount.cup_mm
                confirm(
                    f"mount {run.mount.id}: cup at ({x:g}, {y:g}, {z:g}) mm; put the {gauge.bar_length_mm:g} mm bar on"
                )
            announce(device, run, gauge)

        return work

    return {row: change(run) for row, run in changes.items()}


def announce(device: RemoteDevice, run: CircleRun, gauge: Gauge) -> None:
    """Write the mounted set-up to the gauge, if it has object 2100h; raises `RunError` if it refuses."""
    if not device.has(SETUP, NUMBER):
        return
    values = (*run.mount.cup_mm, *run.circle.ball_offset_mm, gauge.bar_length_mm)
    for subindex, value in enumerate(values, start=FIRST_VALUE):
        device.write(SETUP, subindex, as_real32(value))
    device.write(SETUP, NUMBER, run.mount.id + 1)


def as_real32(value: float) -> float:
    """Round a value to REAL32, so that it reads back equal."""
    (rounded,) = struct.unpack("<f", struct.pack("<f", value))
    return float(rounded)
