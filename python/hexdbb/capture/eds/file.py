"""One EDS or DCF as the controller uses it: the objects it describes, and what is wrong with those it does not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import canopen
from canopen.objectdictionary import ODRecord
from canopen.objectdictionary.datatypes import UNSIGNED8

from hexdbb.capture.eds.objects import (
    ARRAY,
    RECORD,
    EdsObject,
    UnusableError,
    compact_subs,
    object_type,
    read_object,
)
from hexdbb.capture.eds.sections import Section, objects_of, parse_sections
from hexdbb.errors import InputError

LARGEST_BYTES = 16 * 2**20
"""Size of an EDS above which it is none: the largest of vendors' files have some megabytes."""

Key = tuple[int, int]
"""Index and sub-index."""


@dataclass(frozen=True)
class Eds:
    """Contents of an EDS.

    Attributes
    ----------
    path : Path
        The file.
    objects : mapping of (index, sub-index) to EdsObject
        Objects it describes.
    unusable : mapping of (index, sub-index) to UnusableError
        What is wrong with the description of other objects.
    """

    path: Path
    objects: Mapping[Key, EdsObject]
    unusable: Mapping[Key, UnusableError]

    def get(self, index: int, subindex: int) -> EdsObject | None:
        """Return an object, or None if it is not described."""
        return self.objects.get((index, subindex))

    def lacks(self, index: int, subindex: int) -> str:
        """Return why an object is not there, as part of a message: ``no object 1600:02 in drive.eds``."""
        wrong = self.unusable.get((index, subindex))
        missing = f"no object {index:04X}:{subindex:02X} in {self.path}"
        return missing if wrong is None else f"{missing}, {wrong}"

    def dictionary(self) -> canopen.ObjectDictionary:
        """Return the objects as `canopen` needs them for SDO."""
        dictionary = canopen.ObjectDictionary()
        subs: dict[int, list[EdsObject]] = {}
        for each in self.objects.values():
            subs.setdefault(each.index, []).append(each)
        for index, members in subs.items():
            if len(members) == 1 and members[0].subindex == 0:
                dictionary.add_object(members[0].variable())
                continue
            record = ODRecord(f"{index:04X}", index)
            for each in members:
                variable = each.variable()
                variable.name = f"{each.subindex:02X}"  # vendors give one name to several
                record.add_member(variable)
            dictionary.add_object(record)
        return dictionary


def read_eds(path: Path, node_id: int | None = None) -> Eds:
    """Read an EDS or DCF.

    Parameters
    ----------
    path : Path
        The file, in cp1252 or UTF-8.
    node_id : int, optional
        Value of ``$NODEID``; 1 where no node is meant.

    Returns
    -------
    Eds

    Raises
    ------
    InputError
        The file cannot be read, or describes no object.
    """
    expected = "expected an EDS or DCF" if node_id is None else f"expected the EDS of node {node_id}"
    try:
        if path.is_file() and path.stat().st_size > LARGEST_BYTES:
            raise InputError(f"{path}: not an EDS: {path.stat().st_size} bytes ({expected})")
        text = _decoded(path.read_bytes())
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror} ({expected})") from None
    sections = parse_sections(text)
    objects: dict[Key, EdsObject] = {}
    unusable: dict[Key, UnusableError] = {}
    for index, subindex, section in objects_of(sections):
        try:
            objects.update(_described(index, subindex, section, node_id or 1))
        except UnusableError as error:
            unusable[index, subindex or 0] = error
    if not objects:
        first = next((str(wrong) for wrong in unusable.values()), "no section describes an object, as [1000] does")
        raise InputError(f"{path}: not an EDS: {first} ({expected})")
    return Eds(path, objects, unusable)


def _decoded(data: bytes) -> str:
    """Return the text of a file in UTF-8 or, like many vendors', in cp1252."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def _described(index: int, subindex: int | None, section: Section, node_id: int) -> dict[Key, EdsObject]:
    """Return the objects that one section describes; those of an array or record have sections of their own."""
    if subindex is not None:
        return {(index, subindex): read_object(index, subindex, section, node_id)}
    if object_type(section) not in (ARRAY, RECORD):
        return {(index, 0): read_object(index, 0, section, node_id)}
    subs = compact_subs(section)
    if not subs:
        return {}
    described = {(index, sub): read_object(index, sub, section, node_id) for sub in range(1, subs + 1)}
    # Implicit. CiA 306 calls it read-only; of a PDO mapping it is as writable as the entries it counts (CiA 301).
    access = described[index, 1].access
    count = EdsObject(index, 0, "NrOfObjects", UNSIGNED8, access, mappable=False, value=subs, line=section.line)
    return {(index, 0): count, **described}
