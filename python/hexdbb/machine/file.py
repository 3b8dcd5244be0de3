"""The machine file: nominal dimensions of a HexGlider and the CAN set-up of its drives.

Model: base triangle of inradius BR with a guideway along each side, two sliders per guideway, six legs of one length l,
platform with three ball joints on a circle of radius UR, IH above its reference point.
Assumption: the nominal machine is symmetric; every departure from it is an effect of the model, not of this file.
Source: chapter 2 of the thesis. Base frame: origin at the centre of the base triangle, z up.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from hexdbb.errors import InputError
from hexdbb.files.frames import html_table
from hexdbb.files.validation import BadValueError, FileModel, Number, Positive, StrictModel, load_toml
from hexdbb.machine.can_setup import CanSetup
from hexdbb.machine.shipped import SHIPPED_MACHINE, shipped
from hexdbb.machine.tolerance import Tolerance
from hexdbb.machine.watch import Watch


class Base(StrictModel):
    """Base triangle of the guideways."""

    inradius_mm: Positive
    """BR: distance of each guideway from the base centre."""


class Platform(StrictModel):
    """Moving platform."""

    circumradius_mm: Positive
    """UR: distance of each ball joint from the platform's axis."""
    joint_plane_height_mm: Number
    """IH: height of the ball joints above the platform's reference point."""
    moved_mass_kg: Positive
    """Mass of platform and tool, which loads the legs."""


class Legs(StrictModel):
    """Six legs of one length."""

    length_mm: Positive
    """l: distance between the two joints of a leg; long enough for the platform to stand centred and level."""


class Sliders(StrictModel):
    """Six sliders, two on each guideway."""

    travel_mm: Annotated[tuple[Number, Number], Field(strict=False)]
    """Least and largest slider coordinate, the least first."""
    min_gap_mm: Positive
    """Least distance of two sliders on one guideway; less than the travel."""
    screw_lead_mm: Positive
    """Slider travel per turn of the screw."""

    @model_validator(mode="after")
    def _travel_holds_two_sliders(self) -> Sliders:
        least, largest = self.travel_mm
        if least >= largest:
            raise BadValueError(("travel_mm",), [least, largest], "the least coordinate before the largest")
        if self.min_gap_mm >= largest - least:
            raise BadValueError(("min_gap_mm",), self.min_gap_mm, f"less than the travel, {largest - least:g}")
        return self


class MachineFile(FileModel):
    """Validated machine file; a notebook shows it as a table of its keys.

    Raises
    ------
    InputError
        From `load_machine`: a key is missing, unknown or wrong, or the platform cannot stand centred and level.
    """

    schema_id: Literal["hexdbb.machine/1"] = Field(default="hexdbb.machine/1", alias="schema")
    """Kind and version of the file."""
    name: Annotated[str, Field(min_length=1)]
    """Name of the machine, for people."""
    serial_number: Annotated[str, Field(min_length=1)] | None = None
    """Serial number of the machine, for reports."""
    base: Base
    """Base triangle of the guideways."""
    platform: Platform
    """Moving platform."""
    legs: Legs
    """Six legs of one length."""
    sliders: Sliders
    """Six sliders, two on each guideway."""
    tolerance: Tolerance | None = None
    """Largest values of ISO 230-4 quantities that pass, for reports; absent means that nothing is judged."""
    watch: Annotated[tuple[Watch, ...], Field(strict=False)] | None = None
    """Limits of the trend over the machine's records, one table each; absent means that nothing is watched."""
    can: CanSetup | None = None
    """Drives and gauge on the bus; absent means the defaults below. Fits use none of it."""

    def __repr__(self) -> str:
        least, largest = self.sliders.travel_mm
        return (
            f"<MachineFile {self.name}: base inradius {self.base.inradius_mm:g} mm,"
            f" platform circumradius {self.platform.circumradius_mm:g} mm, legs {self.legs.length_mm:g} mm,"
            f" travel {least:g} to {largest:g} mm>"
        )

    def _repr_html_(self) -> str:
        sections = self.model_dump(include={"base", "platform", "legs", "sliders"}).items()
        rows = [(f"{section}.{key}", f"{value}") for section, values in sections for key, value in values.items()]
        return html_table(("key", self.name), rows)

    @property
    def can_setup(self) -> CanSetup:
        """Return the `[can]` section, or its defaults where the file has none."""
        return self.can if self.can is not None else CanSetup()

    def eds_path(self, eds: str) -> Path:
        """Return the path of a node's EDS file: relative to the machine file, else the shipped one of that name."""
        beside = self.path.parent / eds if self.path is not None else Path(eds)
        return beside if _is_file(beside) else shipped("eds", eds)

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
    """Return the shipped SP-120; its dimensions are assumed, as its name and file state."""
    return load_machine(shipped(f"{SHIPPED_MACHINE}.toml"))


def machine_beside(named: str, file: Path) -> MachineFile:
    """Read the machine file that another file names: the shipped one by name, else a path relative to that file.

    Parameters
    ----------
    named : str
        Value of the file's `machine` key.
    file : Path
        The plan or measurement file that names it.

    Raises
    ------
    InputError
        There is no such machine file (names `file` and its key), or it is wrong.
    """
    if named == SHIPPED_MACHINE:
        return shipped_machine()
    path = file.parent / named
    if not _is_file(path):
        expected = f'a machine file relative to this file, or "{SHIPPED_MACHINE}", the shipped one'
        raise InputError(f'{file}: machine: "{named}": no such file {path} (expected {expected})')
    return load_machine(path)


def _is_file(path: Path) -> bool:
    """Return whether a path names a file; a name that the file system cannot have names none."""
    try:
        return path.is_file()
    except OSError:
        return False
