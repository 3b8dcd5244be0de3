"""Plans: which circles are driven, at which feeds, in which directions, in which order.

A plan is expanded in the order of its file: every circle, for each of its feeds, in each of its directions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from hexdbb.errors import InputError
from hexdbb.files.validation import BadValueError, FileModel, load_toml
from hexdbb.machine import MachineFile, machine_beside, shipped
from hexdbb.plan.circle import Circle, Direction, Directions, Feeds, Gauge, Laps, Mount

__all__ = ["Circle", "CircleRun", "Gauge", "Mount", "Plan", "check_ids", "load_plan", "shipped_plans"]

Mounts = Annotated[tuple[Mount, ...], Field(strict=False, min_length=1)]
Circles = Annotated[tuple[Circle, ...], Field(strict=False, min_length=1)]
Overshoot = Annotated[float, Field(ge=0.0, le=360.0, allow_inf_nan=False)]


@dataclass(frozen=True)
class CircleRun:
    """One uninterrupted capture: a circle at one feed in one direction."""

    circle: Circle
    mount: Mount
    feed_mm_min: float
    """Speed of the centre ball along its circle."""
    direction: Direction
    laps: int
    """Turns that are captured."""
    sweep: int
    """Number of the capture in the plan, from 0, as it stands in the record."""


class Plan(FileModel):
    """A plan file, validated; constructed and read under the file's own keys (`mount`, `circle`)."""

    schema_id: Literal["hexdbb.plan/1"] = Field(default="hexdbb.plan/1", alias="schema")
    machine: Annotated[str, Field(min_length=1)]
    """Machine file relative to the plan's, or the name of the shipped one."""
    feeds_mm_min: Feeds
    directions: Directions
    laps: Laps
    overshoot_deg: Overshoot
    """Angle run before and after the captured laps, at full feed."""
    gauge: Gauge
    mounts: Mounts = Field(alias="mount")
    circles: Circles = Field(alias="circle")

    @model_validator(mode="after")
    def _consistent(self) -> Plan:
        check_ids(self.mounts, self.circles)
        bar_mm, range_mm = self.gauge.bar_length_mm, self.gauge.range_um / 1000.0
        for index, circle in enumerate(self.circles):
            if abs(circle.radius_mm - bar_mm) > range_mm:
                expected = f"the bar's length, {bar_mm:g}, within the gauge's range of {range_mm:g} mm"
                raise BadValueError(("circle", index, "radius_mm"), circle.radius_mm, expected)
        return self

    def machine_file(self) -> MachineFile:
        """Read the machine the plan names.

        Raises
        ------
        InputError
            Where there is none, or it is wrong.
        """
        return machine_beside(self.machine, self.path or Path("plan"))

    def mount_of(self, circle: Circle) -> Mount:
        """Give the mount a circle runs about."""
        return next(mount for mount in self.mounts if mount.id == circle.mount)

    def runs(self) -> list[CircleRun]:
        """Expand circles, feeds and directions in order of execution."""
        expanded = [
            (circle, feed, direction)
            for circle in self.circles
            for feed in circle.feeds_mm_min or self.feeds_mm_min
            for direction in circle.directions or self.directions
        ]
        return [
            CircleRun(circle, self.mount_of(circle), feed, direction, circle.laps or self.laps, sweep)
            for sweep, (circle, feed, direction) in enumerate(expanded)
        ]


def check_ids(mounts: Sequence[Mount], circles: Sequence[Circle]) -> None:
    """Refuse two mounts or circles of one id, and a circle about a mount that is not there.

    Raises
    ------
    BadValueError
        Naming the entry.
    """
    known = [mount.id for mount in mounts]
    for name, ids in (("mount", known), ("circle", [circle.id for circle in circles])):
        for index, identity in enumerate(ids):
            first = ids.index(identity)
            if first != index:
                raise BadValueError((name, index, "id"), identity, f"an id of its own: {name}[{first}] has this one")
    for index, circle in enumerate(circles):
        if circle.mount not in known:
            expected = "the id of a mount: " + ", ".join(map(str, known))
            raise BadValueError(("circle", index, "mount"), circle.mount, expected)


def shipped_plans() -> list[str]:
    """Name the plans shipped with the package."""
    return sorted(path.stem for path in shipped("plans").glob("*.toml"))


def load_plan(name_or_path: Path | str) -> Plan:
    """Read a plan, a shipped one by its name.

    Parameters
    ----------
    name_or_path : Path or str
        ``thesis``, ``standard``, or a TOML file.

    Returns
    -------
    Plan

    Raises
    ------
    InputError
        One line naming file, key, value and what was expected.
    """
    names, path = shipped_plans(), Path(name_or_path)
    if str(name_or_path) in names:
        path = shipped("plans", f"{name_or_path}.toml")
    elif not path.exists():
        raise InputError(f"{path}: no such file (expected a plan file, or a shipped plan: {', '.join(names)})")
    return load_toml(path, Plan)
