"""Plan files: circles to drive, with their feeds, directions and laps.

Order: the circles as in the file; for each circle its feeds; for each feed its directions.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, PrivateAttr, model_validator

from hexdbb.files.frames import html_table
from hexdbb.files.validation import BadValueError, FileModel, load_toml
from hexdbb.machine import MachineFile, machine_beside, shipped_names, shipped_or_own
from hexdbb.plan.circle import Circle, Direction, Directions, Feeds, Laps
from hexdbb.plan.conditions import Conditions
from hexdbb.plan.gauge import Gauge
from hexdbb.plan.mount import Mount

Mounts = Annotated[tuple[Mount, ...], Field(strict=False, min_length=1)]
Circles = Annotated[tuple[Circle, ...], Field(strict=False, min_length=1)]
Overshoot = Annotated[float, Field(ge=0.0, le=360.0, allow_inf_nan=False)]


@dataclass(frozen=True)
class CircleRun:
    """One sweep to drive: a circle at one feed in one direction, captured without interruption.

    Attributes
    ----------
    circle : the circle
    mount : the mount it is centred on
    feed_mm_min : speed of the centre ball along its circle
    direction : +1 counter-clockwise seen from above the circle's plane, -1 clockwise
    laps : captured turns
    sweep : number of the sweep in the plan and in the record, from 0
    """

    circle: Circle
    mount: Mount
    feed_mm_min: float
    direction: Direction
    laps: int
    sweep: int


class Plan(FileModel):
    """Validated plan file; constructed under the file's own keys (`mount`, `circle`). A notebook shows its runs."""

    schema_id: Literal["hexdbb.plan/1"] = Field(default="hexdbb.plan/1", alias="schema")
    """Kind and version of the file."""
    machine: Annotated[str, Field(min_length=1)]
    """Path of the machine file relative to the plan file, or the name of the shipped one, `sp120`."""
    feeds_mm_min: Feeds
    """Speeds of the centre ball along its circle; each circle is driven at every one."""
    directions: Directions
    """+1 counter-clockwise seen from above the circle's plane, -1 clockwise, in order of driving."""
    laps: Laps
    """Captured turns per sweep."""
    overshoot_deg: Overshoot
    """Angle driven at full feed before and after the captured laps."""
    gauge: Gauge
    """Ball bar and length gauge."""
    conditions: Conditions | None = None
    """Conditions of the test, for reports; options of `hexdbb-run` replace them."""
    mounts: Mounts = Field(alias="mount")
    """Set-ups of the cup, one table each."""
    circles: Circles = Field(alias="circle")
    """Circles in order of driving, one table each."""

    _machine: MachineFile | None = PrivateAttr(default=None)

    @model_validator(mode="after")
    def _consistent(self) -> Plan:
        check_ids(self.mounts, self.circles)
        bar_mm, range_mm = self.gauge.bar_length_mm, self.gauge.range_um / 1000.0
        for index, circle in enumerate(self.circles):
            if abs(circle.radius_mm - bar_mm) > range_mm:
                expected = f"the bar's length, {bar_mm:g}, within the gauge's range of {range_mm:g} mm"
                raise BadValueError(("circle", index, "radius_mm"), circle.radius_mm, expected)
        return self

    def __repr__(self) -> str:
        name = self.path.name if self.path is not None else "plan"
        nouns = {"circle": self.circles, "mount": self.mounts, "run": self.runs()}
        counts = ", ".join(f"{len(each)} {noun}{'s' * (len(each) != 1)}" for noun, each in nouns.items())
        return f"<Plan {name}: machine {self.machine}, {counts}, {self.overshoot_deg:g}° overshoot>"

    def _repr_html_(self) -> str:
        heads = ("sweep", "circle", "mount", "radius, mm", "feed, mm/min", "direction", "laps", "platform rpy, °")
        rows = [
            (
                *(str(run.sweep), str(run.circle.id), str(run.mount.id), f"{run.circle.radius_mm:g}"),
                *(f"{run.feed_mm_min:g}", f"{run.direction:+d}", str(run.laps)),
                ", ".join(f"{angle:g}" for angle in run.circle.platform_rpy_deg),
            )
            for run in self.runs()
        ]
        return html_table(heads, rows)

    def machine_file(self) -> MachineFile:
        """Read the machine file that the plan names.

        Raises
        ------
        InputError
            There is none, or it is wrong.
        """
        if self._machine is not None:
            return self._machine
        return machine_beside(self.machine, self.path or Path("plan"))

    def with_machine(self, machine: MachineFile) -> Plan:
        """Return the same plan on a machine at hand: `machine_file` returns it, and no file is read, wherever it is.

        Its `machine` is then a name made of the machine's content, so that plans on different machines differ.
        """
        content = hashlib.sha256(machine.model_dump_json(by_alias=True).encode()).hexdigest()
        plan = self.model_copy(update={"machine": f"{machine.name} {content[:16]}"})
        plan._machine = machine
        return plan

    def mount_of(self, circle: Circle) -> Mount:
        """Return the mount that a circle is centred on."""
        return next(mount for mount in self.mounts if mount.id == circle.mount)

    def runs(self) -> list[CircleRun]:
        """Return every circle at each feed in each direction, in order of driving."""
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
    """Check that ids are unique and that every circle's mount exists.

    Raises
    ------
    BadValueError
        They are not; names the entry.
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
    """Return the names of the plans shipped with the package, sorted."""
    return shipped_names("plans")


def load_plan(name_or_path: Path | str) -> Plan:
    """Read a plan file, or a shipped plan by its name.

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
    return load_toml(shipped_or_own(name_or_path, "plan", "plans"), Plan)
