"""The machine file: nominal dimensions of a HexGlider and the CAN set-up of its drives.

Model: three guideways at distance BR from the base centre, two sliders per guideway, six legs of length l, platform
with three ball joints on a circle of radius UR, IH above its reference point. In the machine of the thesis guideways
and ball joints lie at thirds of a turn and all legs and travels are alike; a file may state them one by one.
Assumption: the file has the drawing's dimensions; every departure from the drawing is an effect of the model.
Source: chapter 2 of the thesis. Base frame: origin at the base centre, z up.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from hexdbb.errors import InputError
from hexdbb.files.frames import html_table
from hexdbb.files.validation import BadValueError, FileModel, load_toml
from hexdbb.machine.can_setup import CanSetup
from hexdbb.machine.dimensions import Base, Legs, Platform, Sliders
from hexdbb.machine.home import home_heights_mm, home_legs
from hexdbb.machine.limits_of_use import Joints, Workspace
from hexdbb.machine.shipped import SHIPPED_MACHINE, shipped
from hexdbb.machine.tolerance import Tolerance
from hexdbb.machine.watch import Watch


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
    """Guideways about the base centre."""
    platform: Platform
    """Moving platform."""
    legs: Legs
    """Six legs, two on each guideway."""
    sliders: Sliders
    """Six sliders, two on each guideway."""
    joints: Joints | None = None
    """How far the joints turn; absent means that they are not looked at."""
    workspace: Workspace | None = None
    """Where the platform is wanted, for `hexdbb machine check`; absent means one is chosen by the machine's size."""
    tolerance: Tolerance | None = None
    """Largest values of ISO 230-4 quantities that pass, for reports; absent means that nothing is judged."""
    watch: Annotated[tuple[Watch, ...], Field(strict=False)] | None = None
    """Limits of the trend over the machine's records, one table each; absent means that nothing is watched."""
    can: CanSetup | None = None
    """Drives and gauge on the bus; absent means the defaults below. Fits use none of it."""

    def __repr__(self) -> str:
        legs, travels = dict.fromkeys(self.legs.lengths_mm), dict.fromkeys(self.sliders.travels_mm)
        return (
            f"<MachineFile {self.name}: base inradius {self.base.inradius_mm:g} mm,"
            f" platform circumradius {self.platform.circumradius_mm:g} mm,"
            f" legs {', '.join(f'{each:g}' for each in legs)} mm,"
            f" travel {', '.join(f'{least:g} to {largest:g}' for least, largest in travels)} mm>"
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
        """Check that the machine reaches its home: the platform centred, level and untwisted at some height."""
        legs = home_legs(self)
        for k, (leg, travel_mm) in enumerate(zip(legs, self.sliders.travels_mm, strict=True)):
            if leg.length_mm <= leg.aside_mm:
                expected = f"more than {leg.aside_mm:.6g}, the distance between guideway and joint circle: the platform"
                raise BadValueError(("legs", *self.legs.length_key(k)), leg.length_mm, f"{expected} cannot stand")
            near, far = leg.span_range_mm(travel_mm)
            if far < near:
                ends = sorted((leg.foot_mm, leg.place_mm(leg.widest_mm)))
                expected = f"some of {ends[0]:.1f} to {ends[1]:.1f}, where slider {k + 1} stands with the platform"
                raise BadValueError(
                    ("sliders", *self.sliders.travel_key(k)), list(travel_mm), f"{expected} centred and level"
                )
        least, largest = home_heights_mm(self)
        if least > largest:
            travels = [list(each) for each in self.sliders.travels_mm]
            whole = self.sliders.travel_key(0) == ("travel_mm",)
            expected = (
                f"travels that leave a height at which the platform stands centred and level with gaps of"
                f" {self.sliders.min_gap_mm:g}: the joints would be {least:.1f} high or more, and {largest:.1f} or less"
            )
            raise BadValueError(("sliders", "travel_mm"), travels[0] if whole else travels, expected)
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
