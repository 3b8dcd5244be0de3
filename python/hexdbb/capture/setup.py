"""The set-up an operator makes between runs: cup and bar mounted, and the gauge told of it.

Object 2100h of the gauge is manufacturer-specific: cup position, ball offset, bar length, then the set-up's number,
which makes them valid. A simulated gauge reads nothing without it; a real one may lack it.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping

from hexdbb.capture.sdo import RemoteDevice
from hexdbb.plan import CircleRun, Gauge
from hexdbb.trajectory import Phase, Programme

SETUP = 0x2100
FIRST_VALUE, NUMBER = 2, 1

Confirm = Callable[[str], None]
"""Asks the operator to do something, and returns when it is done."""


def setup_changes(programme: Programme) -> dict[int, CircleRun]:
    """Rows of the table before which another set-up must be made, with the first run that needs it.

    The row is the first of a run's feed-in: the platform stands where the bar is mounted.
    """
    changes: dict[int, CircleRun] = {}
    known = None
    table = programme.table
    for index, run in enumerate(programme.runs):
        needed = (run.mount, run.circle.radius_mm, run.circle.ball_offset_mm)
        if needed != known:
            known = needed
            rows = (table.run == index) & (table.phase == Phase.FEED_IN)
            changes[int(rows.argmax())] = run
    return changes


def pauses(
    changes: Mapping[int, CircleRun], gauge: Gauge, device: RemoteDevice, confirm: Confirm | None
) -> dict[int, Callable[[], None]]:
    """Turn set-up changes into what is to be done at their rows: ask the operator, tell the gauge."""

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
    """Tell the gauge which set-up is mounted; raises `RunError` where it has the object and refuses."""
    if not device.has(SETUP, NUMBER):
        return
    values = (*run.mount.cup_mm, *run.circle.ball_offset_mm, gauge.bar_length_mm)
    for subindex, value in enumerate(values, start=FIRST_VALUE):
        device.write(SETUP, subindex, as_real32(value))
    device.write(SETUP, NUMBER, run.mount.id + 1)


def as_real32(value: float) -> float:
    """Round to what a REAL32 object holds, so that it reads back equal."""
    (rounded,) = struct.unpack("<f", struct.pack("<f", value))
    return float(rounded)
