"""Which column of a table holds which quantity, in which unit: as the mapping says, else as the headings do."""

from __future__ import annotations

from dataclasses import dataclass

from hexdbb.errors import InputError
from hexdbb.importing.clock import holds_days
from hexdbb.importing.mapping import Mapping
from hexdbb.importing.quantities import UNITS_OF, recognised, stated_unit
from hexdbb.importing.table import Table

READINGS = ("reading", "reading_ccw", "reading_cw")


@dataclass(frozen=True, eq=False)
class Column:
    """One column of a table.

    Attributes
    ----------
    quantity : str
    heading : str
        As the file has it; its number where it has none.
    place : int
        Its number in the table, from 0.
    unit : str or None
        None of a quantity without units, and of times that are clock times.
    is_stated : bool
        Whether the mapping states the unit, so that it is not doubted.
    """

    quantity: str
    heading: str
    place: int
    unit: str | None
    is_stated: bool

    def __str__(self) -> str:
        return f'"{self.heading}"'


def assigned(table: Table, mapping: Mapping) -> dict[str, Column]:
    """Return the column of each quantity that a table holds.

    Raises
    ------
    InputError
        A column that the mapping names is not there, a quantity has two columns, or there is no angle or no reading.
    """
    name = table.grid.name
    found: dict[str, Column] = {}
    twice: dict[str, int] = {}
    wanted = mapping.columns
    given = {quantity: _place(table, quantity, column) for quantity, column in wanted.items() if column != ""}
    for quantity, place in given.items():
        found[quantity] = _column(table, quantity, place, mapping)
    for place, heading in enumerate(table.headings):
        named, _ = recognised(heading) if heading else (None, None)
        quantity = named or ""
        if not quantity or place in given.values() or quantity in wanted:
            continue
        if quantity == "time" and holds_days(table, place):
            continue
        if quantity in found:
            twice.setdefault(quantity, place)
        else:
            found[quantity] = _column(table, quantity, place, mapping)
    _require_one_table(table, found, twice, mapping)
    if twice:
        quantity, place = next(iter(twice.items()))
        first = found[quantity].place
        both = f'"{found[quantity].heading}" and "{table.headings[place]}" (columns {first + 1} and {place + 1})'
        expected = f"one; --column {quantity}={first + 1} chooses the first"
        raise InputError(f"{name}: {quantity}: two columns, {both} (expected {expected})")
    _by_unit(table, found, mapping)
    return _checked(table, found)


def _place(table: Table, quantity: str, column: str | int) -> int:
    """Return the number (from 0) of a column that a mapping names."""
    if isinstance(column, int):
        if column > len(table.headings):
            expected = f"at most {len(table.headings)}, the number of columns"
            raise InputError(f"{table.grid.name}: column {quantity}: {column} (expected {expected})")
        return column - 1
    matching = [place for place, heading in enumerate(table.headings) if heading.casefold() == column.casefold()]
    matching = matching or [p for p, h in enumerate(table.headings) if h.casefold().startswith(column.casefold())]
    if len(matching) != 1:
        there = ", ".join(f'"{each}"' for each in table.headings if each) or "none: name it by its number"
        count = "is not there" if not matching else f"is there {len(matching)} times"
        raise InputError(f'{table.grid.name}: column {quantity}: "{column}" {count} (expected one of {there})')
    return matching[0]


def _column(table: Table, quantity: str, place: int, mapping: Mapping) -> Column:
    heading = table.headings[place]
    unit = mapping.units.get(quantity)
    if unit is None and quantity in ("reading_ccw", "reading_cw"):
        unit = mapping.units.get("reading")
    stated = stated_unit(heading)
    stated = stated if stated in UNITS_OF[quantity] else None
    return Column(quantity, heading or str(place + 1), place, unit or stated, unit is not None)


def _require_one_table(table: Table, found: dict[str, Column], twice: dict[str, int], mapping: Mapping) -> None:
    """Check that there are no two tables side by side, each with angles and readings of its own.

    Raises
    ------
    InputError
        There are; names the options that read either.
    """
    named = [recognised(heading)[0] if heading else None for heading in table.headings]
    angles = [place for place, quantity in enumerate(named) if quantity == "angle"]
    readings = [place for place, quantity in enumerate(named) if quantity in READINGS]
    chosen = all(each in mapping.columns for each in ("angle", *({"reading_ccw", "reading_cw"} & set(found))))
    is_wide = {"reading_ccw", "reading_cw"} <= set(found)
    if len(angles) < 2 or len(readings) < 2 or not (is_wide or "reading" in twice) or chosen:
        return
    ends = [*angles[1:], len(named)]
    choices = []
    for first, last in zip(angles, ends, strict=True):
        own = {
            ("reading" if named[k] in READINGS else str(named[k])): k
            for k in range(last - 1, first - 1, -1)
            if named[k]
        }
        words = [f"--column {quantity}={place + 1}" for quantity, place in sorted(own.items())]
        words += [f"--column {each}=" for each in ("reading_ccw", "reading_cw") if each in found]
        choices.append(" ".join(words))
    where = " and ".join(str(place + 1) for place in angles)
    raise InputError(
        f"{table.grid.name}: tables side by side: angles in columns {where} (expected one table; {' or '.join(choices)}"
        " reads one)"
    )


def _by_unit(table: Table, found: dict[str, Column], mapping: Mapping) -> None:
    """Take the one column in a unit of angles for the angle, where none is called so: nothing else has such a unit."""
    taken = {column.place for column in found.values()}
    angular = [
        place
        for place, heading in enumerate(table.headings)
        if place not in taken and stated_unit(heading) in UNITS_OF["angle"]
    ]
    if "angle" not in found and "angle" not in mapping.columns and len(angular) == 1:
        found["angle"] = _column(table, "angle", angular[0], mapping)


def _checked(table: Table, found: dict[str, Column]) -> dict[str, Column]:
    named = [f'"{each}"' for each in table.headings if each]
    headings = ", ".join(named) or f"{len(table.headings)} without names"
    how = "NAME" if named else "NUMBER, from 1"
    if "angle" not in found:
        raise InputError(f"{table.grid.name}: no column of angles among {headings} (expected --column angle={how})")
    if not set(READINGS) & set(found):
        raise InputError(f"{table.grid.name}: no column of readings among {headings} (expected --column reading={how})")
    return found
