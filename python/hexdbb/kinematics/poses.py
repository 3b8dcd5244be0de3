"""Inverse and forward kinematics of the nominal machine for tables of poses, computed by the engine.

Poses are (p, R) with R = Rz(yaw) Ry(pitch) Rx(roll), thesis (2.27); lengths mm, angles rad. A pose out of reach raises
nothing: its row has a status other than 0, which `status_name` names.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hexdbb import _core
from hexdbb.machine import MachineFile

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


@lru_cache(maxsize=64)
def engine_machine(machine: MachineFile) -> _core.Machine:
    """Return the engine's machine with the dimensions of a machine file, mm and kg.

    Kept for the next call: judging a record asks for it some sixty times. Neither of the two can be changed.
    """
    return _core.Machine(
        base_inradius_mm=machine.base.inradius_mm,
        platform_circumradius_mm=machine.platform.circumradius_mm,
        joint_plane_height_mm=machine.platform.joint_plane_height_mm,
        leg_length_mm=machine.legs.lengths_mm,
        travel_min_mm=[least for least, _ in machine.sliders.travels_mm],
        travel_max_mm=[largest for _, largest in machine.sliders.travels_mm],
        min_gap_mm=machine.sliders.min_gap_mm,
        screw_lead_mm=machine.sliders.screw_lead_mm,
        moved_mass_kg=machine.platform.moved_mass_kg,
        guideway_angle_rad=machine.base.guideway_angles_rad,
        joint_angle_rad=machine.platform.joint_angles_rad,
    )


def status_name(code: int) -> str:
    """Return the meaning of a status code of the kinematics in words."""
    return _core.status_name(code)


def rotation_from_rpy(rpy_rad: ArrayLike) -> Floats:
    """Return rotation matrices R = Rz(yaw) Ry(pitch) Rx(roll), thesis (2.27).

    Parameters
    ----------
    rpy_rad : array_like, shape (..., 3)
        Roll, pitch, yaw, rad.

    Returns
    -------
    ndarray, shape (..., 3, 3)
    """
    rpy = np.asarray(rpy_rad, dtype=np.float64)
    matrices = [_core.rotation_from_rpy(*angles) for angles in rpy.reshape(-1, 3).tolist()]
    return np.array(matrices, dtype=np.float64).reshape(*rpy.shape, 3)


def rpy_from_rotation(rotation: ArrayLike) -> Floats:
    """Return roll, pitch, yaw (3,) in rad of one rotation matrix (3, 3), pitch within ±90 degrees."""
    return np.asarray(_core.rpy_from_rotation(np.asarray(rotation, dtype=np.float64)), dtype=np.float64)


def inverse(machine: MachineFile, position_mm: ArrayLike, rpy_rad: ArrayLike) -> tuple[Floats, Ints]:
    """Compute slider coordinates of platform poses (thesis 2.6-2.8).

    Parameters
    ----------
    machine : MachineFile
    position_mm : array_like, shape (n, 3)
        Platform reference point, base frame, mm.
    rpy_rad : array_like, shape (n, 3) or (3,)
        Roll, pitch, yaw, rad.

    Returns
    -------
    sliders_mm : ndarray, shape (n, 6)
    status : ndarray of int, shape (n,)
        0 where the pose is reached within travel and gap; see `status_name`.
    """
    position = np.asarray(position_mm, dtype=np.float64)
    rpy = np.ascontiguousarray(np.broadcast_to(np.asarray(rpy_rad, dtype=np.float64), position.shape))
    sliders, status, _ = _core.inverse_table(engine_machine(machine), np.ascontiguousarray(position), rpy)
    return sliders, status


def forward(machine: MachineFile, sliders_mm: ArrayLike) -> tuple[Floats, Floats, Ints]:
    """Compute platform poses of slider coordinates by the three RSSR loops (thesis 2.9-2.33).

    Parameters
    ----------
    machine : MachineFile
    sliders_mm : array_like, shape (n, 6)
        Slider coordinates, mm.

    Returns
    -------
    position_mm : ndarray, shape (n, 3)
    rotation : ndarray, shape (n, 3, 3)
    status : ndarray of int, shape (n,)
        0 where a pose was found; position and rotation are zero elsewhere.
    """
    sliders = np.asarray(sliders_mm, dtype=np.float64)
    rows = np.zeros(len(sliders), dtype=np.int32)
    anywhere = _core.SetUp(cup_mm=np.zeros(3), ball_offset_mm=np.zeros(3), bar_length_mm=0.0)
    samples = _core.Samples(sliders_mm=sliders, set_up=rows, mount=rows, set_ups=[anywhere])
    pose, status = _core.forward_table(_core.Model(engine_machine(machine)), samples)
    return pose[:, :3].copy(), pose[:, 3:].reshape(-1, 3, 3).copy(), status
