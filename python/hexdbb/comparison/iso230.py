"""Circular test quantities of ISO 230-4, evaluated on ball-bar paths.

Model: the **nominal path** is the circle of nominal radius; the **actual path** has, at the commanded polar angle in
the circle's plane, the nominal radius plus a radial deviation. With a ball bar the radius is the distance from the ball
to the centre of the tool cup, so the deviation is the reading plus bar length minus nominal radius, exactly where the
cup lies in the circle's plane.

Names and definitions are those of ISO 230-4:2005 as docs/circular-test-quantities.md summarises them; the 2022 edition
says "error" for "deviation" and is otherwise taken to mean the same. Compare with the standard's own text before
quoting a value in an acceptance protocol.

Choices the standard leaves open, the same for measured and predicted paths:

* several laps of one direction are first averaged to one mean path on a common grid of angles (`mean_path`), so that a
  quantity does not grow with the number of laps; one lap is evaluated sample by sample, unsmoothed;
* two directions are compared on a common grid of angles by periodic linear interpolation;
* the set-up's centre offset is the centre of the least squares circle; both directions share one set-up and so one
  centre.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hexdbb import _core
from hexdbb.comparison.circle_fit import least_squares_circle, minimum_zone
from hexdbb.errors import InputError

FloatArray = npt.NDArray[np.float64]

EDITION = "ISO 230-4:2005"
FULL_TURN_RAD = 2.0 * np.pi
MAX_GAP_RAD = float(np.deg2rad(15.0))
"""Largest arc without a sample that still counts as a full circle: fast circles may have a sample in four degrees only,
and 15 degrees hide 3 % of the amplitude of an ellipse at most."""


@dataclass(frozen=True)
class Path:
    """One direction's actual path.

    Attributes
    ----------
    angle_rad : (n,) array
        Commanded polar angle in [0, 2 pi), increasing.
    deviation_mm : (n,) array
        Actual minus nominal radius.
    nominal_radius_mm : float
        Radius of the nominal path.
    """

    angle_rad: FloatArray
    deviation_mm: FloatArray
    nominal_radius_mm: float

    @cached_property
    def points_mm(self) -> FloatArray:
        """The path in its plane, (n, 2), origin at the nominal centre."""
        return _core.path_points_mm(self.angle_rad, self.deviation_mm, self.nominal_radius_mm)

    @cached_property
    def least_squares(self) -> _core.FittedCircle:
        """The least squares circle through the path, origin at the nominal centre."""
        return least_squares_circle(self.points_mm)

    @cached_property
    def is_full_circle(self) -> bool:
        """Whether no arc longer than `MAX_GAP_RAD` is without a sample."""
        return _core.largest_gap_rad(self.angle_rad) <= MAX_GAP_RAD

    def deviation_at(self, angle_rad: FloatArray) -> FloatArray:
        """Return the deviation (mm) at other angles, by periodic linear interpolation."""
        return _core.deviation_at(self.angle_rad, self.deviation_mm, angle_rad)

    def about(self, centre_mm: FloatArray) -> Path:
        """Return the path with its radii from another centre (2,), in mm; the commanded angles stay."""
        offset = self.points_mm - centre_mm
        radius = np.hypot(offset[:, 0], offset[:, 1])
        return Path(self.angle_rad, radius - self.nominal_radius_mm, self.nominal_radius_mm)


@dataclass(frozen=True)
class RadialDeviation:
    """Radial deviation F: largest and smallest distance of the actual from the nominal path, in mm, signed outward."""

    max_mm: float
    min_mm: float


def make_path(angle_rad: FloatArray, deviation_mm: FloatArray, nominal_radius_mm: float) -> Path:
    """Return the path of one lap from samples in any order; angles are taken modulo one turn.

    Raises
    ------
    InputError
        No samples, arrays of different shape, a value that is not finite or a radius that is not positive.
    """
    angle, deviation = _checked(angle_rad, deviation_mm, nominal_radius_mm)
    return Path(*_core.make_path(angle, deviation), float(nominal_radius_mm))


def lap_mean_path(
    angle_rad: FloatArray, deviation_mm: FloatArray, nominal_radius_mm: float, turn: npt.NDArray[np.int64]
) -> Path:
    """Return the `mean_path` of laps from samples in any order; `turn` (n,) numbers the lap of each.

    Raises
    ------
    InputError
        As `make_path`.
    """
    whole = np.arange(len(angle_rad))
    return lap_mean_paths(angle_rad, deviation_mm, turn, [whole], [nominal_radius_mm])[0]


def lap_mean_paths(
    angle_rad: FloatArray,
    deviation_mm: FloatArray,
    turn: npt.NDArray[np.int64],
    captures: Sequence[npt.NDArray[np.intp]],
    nominal_radius_mm: Sequence[float],
) -> list[Path]:
    """Return the `lap_mean_path` of several captures, each by its rows and with its nominal radius.

    Raises
    ------
    InputError
        As `make_path`.
    """
    angle, deviation = _checked(angle_rad, deviation_mm, min(nominal_radius_mm))
    found = _core.mean_paths(angle, deviation, turn, captures, MAX_GAP_RAD)
    return [Path(*each, float(radius_mm)) for each, radius_mm in zip(found, nominal_radius_mm, strict=True)]


def _checked(
    angle_rad: FloatArray, deviation_mm: FloatArray, nominal_radius_mm: float
) -> tuple[FloatArray, FloatArray]:
    angle, deviation = np.asarray(angle_rad, dtype=np.float64), np.asarray(deviation_mm, dtype=np.float64)
    if angle.ndim != 1 or angle.shape != deviation.shape or angle.size == 0:
        raise InputError(f"a path needs angles and deviations of one length, got {angle.shape} and {deviation.shape}")
    if not (np.isfinite(angle).all() and np.isfinite(deviation).all()):
        raise InputError("a path needs finite angles and deviations")
    if not nominal_radius_mm > 0.0:
        raise InputError(f"a path needs a positive nominal radius, got {nominal_radius_mm} mm")
    return angle, deviation


def mean_path(laps: Sequence[Path]) -> Path:
    """Return the mean of several laps of one direction; a single lap is returned as it is.

    The common angles are as many as the shortest lap has samples, evenly spaced. A lap that is not a full circle (a
    capture that was cut short) does not enter the mean as long as another one is.

    Raises
    ------
    InputError
        No laps, or laps of different nominal radius.
    """
    if not laps:
        raise InputError("a mean path needs at least one lap")
    if len({lap.nominal_radius_mm for lap in laps}) != 1:
        raise InputError(f"laps of different nominal radius: {sorted({lap.nominal_radius_mm for lap in laps})} mm")
    turn = np.repeat(np.arange(len(laps), dtype=np.int64), [len(lap.angle_rad) for lap in laps])
    angle_rad, deviation_mm = (
        np.concatenate([getattr(lap, name) for lap in laps]) for name in ("angle_rad", "deviation_mm")
    )
    return lap_mean_path(angle_rad, deviation_mm, laps[0].nominal_radius_mm, turn)


def even_angles(count: int) -> FloatArray:
    """Return `count` evenly spaced angles of one turn, in rad, from 0."""
    return np.arange(count, dtype=np.float64) * (FULL_TURN_RAD / count)


def circular_deviation_mm(path: Path) -> float:
    """Return the circular deviation G: radial separation of the minimum zone that encloses one actual path.

    ISO 230-4:2005 (2022: circular error). The zone is found exactly, see `circle_fit`; it does not depend on
    where the set-up put the centre.
    """
    return minimum_zone(path.points_mm).width_mm


def bidirectional_circular_deviation_mm(ccw: Path, cw: Path) -> float:
    """Return the bi-directional circular deviation G(b): the minimum zone that encloses both directions' actual paths.

    ISO 230-4:2005 (2022: bi-directional circular error). Never smaller than either direction's G.
    """
    return minimum_zone(np.vstack([ccw.points_mm, cw.points_mm])).width_mm


def circular_hysteresis_mm(ccw: Path, cw: Path) -> float:
    """Return the circular hysteresis H: largest radial difference, unsigned, of the two directions' paths at one angle.

    ISO 230-4:2005. Both paths are interpolated onto every angle that either of them has, so no sample is left out.
    """
    return _core.circular_hysteresis_mm((ccw.angle_rad, ccw.deviation_mm), (cw.angle_rad, cw.deviation_mm))


def set_up_centre_mm(*paths: Path) -> FloatArray:
    """Return the centre offset (2,) of the set-up: centre of the least squares circle through all given paths."""
    return least_squares_circle(np.vstack([path.points_mm for path in paths])).centre_mm


def radial_deviation(path: Path, centre_mm: FloatArray | None) -> RadialDeviation:
    """Return the radial deviation F, max and min: distance of the actual path from the nominal path.

    ISO 230-4:2005 (2022: radial error).

    Parameters
    ----------
    path : Path
        One direction's actual path.
    centre_mm : (2,) array or None
        Set-up offset to remove, normally `set_up_centre_mm` of both directions; None leaves the set-up's offset in.
        State which was done wherever F is printed.
    """
    deviation = path.deviation_mm if centre_mm is None else path.about(centre_mm).deviation_mm
    return RadialDeviation(max_mm=float(deviation.max()), min_mm=float(deviation.min()))


def mean_bidirectional_radial_deviation_mm(ccw: Path, cw: Path) -> float:
    """Return the mean bi-directional radial deviation D: mean least squares radius of both directions minus nominal.

    ISO 230-4:2005 (2022: mean bi-directional radial error). Positive when the machine's circle is too large.
    """
    radii = [path.least_squares.radius_mm for path in (ccw, cw)]
    return float(np.mean(radii)) - ccw.nominal_radius_mm
