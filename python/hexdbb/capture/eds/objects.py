"""One object of an EDS: its type, access, PDO mapping and value, from the keys of its section."""

from __future__ import annotations

from dataclasses import dataclass

from canopen.objectdictionary import ODVariable
from canopen.objectdictionary.datatypes import FLOAT_TYPES, SIGNED_TYPES

from hexdbb.capture.eds.sections import Section, Value

ACCESS = ("ro", "rw", "rwr", "rww", "wo", "const")
"""Access types of CiA 306."""
NODE_ID = "$NODEID"
VAR, ARRAY, RECORD = 0x7, 0x8, 0x9
"""Object types (CiA 301); VAR where none is stated."""


class UnusableError(Exception):
    """Raised for a section that does not describe an object.

    Attributes
    ----------
    line : int
        Line of the EDS that is wrong.
    what : str
        Key, value and what was expected.
    """

    def __init__(self, line: int, what: str) -> None:
        super().__init__(f"line {line}: {what}")
        self.line, self.what = line, what


@dataclass(frozen=True)
class EdsObject:
    """One object.

    Attributes
    ----------
    index, subindex : int
        Its place in the object dictionary.
    name : str
        ParameterName.
    data_type : int
        Number of its type (CiA 301).
    access : str
        One of `ACCESS`.
    mappable : bool
        Whether a PDO can hold it.
    value : int, float or None
        ParameterValue of a DCF, else DefaultValue; None where neither is stated, or not as a number.
    line : int
        Line of its section.
    """

    index: int
    subindex: int
    name: str
    data_type: int
    access: str
    mappable: bool
    value: int | float | None
    line: int

    @property
    def writable(self) -> bool:
        """Whether SDO may write it."""
        return "w" in self.access

    @property
    def bits(self) -> int | None:
        """Length in bits; None for text and other types without a fixed length."""
        return len(self.variable()) if self.variable().fixed_size else None

    @property
    def real(self) -> bool:
        """Whether its type is a floating-point number."""
        return self.data_type in FLOAT_TYPES

    def variable(self) -> ODVariable:
        """Return the object as `canopen` needs it for SDO."""
        variable = ODVariable(self.name, self.index, self.subindex)
        variable.data_type, variable.access_type = self.data_type, self.access
        return variable


def read_object(index: int, subindex: int, section: Section, node_id: int) -> EdsObject:
    """Read the object that a section describes.

    Parameters
    ----------
    index, subindex : int
        Its place.
    section : Section
        Its section.
    node_id : int
        Value of ``$NODEID``.

    Returns
    -------
    EdsObject

    Raises
    ------
    UnusableError
        Data type or access type are missing, or no such.
    """
    data_type = _number(section, "DataType", None)
    access = _required(section, "AccessType")
    if access.text.lower() not in ACCESS:
        raise UnusableError(access.line, f"AccessType={access.text} (expected one of {', '.join(ACCESS)})")
    if not 0 < data_type <= 0x1B:
        raise UnusableError(section.line, f"DataType={data_type:#06x} (expected a basic type of CiA 301)")
    stated = section.values.get("parametervalue") or section.values.get("defaultvalue")
    return EdsObject(
        index=index,
        subindex=subindex,
        name=section.values["parametername"].text if "parametername" in section.values else section.name,
        data_type=data_type,
        access=access.text.lower(),
        mappable=_number(section, "PDOMapping", 0) != 0,
        value=None if stated is None else _value(stated.text, data_type, node_id),
        line=section.line,
    )


def object_type(section: Section) -> int:
    """Return the object type of a section; raises `UnusableError` if it is no number."""
    return _number(section, "ObjectType", VAR)


def compact_subs(section: Section) -> int:
    """Return the number of sub-indices that an array describes together (CompactSubObj); 0 if each has a section."""
    return min(_number(section, "CompactSubObj", 0), 254)


def _required(section: Section, key: str) -> Value:
    found = section.values.get(key.lower())
    if found is None:
        raise UnusableError(section.line, f"no {key} (expected one)")
    return found


def _number(section: Section, key: str, default: int | None) -> int:
    if default is not None and key.lower() not in section.values:
        return default
    value = _required(section, key)
    number = _parsed(value.text)
    if number is None:
        raise UnusableError(value.line, f"{key}={value.text} (expected a number)")
    return number


def _parsed(text: str) -> int | None:
    """Return a number as CiA 306 writes it: decimal, hexadecimal (0x) or octal (leading 0); vendors write 8 as 0008."""
    octal = len(text) > 1 and text[0] == "0" and text.isdecimal()
    for base in (8, 10) if octal else (0,):
        try:
            return int(text, base)
        except ValueError:
            continue
    return None


def _value(text: str, data_type: int, node_id: int) -> int | float | None:
    """Return a value of a numeric type; None for other types and for what is no number."""
    if data_type in FLOAT_TYPES:
        try:
            return float(text)
        except ValueError:
            return None
    relative = NODE_ID in text.upper()
    number = _parsed(text.upper().replace(NODE_ID, "").replace(" ", "").strip("+").lower() or "0")
    if number is None:
        return None
    number += node_id if relative else 0
    variable = ODVariable("", 0)
    variable.data_type = data_type
    if data_type in SIGNED_TYPES and number >= 1 << (len(variable) - 1):
        number -= 1 << len(variable)  # negative values as vendors write them: 0xFFFFFFFF
    return number
