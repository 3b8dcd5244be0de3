"""Options that say how readings of other programs are read: keys of a mapping file, which they replace.

They are kept in the command's context, so that a command has them by its decorator alone and `wanted_mapping` returns
them.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from hexdbb.errors import InputError
from hexdbb.importing import Mapping, load_mapping, mapping_of

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

KEY = "hexdbb.importing"
"""Key of the options in click's `Context.meta`."""
DIRECTIONS = {"ccw": 1, "cw": -1}
Option = tuple[str, str, dict[str, Any]]
"""Key of the mapping, option, and what click is told of it."""

OF_RECORDS: tuple[Option, ...] = (
    (
        "mapping",
        "--mapping",
        {"metavar": "FILE", "help": "Mapping file; NAME.toml beside NAME.csv is found by itself."},
    ),
    ("plan", "--plan", {"metavar": "PLAN", "help": "Plan that was driven: a plan file or a shipped plan."}),
    ("circle", "--circle", {"metavar": "ID", "type": int, "help": "Circle of the plan."}),
    (
        "mount",
        "--mount",
        {"metavar": "NAME", "help": "Name of the set-up that all files share: the cup was not touched between them."},
    ),
)
"""Options of every command that takes records."""
OF_CONVERT: tuple[Option, ...] = (
    *OF_RECORDS,
    ("machine", "-m|--machine", {"metavar": "MACHINE", "help": "Machine file in place of the plan's."}),
    ("feed_mm_min", "--feed", {"metavar": "MM_MIN", "type": float, "help": "Commanded feed, mm/min."}),
    ("direction", "--direction", {"type": click.Choice(list(DIRECTIONS)), "help": "Direction of all readings."}),
    (
        "columns",
        "--column",
        {"metavar": "Q=NAME", "multiple": True, "help": "Column of a quantity, by name or number."},
    ),
    ("units", "--unit", {"metavar": "Q=UNIT", "multiple": True, "help": "Unit of a quantity, as reading=um."}),
    ("sheet", "--sheet", {"metavar": "NAME", "help": "Excel: sheet."}),
    ("header", "--header", {"metavar": "LINE", "type": int, "help": "Line that names the columns; 0: none."}),
    ("rows", "--rows", {"metavar": "A:B", "multiple": True, "help": "First and last line; again for a further table."}),
    ("delimiter", "--delimiter", {"metavar": "NAME", "help": "comma, semicolon, tab, bar or space."}),
    ("decimal", "--decimal", {"metavar": "MARK", "help": "Decimal mark: . or ,"}),
    ("encoding", "--encoding", {"metavar": "NAME", "help": "Encoding of a text, as utf-8 or cp1252."}),
    (
        "angle_counts",
        "--angle-counts",
        {"type": click.Choice(["place", "travel"]), "help": "Angles are places, or count up along every run."},
    ),
    ("test", "--test", {"metavar": "N", "type": int, "help": "Renishaw: number of the test."}),
    ("start_angle_deg", "--start-angle", {"metavar": "DEG", "type": float, "help": "Renishaw: first reading's place."}),
    ("arc_deg", "--arc", {"metavar": "DEG", "type": float, "help": "Renishaw: angle from first to last reading."}),
)
"""Options of the command that imports."""
_CONVERT_ONLY = {names for key, names, _ in OF_CONVERT if key not in {each for each, _, _ in OF_RECORDS}}


def import_options(options: tuple[Option, ...]) -> Decorator:
    """Return a decorator that adds options; their values reach `wanted_mapping`, not the command's arguments."""

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        for key, names, settings in reversed(options):
            command = click.option(
                *names.split("|"), f"import_{key}", expose_value=False, callback=_keep(key), **settings
            )(command)
        return command

    return decorate


def wanted_mapping() -> Mapping | None:
    """Return the mapping that the command's options state, those of its mapping file behind them; None without any.

    Raises
    ------
    InputError
        A wrong value, or mapping file.
    """
    given: dict[str, Any] = dict(click.get_current_context().meta.get(KEY, {}))
    if not given:
        return None
    path = given.pop("mapping", None)
    for key, option in (("columns", "--column"), ("units", "--unit")):
        if key in given:
            given[key] = _pairs(given[key], option)
    if "columns" in given:
        given["columns"] = {name: int(text) if text.isdecimal() else text for name, text in given["columns"].items()}
    if "rows" in given:
        given["rows"] = tuple(_range(text) for text in given["rows"])
    if "direction" in given:
        given["direction"] = DIRECTIONS[given["direction"]]
    wanted = mapping_of("options", **given)
    return wanted if path is None else wanted.over(load_mapping(Path(path)))


@contextmanager
def pointing_to_convert(path: Path) -> Iterator[None]:
    """Add to an error that asks for an option of `convert`, which other commands lack, where it can be said."""
    try:
        yield
    except InputError as error:
        asked = dict.fromkeys(re.findall(r"--[a-z][a-z-]*", str(error)))
        elsewhere = [option for option in asked if option in _CONVERT_ONLY]
        if not elsewhere:
            raise
        kept = f"--save-mapping {shlex.quote(str(path.with_suffix('.toml')))} keeps it for this command"
        raise InputError(f"{error}; {elsewhere[0]} is an option of hexdbb convert, whose {kept}") from None


def given_options() -> list[str]:
    """Return the words with which this command was told how readings are read, for a command that follows it."""
    given: dict[str, Any] = click.get_current_context().meta.get(KEY, {})
    return [word for key, option, _ in OF_RECORDS if key in given for word in (option, str(given[key]))]


def _keep(key: str) -> Callable[[click.Context, click.Parameter, Any], None]:
    def keep(context: click.Context, _: click.Parameter, value: Any) -> None:
        if value not in (None, ()):
            context.meta.setdefault(KEY, {})[key] = value

    return keep


def _pairs(texts: tuple[str, ...], option: str) -> dict[str, str]:
    pairs = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals:
            raise InputError(f'{option} "{text}": no "=" (expected QUANTITY=VALUE, as reading=um)')
        pairs[name.strip()] = value.strip()
    return pairs


def _range(text: str) -> tuple[int, int]:
    first, colon, last = text.partition(":")
    if not colon or not first.isdecimal() or not last.isdecimal():
        raise InputError(f'--rows "{text}" (expected FIRST:LAST, lines as 5:364)')
    return int(first), int(last)
