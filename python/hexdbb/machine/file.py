"""The machine file: nominal dimensions of a HexGlider, and how its drives are reached.

Model: base triangle of inradius BR with a guideway along each side, two sliders per guideway, six legs of one length l,
platform whose three ball joints lie on a circle of radius UR, IH above its reference point.
Assumption: the nominal machine is symmetric; every departure from it is an effect of the model, not of this file.
Source: the thesis' chapter 2; the frames are those of the project's geometry page.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from hexdbb.errors import InputError
from hexdbb.files.validation import BadValueError, FileModel, Number, Positive, StrictModel, load_toml
from hexdbb.machine.can_setup import CanSetup

SHIPPED_MACHINE = "sp120"
"""Name by which plans and measurements call the shipped machine."""


class Base(StrictModel):
    """The base triangle."""

    inradius_mm: Positive
    """BR: distance of each guideway from the base centre."""


class Platform(StrictModel):
    """The moving platform."""

    circumradius_mm: Positive
    """UR: distance of each ball joint from the platform's axis."""
    joint_plane_height_mm: Number
    """IH: height of the ball joints above the platform's reference point."""
    moved_mass_kg: Positive
    """Mass of platform and tool."""


class Legs(StrictModel):
    """The six legs."""

    length_mm: Positive
    """l: distance between the two joints of a leg."""


class Sliders(StrictModel):
    """The six sliders, two on each guideway."""

    travel_mm: Annotated[tuple[Number, Number], Field(strict=False)]
    """Least and largest slider coordinate."""
    min_gap_mm: Positive
    """Least distance of two sliders on one guideway."""
    screw_lead_mm: Positive
    """Travel per turn of the screw."""

    @model_validator(mode="after")
    def _travel_holds_two_sliders(self) -> Sliders:
        least, largest = self.travel_mm
        if least >= largest:
            raise BadValueError(("travel_mm",), [least, largest], "the least coordinate before the largest")
        if self.min_gap_mm >= largest - least:
            raise BadValueError(("min_gap_mm",), self.min_gap_mm, f"less than the travel, {largest - least:g}")
        return self


class MachineFile(FileModel):
    """A machine file, validated.

    Raises
    ------
    InputError
        From `load_machine`: a key is missing, unknown or wrong, or the machine cannot stand.
    """

    schema_id: Literal["hexdbb.machine/1"] = Field(default="hexdbb.machine/1", alias="schema")
    name: Annotated[str, Field(min_length=1)]
    base: Base
    platform: Platform
    legs: Legs
    sliders: Sliders
    can: CanSetup | None = None
    """Drives and gauge on the bus; analysis does without."""

    @property
    def can_setup(self) -> CanSetup:
        """The `[can]` section, or its defaults where the file has none."""
        return self.can if self.can is not None else CanSetup()

    def eds_path(self, eds: str) -> Path:
        """Find a node's EDS file: beside the machine file, else the shipped one of that name."""
        beside = self.path.parent / eds if self.path is not None else Path(eds)
        return beside if beside.is_file() else shipped("eds", eds)

    @model_validator(mode="after")
    def _stands(self) -> MachineFile:
        reach = abs(self.base.inradius_mm - self.platform.circumradius_mm)
        if self.legs.length_mm <= reach:
            expected = f"more than {reach:g}, the distance between guideway and joint circle: the platform cannot stand"
            raise BadValueError(("legs", "length_mm"), self.legs.length_mm, expected)
        # Centred and level, the two sliders of a guideway stand symmetrically about its midpoint, at s = sqrt(3) BR.
        middle, half_gap = math.sqrt(3.0) * self.base.inradius_mm, self.sliders.min_gap_mm / 2.0
        least, largest = self.sliders.travel_mm
        if least > middle - half_gap or largest < middle + half_gap:
            expected = f"room for two sliders about the guideway's midpoint, {middle:.1f} +- {half_gap:g}"
            raise BadValueError(("sliders", "travel_mm"), [least, largest], expected)
        return self


def shipped(*parts: str) -> Path:
    """Give the path of a data file shipped with the package."""
    return Path(__file__).parents[1].joinpath("data", *parts)


def load_machine(path: Path | str) -> MachineFile:
    """Read a machine file.

    Parameters
    ----------
    path : Path or str
        The TOML file.

    Returns
    -------
    MachineFile

    Raises
    ------
    InputError
        One line naming file, key, value and what was expected.
    """
    return load_toml(path, MachineFile)


def shipped_machine() -> MachineFile:
    """Give the SP-120 as shipped: its dimensions are assumed, as its name and file say."""
    return load_machine(shipped(f"{SHIPPED_MACHINE}.toml"))


def machine_beside(named: str, file: Path) -> MachineFile:
    """Read the machine that another file names: the shipped one by name, else a path relative to that file.

    Parameters
    ----------
    named : str
        Value of the file's `machine` key.
    file : Path
        The plan or measurement file that names it.

    Raises
    ------
    InputError
        Where there is no such machine file, naming `file` and its key.
    """
    if named == SHIPPED_MACHINE:
        return shipped_machine()
    path = file.parent / named
    if not path.is_file():
        expected = f'a machine file relative to this file, or "{SHIPPED_MACHINE}", the shipped one'
        raise InputError(f'{file}: machine: "{named}": no such file {path} (expected {expected})')
    return load_machine(path)
