"""Mapping files: how to read a table of another program where what is found by itself is not enough or not right.

A mapping states as much as is needed; everything else is detected. It lies beside the file that it is for (`NAME.toml`
for `NAME.csv`, found by itself) or is named (`--mapping`), and is written by ``hexdbb convert --save-mapping``. Options
of the command line are keys of a mapping, and replace those of the file.
"""

from __future__ import annotations

import os
from collections.abc import Mapping as MappingType
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError, model_validator

from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, write_text
from hexdbb.files.validation import BadValueError, FileModel, Number, Positive, dump_toml, load_toml, validation_line
from hexdbb.importing.quantities import QUANTITIES, UNITS_OF, nearest_quantity
from hexdbb.machine import SHIPPED_MACHINE
from hexdbb.plan import Direction, FixingName, shipped_plans

SCHEMA = "hexdbb.mapping/1"
DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "bar": "|", "space": " "}
"""Names of the characters that separate cells; `space` stands for any number of blanks and tabs."""

Words = Annotated[str, Field(min_length=1)]
Line = Annotated[int, Field(ge=0, le=2**31 - 1)]
AtLeastOne = Annotated[int, Field(ge=1, le=2**31 - 1)]
Range = Annotated[tuple[AtLeastOne, AtLeastOne], Field(strict=False)]
Rows = Annotated[tuple[Range, ...], Field(strict=False, min_length=1)]


class Mapping(FileModel):
    """A validated mapping; all keys are optional, what is absent is detected or asked for."""

    schema_id: Literal["hexdbb.mapping/1"] = Field(default="hexdbb.mapping/1", alias="schema")
    """Kind and version of the file."""
    plan: Words | None = None
    """Plan that was driven: gauge, mounts, circles. A path relative to this file, or the name of a shipped plan."""
    machine: Words | None = None
    """Machine file in place of the plan's: a path relative to this file, or the name of the shipped one, `sp120`."""
    circle: Annotated[int, Field(ge=0, le=2**31 - 1)] | None = None
    """Id of the plan's circle; needed where the plan has several and the file has no column for it."""
    mount: FixingName | None = None
    """Name of the set-up: files of the same name were measured without touching the cup between them, so that one
    position of it is fitted for all. Without it every file counts as a set-up of its own."""
    feed_mm_min: Positive | None = None
    """Commanded feed; needed where the circle has several and the file has no column for it."""
    direction: Direction | None = None
    """Direction of all readings, 1 counter-clockwise or -1 clockwise, where the file does not say it."""
    sheet: Words | None = None
    """Excel: name of the sheet."""
    encoding: Words | None = None
    """Text: encoding, as `utf-8`, `cp1252`, `utf-16`."""
    delimiter: Literal["comma", "semicolon", "tab", "bar", "space"] | None = None
    """Text: what separates cells."""
    decimal: Literal[".", ","] | None = None
    """Decimal mark of numbers."""
    header: Line | None = None
    """Line (row of the sheet) that names the columns; 0 where none does."""
    rows: Rows | None = None
    """First and last line (row of the sheet) of the readings, as `[[3, 203]]`; several are read in turn."""
    angle_counts: Literal["place", "travel"] | None = None
    """Whether angles are places on the circle, which fall in a clockwise run, or count up along every run."""
    test: AtLeastOne | None = None
    """Renishaw: number of the test, where the file holds several."""
    start_angle_deg: Number | None = None
    """Renishaw: place of the first reading of each run, where the file does not state angles."""
    arc_deg: Positive | None = None
    """Renishaw: angle from the first reading of a run to its last, along the direction of the run."""
    columns: dict[str, str | AtLeastOne] = Field(default={})
    """Column of a quantity: its name, or its number from 1; empty text: the file's column is not to be used."""
    units: dict[str, str] = Field(default={})
    """Unit of a quantity."""
    directions: dict[str, Direction] = Field(default={})
    """Words of the file for a direction of travel, as `{ links = 1, rechts = -1 }`."""

    @model_validator(mode="after")
    def _known(self) -> Mapping:
        for name in self.columns:
            if name not in QUANTITIES:
                raise BadValueError(("columns", name), self.columns[name], f"a quantity: {nearest_quantity(name)}")
        for name, unit in self.units.items():
            if name not in QUANTITIES or not UNITS_OF[name]:
                raise BadValueError(("units", name), unit, f"a quantity with a unit: {nearest_quantity(name)}")
            if unit not in UNITS_OF[name]:
                raise BadValueError(("units", name), unit, "one of " + ", ".join(UNITS_OF[name]))
        before = 0
        for place, (first, last) in enumerate(self.rows or ()):
            if not before < first <= last:
                raise BadValueError(("rows", place), [first, last], "the first line before the last, in their order")
            before = last
        return self

    def choices(self) -> dict[str, Any]:
        """Return the keys that are given, as `mapping_of` takes them."""
        return self.model_dump(by_alias=True, exclude_unset=True, exclude={"schema_id"}, exclude_none=True)

    def over(self, other: Mapping) -> Mapping:
        """Return a mapping of the keys of this one, and of the other's where this one has none."""
        own = {name: value for name in self.model_fields_set if (value := getattr(self, name)) not in (None, {})}
        for name in ("columns", "units", "directions"):
            own[name] = {**getattr(other, name), **getattr(self, name)}
        return other.model_copy(update=own)


def mapping_of(origin: str = "mapping", **choices: Any) -> Mapping:
    """Return the mapping of some keys; those that are None are left out.

    Raises
    ------
    InputError
        An unknown key, or a wrong value; names `origin`, the key, its value and what was expected.
    """
    try:
        return Mapping.model_validate({key: value for key, value in choices.items() if value is not None})
    except ValidationError as error:
        raise InputError(f"{origin}: {validation_line(error, Mapping)}") from None


def load_mapping(path: Path | str) -> Mapping:
    """Read a mapping file; paths in it become relative to the working directory.

    Raises
    ------
    InputError
        One line naming file, key, value and what was expected.
    """
    found = load_toml(path, Mapping)
    named = {key: _beside(getattr(found, key), Path(path).parent) for key in ("plan", "machine")}
    return found.model_copy(update={key: value for key, value in named.items() if value is not None})


def save_mapping(mapping: Mapping, path: Path, overwrite: bool = False) -> None:
    """Write a mapping file; paths in it become relative to its folder.

    Raises
    ------
    InputError
        The file exists and may not be replaced.
    RunError
        It could not be written.
    """
    refuse_existing(path, overwrite)
    named = {key: getattr(mapping, key) for key in ("plan", "machine")}
    relative = {
        key: value if _is_name(value) else os.path.relpath(value, path.parent) for key, value in named.items() if value
    }
    kept: MappingType[str, Any] = {"schema_id": SCHEMA, **relative}
    write_text(path, dump_toml(mapping.model_copy(update=kept)))


def _beside(named: str | None, folder: Path) -> str | None:
    return named if named is None or _is_name(named) else str(folder / named)


def _is_name(named: str) -> bool:
    return named == SHIPPED_MACHINE or named in shipped_plans()
