"""Points of the true machine: guideways, joints and leg lengths with geometric errors, as exact point transforms.

Model: a guideway is a line of slider joint centres. In the guideway's local axes (x outward from the base centre, y
towards the vertex V_i, z up, origin at its midpoint) its points are (0, sqrt(3) BR - s, 0). Errors move them in this
order: rotation about local z (xy), rotation about local x (yz), both through the midpoint; rotation about z through
the base centre; translation in local axes. The joint triangle gets its three true sides, keeps its centroid, and is
turned in its plane so that it fits the nominal triangle best (Procrustes).
Source: thesis section 3.2, with exact transforms instead of its linearised equations.
Units: mm, rad. Frames: base frame for guideways, platform frame for joints.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.machine import MachineFile

Array = NDArray[np.float64]
SQRT3 = math.sqrt(3.0)
STANDARD_GRAVITY_M_S2 = 9.80665
"""Standard acceleration of free fall (3rd CGPM, 1901)."""


def rotation_x(angle_rad: float) -> Array:
    """Return the rotation matrix about x, shape (3, 3)."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def rotation_y(angle_rad: float) -> Array:
    """Return the rotation matrix about y, shape (3, 3)."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def rotation_z(angle_rad: float) -> Array:
    """Return the rotation matrix about z, shape (3, 3)."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def rotation_rpy(roll_rad: float, pitch_rad: float, yaw_rad: float) -> Array:
    """Return R = Rz(yaw) Ry(pitch) Rx(roll), shape (3, 3)."""
    return rotation_z(yaw_rad) @ rotation_y(pitch_rad) @ rotation_x(roll_rad)


def _zeros(*shape: int) -> Array:
    return np.zeros(shape)


@dataclass(frozen=True)
class GeometryErrors:
    """The 33 geometric error parameters, mm and rad; those not given are zero."""

    leg_length_mm: Array = field(default_factory=lambda: _zeros(6))
    slider_offset_mm: Array = field(default_factory=lambda: _zeros(6))
    guideway_translation_mm: Array = field(default_factory=lambda: _zeros(3, 3))
    """Shape (3, 3): x, y, z of guideways 1 to 3, local axes."""
    guideway_rotation_xy_rad: Array = field(default_factory=lambda: _zeros(3))
    guideway_rotation_yz_rad: Array = field(default_factory=lambda: _zeros(3))
    guideway_rotation_centre_rad: Array = field(default_factory=lambda: _zeros(3))
    platform_side_mm: Array = field(default_factory=lambda: _zeros(3))
    """Added to |Q1Q2|, |Q2Q3|, |Q3Q1|."""


@dataclass(frozen=True)
class TrueGeometry:
    """Points of the true machine.

    Attributes
    ----------
    anchors_mm : (6, 3) array
        Joint of slider k at slider coordinate 0, base frame, slider offset included.
    directions : (6, 3) array
        Unit vectors of increasing slider coordinate, base frame.
    lengths_mm : (6,) array
        Distance between the joints of leg k.
    joints_mm : (6, 3) array
        Ball joint at the platform end of leg k, platform frame.
    weight_n : float
        Weight of platform and tool, acting at the platform's reference point, N.
    """

    anchors_mm: Array
    directions: Array
    lengths_mm: Array
    joints_mm: Array
    weight_n: float

    def slider_joints_mm(self, sliders_mm: Array) -> Array:
        """Return slider joint centres in the base frame, mm, shape (..., 6, 3), of slider coordinates, mm, (..., 6)."""
        return self.anchors_mm + sliders_mm[..., None] * self.directions

    def sliders_for(self, position_mm: Array, rotation: Array) -> Array:
        """Compute the slider coordinates of poses.

        Parameters
        ----------
        position_mm : numpy.ndarray
            Platform positions in the base frame, mm, shape (..., 3).
        rotation : numpy.ndarray
            Platform rotations, shape (..., 3, 3).

        Returns
        -------
        numpy.ndarray
            Slider coordinates, mm, shape (..., 6).

        Raises
        ------
        InputError
            A leg does not reach its guideway; names the first such pose.
        """
        joints = self.joints_mm @ np.swapaxes(rotation, -1, -2) + position_mm[..., None, :]
        reach = joints - self.anchors_mm
        foot = np.einsum("...ij,ij->...i", reach, self.directions)
        square = self.lengths_mm**2 - np.einsum("...ij,...ij->...i", reach, reach) + foot**2
        if np.any(square < 0.0):
            *pose, leg = np.argwhere(square < 0.0)[0]
            where = np.round(position_mm[tuple(pose)], 3).tolist()
            raise InputError(f"pose {where} mm: leg {leg + 1} does not reach its guideway")
        sliders: Array = foot + np.array([-1.0, 1.0] * 3) * np.sqrt(square)
        return sliders


def true_geometry(machine: MachineFile, errors: GeometryErrors | None = None) -> TrueGeometry:
    """Compute the points of a machine with geometric errors.

    Parameters
    ----------
    machine : MachineFile
        Nominal machine.
    errors : GeometryErrors, optional
        Zero if not given.
    """
    errors = errors if errors is not None else GeometryErrors()
    anchors, directions = np.empty((6, 3)), np.empty((6, 3))
    for i in range(3):
        point, direction = _guideway(machine, i, errors)
        for k in (2 * i, 2 * i + 1):
            directions[k] = direction
            anchors[k] = point + errors.slider_offset_mm[k] * direction
    return TrueGeometry(
        anchors,
        directions,
        np.array(machine.legs.lengths_mm) + errors.leg_length_mm,
        np.repeat(_joint_triangle(machine, errors.platform_side_mm), 2, axis=0),
        machine.platform.moved_mass_kg * STANDARD_GRAVITY_M_S2,
    )


def _guideway(machine: MachineFile, i: int, errors: GeometryErrors) -> tuple[Array, Array]:
    """Return the point at slider coordinate 0 and the direction of guideway i (0 to 2), base frame."""
    inradius_mm = machine.base.inradius_mm
    local_to_base = rotation_z(machine.base.guideway_angles_rad[i])
    turn = rotation_x(errors.guideway_rotation_yz_rad[i]) @ rotation_z(errors.guideway_rotation_xy_rad[i])
    swing = rotation_z(errors.guideway_rotation_centre_rad[i])
    point = np.array([inradius_mm, 0.0, 0.0]) + turn @ np.array([0.0, SQRT3 * inradius_mm, 0.0])
    direction = swing @ local_to_base @ turn @ np.array([0.0, -1.0, 0.0])
    return swing @ local_to_base @ point + local_to_base @ errors.guideway_translation_mm[i], direction


def _joint_triangle(machine: MachineFile, longer_mm: Array) -> Array:
    """Return the ball joints Q1, Q2, Q3 in the platform frame, mm, shape (3, 3)."""
    radius, height = machine.platform.circumradius_mm, machine.platform.joint_plane_height_mm
    angles = np.array(machine.platform.joint_angles_rad)
    nominal = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    side_12, side_23, side_31 = np.linalg.norm(nominal - np.roll(nominal, -1, axis=0), axis=1) + longer_mm
    # Q1 at the origin, Q2 on the x axis; counter-clockwise as the nominal triangle is.
    x3 = (side_12**2 + side_31**2 - side_23**2) / (2.0 * side_12)
    triangle = np.array([[0.0, 0.0], [side_12, 0.0], [x3, math.sqrt(side_31**2 - x3**2)]])
    triangle -= triangle.mean(axis=0)
    centre = nominal.mean(axis=0)
    about = nominal - centre
    cross = float(np.sum(triangle[:, 0] * about[:, 1] - triangle[:, 1] * about[:, 0]))
    turn = rotation_z(math.atan2(cross, float(np.sum(triangle * about))))[:2, :2]
    return np.column_stack([centre + triangle @ turn.T, np.full(3, height)])
