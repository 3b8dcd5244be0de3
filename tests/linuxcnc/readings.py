"""From LinuxCNC's joints to ball-bar readings on the true machine, and the circular deviations of its circles.

Model: the true machine of `hexdbb.rig` (its own geometry, pose solver and mechanisms, nothing of the engine) is driven
through every servo period of the session, so that play and friction have the history of the controller's motion; the
gauge is read in the evaluated turn of each arc. The nominal bar length is the circle's radius.
Quantities: the centre offset of the set-up, which is unknown on a machine, is removed by a least-squares circle through
both directions; radius errors remain.
Units: mm, s, rad.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from tests.linuxcnc.program import BALL_OFFSET_MM, Arc, Circle
from tests.linuxcnc.session import PERIOD_S, Session

from hexdbb.comparison.iso230 import (
    Path,
    bidirectional_circular_deviation_mm,
    circular_hysteresis_mm,
    make_path,
    set_up_centre_mm,
)
from hexdbb.machine import MachineFile
from hexdbb.rig.mechanisms import Motion
from hexdbb.rig.plant import Mounted
from hexdbb.rig.pose_solver import Poses
from hexdbb.rig.truth import TruthFile

EVERY = 8
"""Servo periods between two readings."""
MOUNT = 0


@dataclass(frozen=True)
class Roundness:
    """Circular deviations of one circle in both directions, mm.

    Attributes
    ----------
    rms : float
        RMS of the radial deviation about the centre of the set-up.
    peak_to_valley : float
        Bi-directional circular deviation G(b), ISO 230-4.
    hysteresis : float
        Circular hysteresis H, ISO 230-4.
    """

    rms: float
    peak_to_valley: float
    hysteresis: float


def measured_paths(session: Session, arcs: Sequence[Arc], truth: TruthFile, machine: MachineFile) -> dict[int, Path]:
    """Return the path of each arc by its tag: one turn with the deviations that a gauge without noise reads."""
    true_machine = truth.true_machine(machine)
    sliders = session.sliders_mm
    moved = Motion(PERIOD_S * np.arange(len(sliders)), PERIOD_S, sliders, MOUNT)
    push = true_machine.displaced(moved)
    paths = {}
    for arc in arcs:
        rows = _evaluated(session, arc)
        circle, there = arc.circle, push.at(rows)
        guess = Poses(_commanded_mm(session)[rows], np.broadcast_to(circle.rotation, (len(rows), 3, 3)))
        poses = true_machine.poses(sliders[rows], there, guess)
        bar = Mounted(MOUNT, circle.cup_mm, BALL_OFFSET_MM, circle.radius_mm)
        reading = true_machine.reading_mm(bar, there, poses)
        paths[arc.tag] = make_path(_angle(poses.position_mm, circle), reading, circle.radius_mm)
    return paths


def roundness(ccw: Path, cw: Path) -> Roundness:
    """Compute the circular deviations of a circle driven in both directions."""
    centre = set_up_centre_mm(ccw, cw)
    about = [path.about(centre) for path in (ccw, cw)]
    deviation = np.concatenate([path.deviation_mm for path in about])
    return Roundness(
        float(np.sqrt(np.mean(deviation**2))),
        bidirectional_circular_deviation_mm(ccw, cw),
        circular_hysteresis_mm(*about),
    )


def _evaluated(session: Session, arc: Arc) -> NDArray[np.intp]:
    """Return the servo periods of the evaluated turn in the middle of an arc."""
    during = np.flatnonzero(session.columns["tag"] == arc.tag)
    angle = np.unwrap(_angle(_commanded_mm(session)[during], arc.circle)) * arc.direction
    turned = angle - angle[0]
    in_turn = during[(turned >= 0.5 * np.pi) & (turned < 2.5 * np.pi)]
    return in_turn[::EVERY]


def _commanded_mm(session: Session) -> NDArray[np.float64]:
    return np.column_stack([session.columns[f"pose_{axis}"] for axis in "xyz"])


def _angle(position_mm: NDArray[np.float64], circle: Circle) -> NDArray[np.float64]:
    """Return the polar angle of the position about the circle's centre, rad."""
    x, y, _ = (position_mm - circle.centre_mm).T
    return np.arctan2(y, x)
