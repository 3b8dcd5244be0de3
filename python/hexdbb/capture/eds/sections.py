"""The lines of an EDS as sections of keys, each with its line number.

Vendors' files are ini files of many kinds: with empty values, with comments behind values, with keys in other capitals
than the standard's, with keys twice. All of that is read; what a value means is decided where it is used.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

SECTION = re.compile(r"\[\s*(?P<name>[^\]]*?)\s*\]")
COMMENT = re.compile(r"\s+[#;].*$")
"""A comment behind a value: CiA 306 allows comments in lines of their own only, and tools write ``0x07 # VAR``."""


@dataclass(frozen=True)
class Value:
    """One value.

    Attributes
    ----------
    text : str
        As in the file, without a comment behind it.
    line : int
        Number of its line, from 1.
    """

    text: str
    line: int


@dataclass
class Section:
    """One section.

    Attributes
    ----------
    name : str
        In lower case: ``1018sub1``.
    line : int
        Number of the line with its name, from 1.
    values : dict of str to Value
        By key in lower case; an empty value counts as none.
    """

    name: str
    line: int
    values: dict[str, Value] = field(default_factory=dict)


def parse_sections(text: str) -> dict[str, Section]:
    """Parse the text of an EDS; of a section or key that stands twice, the last counts.

    Parameters
    ----------
    text : str
        Contents of the file.

    Returns
    -------
    dict of str to Section
        By name in lower case. Lines of no known form are left out.
    """
    sections: dict[str, Section] = {}
    current: Section | None = None
    for number, line in _lines(text):
        named = SECTION.match(line)
        if named is not None:
            name = named["name"].lower()
            current = sections.setdefault(name, Section(name, number))
            continue
        key, equals, value = line.partition("=")
        stripped = COMMENT.sub("", " " + value).strip()
        if current is not None and equals and stripped:
            current.values[key.strip().lower()] = Value(stripped, number)
    return sections


def objects_of(sections: Mapping[str, Section]) -> Iterator[tuple[int, int | None, Section]]:
    """Yield index, sub-index (None for the object itself) and section of every section that describes an object."""
    for name, section in sections.items():
        named = re.fullmatch(r"([0-9a-f]{4})(?:sub([0-9a-f]{1,2}))?", name)
        if named is not None:
            yield int(named[1], 16), None if named[2] is None else int(named[2], 16), section


def _lines(text: str) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(re.split(r"\r\n|\n|\r", text.removeprefix("\ufeff")), start=1):
        stripped = line.strip()
        if stripped and stripped[0] not in ";#":
            yield number, stripped
