"""What a machine does over a workspace: reach, travel, gaps of sliders, joint angles, condition, assembly.

Singular poses are found in two ways: by the condition of the machine's Jacobian (`hexdbb.kinematics.legs`), and by
solving forward what was solved inversely: a machine whose workspace reaches across a singular pose stands, with the
same sliders, in another pose than the one wanted.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.identifiability.redundancy import LEVER_MM
from hexdbb.kinematics import forward, status_name
from hexdbb.kinematics.legs import Legs
from hexdbb.kinematics.margins import nearest_end, nearest_sliders
from hexdbb.machine import MachineFile, Workspace
from hexdbb.workspace.poses import Poses, workspace_poses

Floats = NDArray[np.float64]

CONDITION_MAX = 50.0
"""Condition of the machine's Jacobian above which a pose counts as near-singular: three times the worst of the plan
`standard` on the shipped machine (16.3). There the platform gives way in one direction fifty times as easily as in
another, and leg forces grow likewise."""
MARGIN_MIN_MM = 5.0
"""Least distance to an end of travel and above the smallest gap, as for circles that are proposed: a misplaced cup and
compensation may move a slider by millimetres."""
SAME_POSE_MM = 1e-3
"""Difference of a pose and the forward solution of its sliders above which the two are different assemblies; solver
tolerances are a billionth of it."""


@dataclass(frozen=True)
class Worst:
    """An extreme value over the workspace, in words with its unit, and the pose where it is found."""

    what: str
    value: str
    where: str


@dataclass(frozen=True)
class Assessment:
    """A machine over a workspace.

    Attributes
    ----------
    workspace : Workspace
    poses : int
        Looked at.
    reached : int
        Of them.
    condition : float
        Largest of the reached poses; nan where none is reached.
    to_end_of_travel_mm, to_min_gap_mm, to_joint_limit_deg : float
        Least of the reached poses.
    worst : tuple of Worst
        For people, in the order of the checks.
    findings : tuple of str
        What is wrong, one sentence each; empty where nothing is.
    """

    workspace: Workspace
    poses: int
    reached: int
    condition: float
    to_end_of_travel_mm: float
    to_min_gap_mm: float
    to_joint_limit_deg: float
    worst: tuple[Worst, ...]
    findings: tuple[str, ...]


def assess(machine: MachineFile, workspace: Workspace) -> Assessment:
    """Check reach, travel, gaps, joint angles and singular poses over a workspace."""
    every = workspace_poses(machine, workspace)
    poses = every.some(every.reached)
    nothing = np.nan
    if not len(poses):
        return Assessment(workspace, len(every), 0, nothing, nothing, nothing, nothing, (), tuple(_out_of_reach(every)))
    legs = Legs.at(machine, poses.position_mm, poses.rotation, poses.sliders_mm)
    end, pair = nearest_end(machine, poses.sliders_mm), nearest_sliders(poses.sliders_mm)
    condition = legs.condition(LEVER_MM)
    worst_row = int(np.argmax(condition))
    left_deg = np.degrees(legs.to_joint_limit_rad(machine)).min(axis=1)
    to_gap_mm = pair.distance_mm - machine.sliders.min_gap_mm
    worst = (
        Worst(
            f"slider {end.slider} to its end of travel at {end.end_mm:g} mm",
            f"{end.left_mm:.1f} mm",
            poses.words(end.row),
        ),
        Worst(
            f"sliders {pair.first} and {pair.second}, beyond the smallest gap of {machine.sliders.min_gap_mm:g} mm",
            f"{to_gap_mm:.1f} mm",
            poses.words(pair.row),
        ),
        Worst("condition of the machine's Jacobian, largest", f"{condition[worst_row]:.1f}", poses.words(worst_row)),
        *_angles(legs, poses),
    )
    findings = [
        *_out_of_reach(every),
        *_assembly(machine, poses),
        *_near_limits(end.left_mm, to_gap_mm, float(condition[worst_row]), float(left_deg.min()), worst),
    ]
    if left_deg.min() < 0.0:
        row = int(np.argmin(left_deg))
        findings.append(f"joints: {-left_deg[row]:.1f} deg beyond the limits of [joints] at {poses.words(row)}")
    return Assessment(
        workspace,
        len(every),
        len(poses),
        float(condition[worst_row]),
        end.left_mm,
        to_gap_mm,
        float(left_deg.min()),
        worst,
        tuple(findings),
    )


def _angles(legs: Legs, poses: Poses) -> Iterator[Worst]:
    """Yield the extreme angles of the joints."""
    for what, angle_rad, extreme in (
        ("leg and guideway, least angle", legs.guideway_angle_rad(), np.argmin),
        ("leg and platform's normal, largest angle", legs.normal_angle_rad(), np.argmax),
        ("swing of a pair of legs, least", legs.swing_rad(), np.argmin),
        ("swing of a pair of legs, largest", legs.swing_rad(), np.argmax),
    ):
        row, leg = np.unravel_index(int(extreme(angle_rad)), angle_rad.shape)
        yield Worst(f"{what} (leg {leg + 1})", f"{np.degrees(angle_rad[row, leg]):.1f} deg", poses.words(int(row)))


def _out_of_reach(poses: Poses) -> Iterator[str]:
    missed = np.flatnonzero(~poses.reached)
    if len(missed):
        row = int(missed[0])
        share = 100.0 * len(missed) / len(poses)
        why = status_name(int(poses.status[row]))
        yield f"{share:.1f} % of the workspace is out of reach, as {poses.words(row)}: {why}"


def _assembly(machine: MachineFile, poses: Poses) -> Iterator[str]:
    """Yield a sentence where the machine's sliders do not determine the pose wanted."""
    position_mm, _, status = forward(machine, poses.sliders_mm)
    other = (status != 0) | (np.linalg.norm(position_mm - poses.position_mm, axis=1) > SAME_POSE_MM)
    if other.any():
        row = int(np.flatnonzero(other)[0])
        yield (
            f"the workspace reaches across a singular pose: with the sliders of {poses.words(row)} the machine stands"
            " in another pose"
        )


def _near_limits(
    end_mm: float, gap_mm: float, condition: float, left_deg: float, worst: tuple[Worst, ...]
) -> Iterator[str]:
    end, gap, singular = worst[:3]
    if end_mm < MARGIN_MIN_MM:
        yield f"{end.what}: {end.value} (expected {MARGIN_MIN_MM:g} mm or more) at {end.where}"
    if gap_mm < MARGIN_MIN_MM:
        yield f"{gap.what}: {gap.value} (expected {MARGIN_MIN_MM:g} mm or more) at {gap.where}"
    if condition > CONDITION_MAX:
        yield f"near-singular: condition {singular.value} (expected at most {CONDITION_MAX:g}) at {singular.where}"
