"""Uncertainty of the ball's position over the workspace that a diagnosis leaves.

The covariance of a model's values is propagated to the ball's position at poses over the workspace: D covariance D', D
the position's derivative. A bar to a cup very far away along an axis reads the ball's position along that axis, so that
D is the engine's own analytic derivative of the reading. Effects of motion, time and the cup are left out: they do not
belong to a position. A rigid shift and rotation of the whole base is projected out of D first: no ball bar sees it
while the cup's position is unknown, and to a user of the machine it is a matter of where the workpiece is put.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics import inverse, rotation_from_rpy
from hexdbb.model import Model
from hexdbb.plan import Circle

Floats = NDArray[np.float64]

FAR_MM = 1e9
"""Distance of the cups by which the position is read: far enough for a straight line to a rounding error."""
NOT_OF_PLACE = {"cup", "reading"}
"""Ports whose pushes move nothing on the machine."""
HALF_WIDTH_MM, HALF_HEIGHT_MM, TILT_RAD = 90.0, 15.0, 0.15
"""Poses about the circle: to either side of its centre, and tilts; nearly all within reach of the shipped machine."""
STEPS = 4
"""Poses along each horizontal axis: the uncertainty varies smoothly, and 4 x 4 x 3 positions with 7 tilts map it."""


@dataclass(frozen=True)
class PlaceUncertainty:
    """Standard deviations of the ball's position (root of the sum over x, y, z) at poses over the workspace.

    Attributes
    ----------
    position_mm, rpy_rad : ndarray, shape (n, 3)
        The poses.
    sigma_mm : ndarray, shape (n,)
        Standard deviation at each.
    """

    position_mm: Floats
    rpy_rad: Floats
    sigma_mm: Floats

    @property
    def median_um(self) -> float:
        """Median over the workspace."""
        return float(np.median(self.sigma_mm)) * 1e3

    @property
    def worst_um(self) -> float:
        """Largest over the workspace."""
        return float(np.max(self.sigma_mm)) * 1e3


def place_uncertainty(
    model: Model, covariance: Floats, circle: Circle, cup_mm: tuple[float, float, float]
) -> PlaceUncertainty:
    """Propagate the covariance of a model's values to the ball's position.

    Parameters
    ----------
    model : Model
    covariance : ndarray, shape (size, size)
        Of its values, engine units.
    circle : Circle
        One that was run: its ball, and the height about which the poses stand.
    cup_mm : tuple of float
        Centre of that circle, base frame.

    Returns
    -------
    PlaceUncertainty
        Of all poses in reach of a grid about the circle.
    """
    position, rpy = _grid(circle, cup_mm)
    sliders, status = inverse(model.machine, position, rpy)
    position, rpy, sliders = position[status == 0], rpy[status == 0], sliders[status == 0]
    rates, columns = _rates(model, sliders, np.array(circle.ball_offset_mm))
    turned = np.array([rotation_from_rpy(each) for each in rpy]) @ np.array(circle.ball_offset_mm)
    rates = _without_rigid_motion(rates, position + turned)
    spread = np.sum((rates @ covariance[np.ix_(columns, columns)]) * rates, axis=1)
    return PlaceUncertainty(position, rpy, np.sqrt(spread.reshape(-1, 3).sum(axis=1)))


def _grid(circle: Circle, cup_mm: tuple[float, float, float]) -> tuple[Floats, Floats]:
    centre = np.array(cup_mm) - np.array(circle.ball_offset_mm)
    across = np.linspace(-HALF_WIDTH_MM, HALF_WIDTH_MM, STEPS)
    up = np.linspace(-HALF_HEIGHT_MM, HALF_HEIGHT_MM, 3)
    place = np.stack(np.meshgrid(across, across, up), axis=-1).reshape(-1, 3) + centre
    tilts = TILT_RAD * np.array([[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
    return np.repeat(place, len(tilts), axis=0), np.tile(tilts, (len(place), 1))


def _rates(model: Model, sliders: Floats, ball: Floats) -> tuple[Floats, NDArray[np.intp]]:
    """Return the derivatives of the ball's position, rows x, y, z of pose after pose, and the values they belong to."""
    infos = [model.info(term.effect) for term in model.terms]
    # An effect of the user's own is evaluated in measured samples only: it counts as one that needs a state.
    of_place = [
        not info.needs and model.own(info.name) is None and not set(info.ports) <= NOT_OF_PLACE for info in infos
    ]
    terms = [term for term, counts in zip(model.terms, of_place, strict=True) if counts]
    engine = replace(model, terms=tuple(terms)).engine()
    counts = np.concatenate(
        [np.full(len(term.values), counts) for term, counts in zip(model.terms, of_place, strict=True)]
    )
    poses = len(sliders)
    bars = [_core.SetUp(cup_mm=-FAR_MM * axis, ball_offset_mm=ball, bar_length_mm=FAR_MM) for axis in np.eye(3)]
    samples = _core.Samples(
        sliders_mm=np.repeat(sliders, 3, axis=0),
        set_up=np.tile(np.arange(3, dtype=np.int32), poses),
        mount=np.zeros(3 * poses, dtype=np.int32),
        set_ups=bars,
    )
    rates: Floats = _core.predict(engine, samples, want_jacobian=True).jacobian
    return rates, np.flatnonzero(counts)


def _without_rigid_motion(rates: Floats, places: Floats) -> Floats:
    shifts = [np.tile(axis, (len(places), 1)) for axis in np.eye(3)]
    turns = [np.cross(axis, places) for axis in np.eye(3)]
    basis, _ = np.linalg.qr(np.stack([each.ravel() for each in (*shifts, *turns)], axis=1))
    return rates - basis @ (basis.T @ rates)
