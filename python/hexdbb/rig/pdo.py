"""PDOs of a simulated node: communication parameters, mapping, packing, and the procedure to change a mapping.

Model: a PDO is a struct of its mapped entries, rebuilt whenever its parameters change.
Source: CiA 301, objects 1400h, 1600h, 1800h, 1A00h; dummy entries 0001h-0007h for RPDOs.
"""

from __future__ import annotations

import struct
from collections.abc import Callable

from canopen.sdo import SdoAbortedError

from hexdbb.rig.dictionary import (
    ABORT_DEVICE_STATE,
    ABORT_NOT_MAPPABLE,
    ABORT_PDO_TOO_LONG,
    ABORT_VALUE_RANGE,
    ABORT_WRITE_READ_ONLY,
    Dictionary,
    Entry,
    Value,
)

NOT_VALID = 1 << 31
"""Bit 31 of a COB-ID: the PDO is disabled."""
MAX_SYNC_TYPE = 240
"""Largest synchronous transmission type."""
DUMMY_PAD = {2: "b", 3: "h", 4: "i", 5: "B", 6: "H", 7: "I"}
"""struct code of the dummy entries with which an RPDO skips bytes; the index is that of the data type (CiA 301)."""


class Pdo:
    """One PDO of a node.

    Parameters
    ----------
    dictionary : Dictionary
        The node's dictionary; write hooks for the objects of the PDO are added to it.
    communication, mapping : int
        Indices of the communication and mapping records.
    receive : bool
        Whether it is an RPDO.
    may_change : callable
        Returns whether the NMT state permits a change.
    on_change : callable
        Called after every change of identifier or mapping.

    Attributes
    ----------
    entries : list of Entry or None
        The mapped entries in order; None for bytes that are skipped.
    size : int
        Bytes the mapping fills.
    """

    def __init__(
        self,
        dictionary: Dictionary,
        communication: int,
        mapping: int,
        *,
        receive: bool,
        may_change: Callable[[], bool],
        on_change: Callable[[], None],
    ) -> None:
        self._dictionary, self._mapping = dictionary, mapping
        self._receive, self._may_change, self._on_change = receive, may_change, on_change
        self.cob_id = 0
        self.valid = False
        self.transmission_type = 1
        self.entries: list[Entry | None] = []
        self._filled: list[Entry] = []
        self._codec, self.size = struct.Struct("<"), 0
        dictionary.hooks[communication, 1] = self._write_cob_id
        dictionary.hooks[communication, 2] = self._write_transmission_type
        dictionary.hooks[mapping, 0] = self._write_count
        for subindex in range(1, 9):
            dictionary.hooks[mapping, subindex] = self._write_entry
        self._set_cob_id(dictionary.number(communication, 1))
        self._build(dictionary.number(mapping, 0))

    def pack(self) -> bytes:
        """Return the data of the frame, packed from the values of the mapped entries."""
        return self._codec.pack(*[entry.value for entry in self._filled])

    def unpack(self, data: bytes) -> None:
        """Write a received frame into the mapped entries; `data` must be `size` bytes at least."""
        for entry, value in zip(self.entries, self._codec.unpack_from(data), strict=True):
            if entry is not None:
                entry.value = value

    def _write_cob_id(self, value: Value) -> None:
        new = int(value)
        if self.valid and not new & NOT_VALID and (new ^ self.cob_id) & 0x7FF:
            raise SdoAbortedError(ABORT_VALUE_RANGE)  # the identifier may not change while the PDO exists
        if not self._may_change():
            raise SdoAbortedError(ABORT_DEVICE_STATE)
        self._set_cob_id(new)
        self._on_change()

    def _set_cob_id(self, value: int) -> None:
        self.cob_id, self.valid = value & 0x7FF, not value & NOT_VALID

    def _write_transmission_type(self, value: Value) -> None:
        kind = int(value)
        if not (1 <= kind <= MAX_SYNC_TYPE or (self._receive and kind >= 254)):
            raise SdoAbortedError(ABORT_VALUE_RANGE)
        self.transmission_type = kind

    def _write_count(self, value: Value) -> None:
        self._check_may_remap()
        self._build(int(value))
        self._on_change()

    def _write_entry(self, value: Value) -> None:
        self._check_may_remap()
        if self.entries:
            raise SdoAbortedError(ABORT_WRITE_READ_ONLY)  # sub-index 0 must be 0 first
        if int(value):
            self._resolve(int(value))

    def _check_may_remap(self) -> None:
        if not self._may_change():
            raise SdoAbortedError(ABORT_DEVICE_STATE)
        if self.valid:
            raise SdoAbortedError(ABORT_WRITE_READ_ONLY)

    def _resolve(self, mapped: int) -> tuple[Entry | None, str]:
        index, subindex, bits = mapped >> 16, mapped >> 8 & 0xFF, mapped & 0xFF
        if self._receive and index in DUMMY_PAD:
            return None, DUMMY_PAD[index]
        if (index, subindex) not in self._dictionary:
            raise SdoAbortedError(ABORT_NOT_MAPPABLE)
        entry = self._dictionary.entry(index, subindex)
        direction_fits = entry.writable if self._receive else entry.readable
        if not entry.mappable or entry.code is None or bits != 8 * entry.size or not direction_fits:
            raise SdoAbortedError(ABORT_NOT_MAPPABLE)
        return entry, entry.code

    def _build(self, count: int) -> None:
        resolved = [self._resolve(self._dictionary.number(self._mapping, k)) for k in range(1, count + 1)]
        codec = struct.Struct("<" + "".join(code for _, code in resolved))
        if codec.size > 8:
            raise SdoAbortedError(ABORT_PDO_TOO_LONG)
        self.entries, self._codec, self.size = [entry for entry, _ in resolved], codec, codec.size
        self._filled = [entry for entry in self.entries if entry is not None]
