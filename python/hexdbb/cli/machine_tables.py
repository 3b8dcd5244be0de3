"""Printed tables of the machine commands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hexdbb.cli.consoles import say
from hexdbb.cli.plan_tables import print_table
from hexdbb.machine import MachineFile, home_heights_mm

if TYPE_CHECKING:
    from hexdbb.workspace import Assessment


def print_assessment(machine: MachineFile, found: Assessment, *, is_wanted: bool) -> None:
    """Print what a machine does over its workspace."""
    space = found.workspace
    low_mm, high_mm = (each - machine.platform.joint_plane_height_mm for each in home_heights_mm(machine))
    x, y, z = space.centre_mm
    say(
        f"{machine.name}: home (level, over the base centre) at z = {low_mm:.0f} to {high_mm:.0f} mm\n"
        f"workspace{'' if is_wanted else ', chosen because the file has none'}: centre {x:g}, {y:g}, {z:g} mm, radius"
        f" {space.radius_mm:g} mm, height {space.height_mm:g} mm, tilt {space.tilt_deg:g} deg;"
        f" {found.reached} of {found.poses} poses within reach"
    )
    rows = [(each.what, each.value, each.where) for each in found.worst]
    print_table(("nearest and largest", "value", "at"), rows, names=1)
    for each in found.findings:
        say(f"look at: {each}")
    if not found.findings:
        say("nothing is near a limit or a singular pose")
