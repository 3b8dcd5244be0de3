"""Check that the circles of a record fit its bar, its gauge and its machine.

Model: a reading is the distance of the two balls minus the bar's length, so the commanded radius differs from the bar's
length by the reading, within the gauge's range, and by what the machine deviates. Ball and cup lie within the machine:
no place of it is further from the base centre than a guideway's end (2 BR), a leg (l) and the platform (UR, IH).
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from hexdbb.errors import InputError
from hexdbb.files.validation import format_value
from hexdbb.machine import MachineFile
from hexdbb.plan import Circle
from hexdbb.record.record import Record

DEVIATION_MAX_MM = 5.0
"""Limits what a machine may deviate in radius beyond the gauge's range: ten times the half millimetre that a machine
with grossly wrong dimensions shows in radius, and a twentieth of the shortest common bar (100 mm), so that a wrong unit
or another bar is seen."""

Misfit = tuple[str, object, str]
"""Key of a circle or its mount, its value, and what was expected."""


def check_geometry(record: Record, name: str) -> None:
    """Check every circle of a record; `name` is that of its file.

    Raises
    ------
    InputError
        Names the first circle that does not fit, the value and what was expected.
    """
    for circle in record.circles:
        for key, value, expected in _misfits(record, circle):
            raise InputError(f"{name}: circle {circle.id}: {key}: {format_value(value)} (expected {expected})")


def _misfits(record: Record, circle: Circle) -> Iterator[Misfit]:
    bar_mm, range_mm = record.gauge.bar_length_mm, record.gauge.range_um / 1000.0
    reach_mm = _reach_mm(record.machine)
    offset_mm = math.hypot(*circle.ball_offset_mm)
    if offset_mm > reach_mm:
        yield "ball_offset_mm", circle.ball_offset_mm, f"a ball within {reach_mm:g} mm, the extent of the machine"
    if circle.radius_mm > reach_mm + offset_mm:
        yield "radius_mm", circle.radius_mm, f"at most {reach_mm + offset_mm:g}, the reach of the ball"
    cup_mm = record.mount(circle.mount).cup_mm
    if math.hypot(*cup_mm) > 2.0 * (reach_mm + offset_mm):
        yield f"cup_mm of mount {circle.mount}", cup_mm, f"within {2.0 * (reach_mm + offset_mm):g} mm of the base"
    if range_mm >= bar_mm:
        yield "range_um of the gauge", record.gauge.range_um, f"less than the bar's length, {bar_mm:g} mm"
    within_mm = range_mm + DEVIATION_MAX_MM
    if abs(circle.radius_mm - bar_mm) > within_mm:
        parts = f"the gauge's range of {range_mm:g} mm and {DEVIATION_MAX_MM:g} mm for the machine"
        yield "radius_mm", circle.radius_mm, f"the bar's length, {bar_mm:g}, within {within_mm:g} mm: {parts}"


def _reach_mm(machine: MachineFile) -> float:
    """Return a bound of the distance of any place of the platform from the base centre."""
    platform = machine.platform
    height_mm = abs(platform.joint_plane_height_mm)
    return 2.0 * machine.base.inradius_mm + max(machine.legs.lengths_mm) + platform.circumradius_mm + height_mm
