"""A plan to begin with for a machine: one level circle in the middle of its workspace."""

from __future__ import annotations

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile, Workspace
from hexdbb.plan import Circle, Mount, Plan, load_plan

BALL_ABOVE_JOINTS_MM = 40.0
"""Height of the centre ball above the plane of the ball joints, as in the plan `standard`: in that plane a level circle
determines fewer errors (docs/planning.md)."""


def plan_template(machine: MachineFile, workspace: Workspace, bar_length_mm: float) -> Plan:
    """Return a plan of one level circle about the middle of a workspace; all else is that of the plan `standard`.

    Raises
    ------
    InputError
        The bar is longer than the workspace's radius.
    """
    if bar_length_mm > workspace.radius_mm:
        expected = f"at most the workspace's radius, {workspace.radius_mm:g} mm"
        raise InputError(f"bar length {bar_length_mm:g} mm: no circle of it fits (expected {expected})")
    standard = load_plan("standard")
    ball_mm = (0.0, 0.0, machine.platform.joint_plane_height_mm + BALL_ABOVE_JOINTS_MM)
    x, y, z = workspace.centre_mm
    circle = Circle(id=0, mount=0, radius_mm=bar_length_mm, ball_offset_mm=ball_mm)
    return standard.model_copy(
        update={
            "gauge": standard.gauge.model_copy(update={"bar_length_mm": bar_length_mm}),
            "mounts": (Mount(id=0, cup_mm=(x, y, z + ball_mm[2])),),
            "circles": (circle,),
        }
    )
