"""Where the centre ball of a true machine really is at poses of its own workspace, by the truth's own kinematics.

Assumption: errors of geometry and of the ball's offset; mechanisms, which depend on what was driven before, are left
out. Units: mm, rad. Frames: base frame.
"""

from __future__ import annotations

import numpy as np

from hexdbb.machine import MachineFile
from hexdbb.rig.geometry import Array, rotation_rpy, true_geometry
from hexdbb.rig.pose_solver import Hexapod, Poses, solve_poses
from hexdbb.rig.truth import TruthFile


def true_balls_mm(
    truth: TruthFile, machine: MachineFile, position_mm: Array, rpy_rad: Array, ball_offset_mm: tuple[float, ...]
) -> Array:
    """Return where the ball is when the sliders stand where the nominal machine has them for some poses.

    Parameters
    ----------
    truth : TruthFile
    machine : MachineFile
        The nominal machine.
    position_mm, rpy_rad : (n, 3) arrays
        Nominal poses, all within its reach.
    ball_offset_mm : tuple of float
        Nominal place of the ball on the platform, platform frame.

    Returns
    -------
    (n, 3) array

    Raises
    ------
    RunError
        The machine has no pose there.
    """
    rotation = np.array([rotation_rpy(*each) for each in rpy_rad])
    sliders_mm = true_geometry(machine).sliders_for(position_mm, rotation)
    geometry, count = true_geometry(machine, truth.geometry.errors()), len(position_mm)
    hexapod = Hexapod(
        geometry.slider_joints_mm(sliders_mm),
        np.tile(geometry.joints_mm, (count, 1, 1)),
        np.tile(geometry.lengths_mm, (count, 1)),
    )
    poses = solve_poses(hexapod, Poses(position_mm, rotation))
    ball = np.array(ball_offset_mm) + truth.setup.errors().ball_offset_mm
    return np.asarray(poses.position_mm + poses.rotation @ ball)
