"""The object dictionary of a simulated node: every entry of its EDS with its present value.

Model: `canopen` parses the EDS; each entry keeps its value as a Python number, so that PDOs are packed without a
detour through bytes.
Source: CiA 301 (data types, SDO abort codes), CiA 306 (EDS).
"""

from __future__ import annotations

import struct
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path

import canopen
from canopen.objectdictionary import ODVariable
from canopen.objectdictionary.datatypes import INTEGER32, UNSIGNED32
from canopen.sdo import SdoAbortedError

from hexdbb.errors import InputError

Value = bool | int | float | bytes
Key = tuple[int, int]
"""Index and sub-index."""
WriteHook = Callable[[Value], None]
"""Called with the new value before an SDO download is stored; raises `SdoAbortedError` to refuse it."""

ABORT_READ_WRITE_ONLY = 0x06010001
ABORT_WRITE_READ_ONLY = 0x06010002
ABORT_NO_OBJECT = 0x06020000
ABORT_NOT_MAPPABLE = 0x06040041
ABORT_PDO_TOO_LONG = 0x06040042
ABORT_LENGTH = 0x06070010
ABORT_NO_SUBINDEX = 0x06090011
ABORT_VALUE_RANGE = 0x06090030
ABORT_VALUE_HIGH = 0x06090031
ABORT_VALUE_LOW = 0x06090032
ABORT_DEVICE_STATE = 0x08000022

DEVICE_NAME: Key = (0x1008, 0)
"""The one object used here that is text."""
_STRUCT_CODES = {1: "?", 2: "b", 3: "h", 4: "i", 5: "B", 6: "H", 7: "I", 8: "f", 0x11: "d", 0x15: "q", 0x1B: "Q"}
"""struct code of each CiA 301 data type; other types (strings, domains) are kept as bytes."""


class Entry:
    """One entry of the dictionary: its properties in the EDS, and its value."""

    __slots__ = ("_codec", "access", "code", "high", "index", "low", "mappable", "name", "size", "subindex", "value")

    def __init__(self, variable: ODVariable) -> None:
        self.index: int = variable.index
        self.subindex: int = variable.subindex
        self.name: str = variable.name
        self.access: str = variable.access_type
        self.mappable: bool = variable.pdo_mappable
        self.low: int | None = variable.min
        self.high: int | None = variable.max
        self.code: str | None = _STRUCT_CODES.get(variable.data_type)
        self._codec = struct.Struct("<" + self.code) if self.code else None
        self.size: int = self._codec.size if self._codec else 0
        default = variable.default if variable.default is not None else (0 if self.code else b"")
        self.value: Value = float(default) if self.code in ("f", "d") else default
        if self._codec is not None:
            self._codec.pack(self.value)  # raises here, not in a PDO, for a default that its type cannot hold

    @property
    def readable(self) -> bool:
        """Whether an SDO may read the entry."""
        return self.access != "wo"

    @property
    def writable(self) -> bool:
        """Whether an SDO may write the entry."""
        return self.access in ("rw", "rww", "rwr", "wo")

    def encode(self) -> bytes:
        """Return the value as bytes on the bus (little-endian)."""
        if self._codec is None:
            return self.value if isinstance(self.value, bytes) else b""
        try:
            return self._codec.pack(self.value)
        except struct.error:
            raise SdoAbortedError(ABORT_VALUE_RANGE) from None

    def decode(self, data: bytes) -> Value:
        """Return the value of bytes from the bus.

        Raises
        ------
        SdoAbortedError
            The length is wrong, or the value is outside the limits in the EDS.
        """
        if self._codec is None:
            return bytes(data)
        if len(data) != self.size:
            raise SdoAbortedError(ABORT_LENGTH)
        (value,) = self._codec.unpack(data)
        if self.low is not None and value < self.low:
            raise SdoAbortedError(ABORT_VALUE_LOW)
        if self.high is not None and value > self.high:
            raise SdoAbortedError(ABORT_VALUE_HIGH)
        checked: Value = value
        return checked


class Dictionary:
    """All entries of one node.

    Parameters
    ----------
    eds : Path
        The EDS file.
    node_id : int
        Resolves ``$NODEID`` in the defaults.
    required : mapping of (index, sub-index) to str
        Objects that a device of this kind must have, each with the struct codes of the types it may have.
    assumed : mapping of (index, sub-index) to value
        Objects that a device may lack. If the EDS lacks one, the device works with this value, which is not visible on
        the bus.

    Raises
    ------
    InputError
        The file does not exist, is no EDS, or lacks a required object.
    """

    def __init__(
        self,
        eds: Path,
        node_id: int,
        required: Mapping[Key, str] | None = None,
        assumed: Mapping[Key, int] | None = None,
    ) -> None:
        self.eds = eds
        self.od = _imported(eds, node_id)
        self.hooks: dict[Key, WriteHook] = {}
        self._entries: dict[Key, Entry] = {}
        for item in self.od.values():
            for variable in [item] if isinstance(item, ODVariable) else item.values():
                self._entries[variable.index, variable.subindex] = self._made(variable)
        self._indices = {index for index, _ in self._entries}
        for key, codes in (required or {}).items():
            self._require(key, codes, node_id)
        self._inner = dict(self._entries)
        for key, value in (assumed or {}).items():
            if self._inner.setdefault(key, _unseen(key, value)).code is None and key != DEVICE_NAME:
                raise InputError(f"{eds}: object {shown(key)} is no number (expected one)")

    def _made(self, variable: ODVariable) -> Entry:
        try:
            return Entry(variable)
        except (struct.error, ValueError, TypeError, OverflowError):
            key = (variable.index, variable.subindex)
            value = f"DefaultValue={variable.default_raw}"
            raise InputError(f"{self.eds}: object {shown(key)}: {value} (expected a value of its type)") from None

    def _require(self, key: Key, codes: str, node_id: int) -> None:
        entry = self._entries.get(key)
        if entry is None:
            raise InputError(f"{self.eds}: object {shown(key)} is missing (expected for node {node_id})")
        if entry.code is None or entry.code not in codes:
            expected = f"expected one of {8 * struct.calcsize('<' + codes[0])} bits"
            raise InputError(f"{self.eds}: object {shown(key)} has another data type ({expected})")

    def __contains__(self, key: Key) -> bool:
        return key in self._entries

    def entry(self, index: int, subindex: int = 0) -> Entry:
        """Return one entry for use by the device itself: of the EDS, or assumed."""
        return self._inner[index, subindex]

    def number(self, index: int, subindex: int = 0) -> int:
        """Return the value of an integer entry."""
        return int(self.entry(index, subindex).value)

    def real(self, index: int, subindex: int = 0) -> float:
        """Return the value of a numeric entry as a float."""
        return float(self.entry(index, subindex).value)

    def upload(self, index: int, subindex: int) -> bytes:
        """Return the data of an SDO upload; raises `SdoAbortedError` if it is not allowed."""
        entry = self._seen(index, subindex)
        if not entry.readable:
            raise SdoAbortedError(ABORT_READ_WRITE_ONLY)
        return entry.encode()

    def download(self, index: int, subindex: int, data: bytes) -> None:
        """Store the data of an SDO download; raises `SdoAbortedError` if it is not allowed."""
        entry = self._seen(index, subindex)
        if not entry.writable:
            raise SdoAbortedError(ABORT_WRITE_READ_ONLY)
        value = entry.decode(data)
        hook = self.hooks.get((index, subindex))
        if hook is not None:
            hook(value)
        entry.value = value

    def _seen(self, index: int, subindex: int) -> Entry:
        found = self._entries.get((index, subindex))
        if found is None:
            raise SdoAbortedError(ABORT_NO_SUBINDEX if index in self._indices else ABORT_NO_OBJECT)
        return found


def shown(key: Key) -> str:
    """Return index and sub-index as messages show them: 1018h:01."""
    return f"{key[0]:04X}h:{key[1]:02X}"


def _imported(eds: Path, node_id: int) -> canopen.ObjectDictionary:
    """Let `canopen` parse an EDS."""
    expected = f"expected the EDS of node {node_id}"
    if not eds.is_file():
        raise InputError(f"{eds}: no such file ({expected})")
    try:
        with eds.open(encoding="latin-1") as file, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of canopen about itself
            return canopen.import_od(file, node_id)
    except OSError as error:
        raise InputError(f"{eds}: cannot be read: {error.strerror} ({expected})") from None
    except Exception as error:  # the parser raises what its conversions raise
        reason = next(iter(str(error).splitlines()), type(error).__name__)
        raise InputError(f"{eds}: not an EDS: {reason} ({expected})") from None


def _unseen(key: Key, value: int) -> Entry:
    variable = ODVariable("assumed", *key)
    variable.data_type, variable.default = INTEGER32 if value < 0 else UNSIGNED32, value
    return Entry(variable)
