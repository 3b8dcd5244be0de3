"""The circles among which a plan is chosen: a grid of cup places, platform orientations, circle planes and radii.

A candidate is a circle about a cup. The grid covers what the machine reaches; `neighbours` are steps off it, smaller
each time, by which the choice is refined. Radii may differ from the bar's length on purpose, which shows a gauge's
scale error; by at most `OFF_NOMINAL` of the gauge's range, so that the machine's errors and the feed-in still find
room in it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from math import cos, radians, sin

from hexdbb.machine import MachineFile
from hexdbb.plan import Circle, Plan
from hexdbb.planning.clearances import Demands, circle_clearances

Triple = tuple[float, float, float]

OFF_NOMINAL = 0.4


SIXTHS = (0.0, 60.0, 120.0, 180.0, 240.0, 300.0)
"""The machine's own symmetry: thirds of a turn, and the directions between."""


@dataclass(frozen=True)
class Grid:
    """What is tried: angles in degrees, places of the cup in parts of the bar's length about the plan's own."""

    heights: tuple[float, ...] = (-0.6, -0.4, -0.2, 0.0, 0.2)
    places: tuple[float, ...] = (0.0, 0.2, 0.4)
    """Distances of the cup from where the plan has it, sideways."""
    place_azimuths: tuple[float, ...] = (30.0, 150.0, 270.0)
    tilts: tuple[float, ...] = (0.0, 6.0, 12.0, 18.0)
    """Of the platform from level."""
    tilt_azimuths: tuple[float, ...] = SIXTHS
    yaws: tuple[float, ...] = (-20.0, 0.0, 20.0)
    plane_tilts: tuple[float, ...] = (0.0, 8.0, 16.0, 24.0)
    """Of the circle's plane from horizontal."""
    plane_azimuths: tuple[float, ...] = SIXTHS


GRIDS: Mapping[str, Grid] = {
    "fine": Grid(),
    "coarse": Grid(
        heights=(-0.2, 0.0), places=(0.0,), tilts=(0.0, 12.0), yaws=(-15.0, 0.0, 15.0), plane_tilts=(0.0, 16.0)
    ),
}


@dataclass(frozen=True)
class Candidate:
    """One circle about a cup."""

    cup_mm: Triple
    plane_rpy_deg: Triple
    platform_rpy_deg: Triple
    radius_mm: float

    def circle(self, like: Plan, identity: int = 0, mount: int = 0) -> Circle:
        """Give the circle, with the ball of a plan's first circle."""
        return Circle(
            id=identity,
            mount=mount,
            radius_mm=self.radius_mm,
            ball_offset_mm=like.circles[0].ball_offset_mm,
            plane_rpy_deg=self.plane_rpy_deg,
            platform_rpy_deg=self.platform_rpy_deg,
        )


def grid_candidates(like: Plan, machine: MachineFile, demands: Demands, grid: Grid) -> Iterator[list[Candidate]]:
    """Yield the circles of the grid that the machine can follow, one list a cup place; a list may be empty."""
    centre, bar_mm = like.mounts[0].cup_mm, like.gauge.bar_length_mm
    orientations = [
        _rounded((roll, pitch, yaw)) for roll, pitch in _directions(grid.tilts, grid.tilt_azimuths) for yaw in grid.yaws
    ]
    planes = [_rounded((roll, pitch, 0.0)) for roll, pitch in _directions(grid.plane_tilts, grid.plane_azimuths)]
    for height, (x, y) in product(grid.heights, _directions(grid.places, grid.place_azimuths)):
        cup = _rounded((centre[0] + x * bar_mm, centre[1] + y * bar_mm, centre[2] + height * bar_mm))
        every = (Candidate(cup, plane, platform, bar_mm) for platform, plane in product(orientations, planes))
        yield list(within_reach(every, like, machine, demands))


def neighbours(candidate: Candidate, step_deg: float) -> Iterator[Candidate]:
    """Yield the same circle with one angle of plane or platform changed by a step."""
    cup, plane, platform = candidate.cup_mm, candidate.plane_rpy_deg, candidate.platform_rpy_deg
    for axis, step in product(range(3), (-step_deg, step_deg)):
        yield Candidate(cup, plane, _moved(platform, axis, step), candidate.radius_mm)
        if axis < 2:
            yield Candidate(cup, _moved(plane, axis, step), platform, candidate.radius_mm)


def other_radii(candidate: Candidate, like: Plan) -> Iterator[Candidate]:
    """Yield the same circle as long as the bar, and deliberately a little smaller and larger."""
    bar_mm, off_mm = like.gauge.bar_length_mm, OFF_NOMINAL * like.gauge.range_um / 1000.0
    for radius_mm in (bar_mm - off_mm, bar_mm, bar_mm + off_mm):
        if radius_mm != candidate.radius_mm:
            yield replace(candidate, radius_mm=radius_mm)


def within_reach(
    candidates: Iterable[Candidate], like: Plan, machine: MachineFile, demands: Demands
) -> Iterator[Candidate]:
    """Yield those that the machine can follow with the clearances demanded."""
    for each in candidates:
        found = circle_clearances(machine, each.circle(like), each.cup_mm)
        if found is not None and demands.met_by(found):
            yield each


def _directions(sizes: tuple[float, ...], azimuths: tuple[float, ...]) -> list[tuple[float, float]]:
    """Give vectors of each size in each direction; one only of size zero."""
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
