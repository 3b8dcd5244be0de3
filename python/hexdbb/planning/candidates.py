"""The circles among which a plan is chosen: a grid of cup places, platform orientations, circle planes and radii.

A candidate is a circle about a cup. The grid covers the workspace; `neighbours` are steps off the grid, smaller each
time, by which the choice is refined. Radii may differ from the bar's length on purpose, which separates a gauge's scale
error from geometry; by at most `OFF_NOMINAL` of the gauge's range.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from math import cos, radians, sin

from hexdbb.machine import MachineFile
from hexdbb.plan import Circle, Plan
from hexdbb.planning.clearances import CirclePath, RequiredClearances

Triple = tuple[float, float, float]

OFF_NOMINAL = 0.4
"""Largest deliberate deviation of a radius from the bar's length, as a share of the gauge's range: the remaining 0.6
hold the readings that the machine's errors cause and the feed-in."""

SIXTHS = (0.0, 60.0, 120.0, 180.0, 240.0, 300.0)
"""Azimuths of tilts, deg: the machine has a symmetry of 120 deg, and a tilt and its opposite differ."""


@dataclass(frozen=True)
class Grid:
    """Values that are combined: angles in degrees, cup positions relative to the template plan's, in bar lengths.

    The defaults reach as far as the shipped machine does with the bar angles of `RequiredClearances`.
    """

    heights: tuple[float, ...] = (-0.6, -0.4, -0.2, 0.0, 0.2)
    """Vertical displacements of the cup."""
    places: tuple[float, ...] = (0.0, 0.2, 0.4)
    """Horizontal displacements of the cup."""
    place_azimuths: tuple[float, ...] = (30.0, 150.0, 270.0)
    tilts: tuple[float, ...] = (0.0, 6.0, 12.0, 18.0)
    """Tilts of the platform from level."""
    tilt_azimuths: tuple[float, ...] = SIXTHS
    yaws: tuple[float, ...] = (-20.0, 0.0, 20.0)
    plane_tilts: tuple[float, ...] = (0.0, 8.0, 16.0, 24.0)
    """Tilts of the circle's plane from horizontal."""
    plane_azimuths: tuple[float, ...] = SIXTHS


GRIDS: Mapping[str, Grid] = {
    "fine": Grid(),
    "coarse": Grid(
        heights=(-0.2, 0.0), places=(0.0,), tilts=(0.0, 12.0), yaws=(-15.0, 0.0, 15.0), plane_tilts=(0.0, 16.0)
    ),
}


@dataclass(frozen=True)
class CandidateCircle:
    """One circle about a cup."""

    cup_mm: Triple
    plane_rpy_deg: Triple
    platform_rpy_deg: Triple
    radius_mm: float

    def circle(self, template: Plan, identity: int = 0, mount: int = 0) -> Circle:
        """Return the circle, with the ball offset of a template plan's first circle."""
        return Circle(
            id=identity,
            mount=mount,
            radius_mm=self.radius_mm,
            ball_offset_mm=template.circles[0].ball_offset_mm,
            plane_rpy_deg=self.plane_rpy_deg,
            platform_rpy_deg=self.platform_rpy_deg,
        )


def grid_candidates(
    template: Plan, machine: MachineFile, required: RequiredClearances, grid: Grid
) -> Iterator[list[CandidateCircle]]:
    """Yield the circles of the grid that keep the required clearances, one list per cup position, which may be empty.

    Parameters
    ----------
    template : Plan
        Its first mount is the centre of the cup positions; its gauge has the bar.
    machine : MachineFile
    required : RequiredClearances
    grid : Grid
    """
    centre, bar_mm = template.mounts[0].cup_mm, template.gauge.bar_length_mm
    orientations = [
        _rounded((roll, pitch, yaw)) for roll, pitch in _directions(grid.tilts, grid.tilt_azimuths) for yaw in grid.yaws
    ]
    planes = [_rounded((roll, pitch, 0.0)) for roll, pitch in _directions(grid.plane_tilts, grid.plane_azimuths)]
    for height, (x, y) in product(grid.heights, _directions(grid.places, grid.place_azimuths)):
        cup = _rounded((centre[0] + x * bar_mm, centre[1] + y * bar_mm, centre[2] + height * bar_mm))
        every = (CandidateCircle(cup, plane, platform, bar_mm) for platform, plane in product(orientations, planes))
        yield list(within_reach(every, template, machine, required))


def neighbours(candidate: CandidateCircle, step_deg: float) -> Iterator[CandidateCircle]:
    """Yield the circles that differ from a candidate by one step, deg, in one angle of plane or platform."""
    cup, plane, platform = candidate.cup_mm, candidate.plane_rpy_deg, candidate.platform_rpy_deg
    for axis, step in product(range(3), (-step_deg, step_deg)):
        yield CandidateCircle(cup, plane, _moved(platform, axis, step), candidate.radius_mm)
        if axis < 2:
            yield CandidateCircle(cup, _moved(plane, axis, step), platform, candidate.radius_mm)


def other_radii(candidate: CandidateCircle, template: Plan) -> Iterator[CandidateCircle]:
    """Yield the same circle with the other radii that are tried: the bar's length, and `OFF_NOMINAL` to either side."""
    bar_mm, off_mm = template.gauge.bar_length_mm, OFF_NOMINAL * template.gauge.range_um / 1000.0
    for radius_mm in (bar_mm - off_mm, bar_mm, bar_mm + off_mm):
        if radius_mm != candidate.radius_mm:
            yield replace(candidate, radius_mm=radius_mm)


def within_reach(
    candidates: Iterable[CandidateCircle], template: Plan, machine: MachineFile, required: RequiredClearances
) -> Iterator[CandidateCircle]:
    """Yield the candidates that the machine can follow with the required clearances."""
    for each in candidates:
        if required.met_by(CirclePath(machine, each.circle(template), each.cup_mm)):
            yield each


def _directions(sizes: tuple[float, ...], azimuths: tuple[float, ...]) -> list[tuple[float, float]]:
    """Return the vectors of each size in each direction; size zero gives one."""
    vectors = [
        (round(size * cos(radians(azimuth)), 6) + 0.0, round(size * sin(radians(azimuth)), 6) + 0.0)
        for size in sizes
        for azimuth in azimuths
    ]
    return list(dict.fromkeys(vectors))


def _moved(rpy_deg: Triple, axis: int, step_deg: float) -> Triple:
    moved = list(rpy_deg)
    moved[axis] = round(moved[axis] + step_deg, 3) + 0.0
    return (moved[0], moved[1], moved[2])


def _rounded(vector: Triple) -> Triple:
    x, y, z = (round(each, 3) + 0.0 for each in vector)
    return (x, y, z)
