"""Process data of the rig: the objects in each PDO and their bytes.

One table serves the bus configuration (mapping), the bus-load calculation and the cyclic loop (packing), so that they
cannot disagree. Values are little-endian.
Source: CiA 301 (PDO parameters 1400h, 1600h, 1800h, 1A00h; predefined connection set), CiA 402, CiA 404.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

SYNC_ID = 0x080
"""CAN identifier of SYNC (CiA 301, predefined connection set)."""
SYNCHRONOUS = 1
"""Transmission type: taken over, or sampled and sent, at every SYNC."""
NOT_VALID = 1 << 31
"""Bit 31 of a PDO's COB-ID (1400h:01, 1800h:01): the PDO is disabled."""


@dataclass(frozen=True)
class Mapped:
    """One object in a PDO.

    Attributes
    ----------
    index, subindex : int
        Its place in the object dictionary.
    code : str
        Its `struct` code.
    """

    index: int
    subindex: int
    code: str

    @property
    def entry(self) -> int:
        """The object as a mapping entry (1600h, 1A00h): index, sub-index, length in bits."""
        return self.index << 16 | self.subindex << 8 | 8 * struct.calcsize("<" + self.code)


@dataclass(frozen=True)
class PdoLayout:
    """One PDO.

    Attributes
    ----------
    base_id : int
        CAN identifier of node 0 (predefined connection set).
    communication, mapping : int
        Indices of its communication and mapping parameters.
    objects : tuple of Mapped
        Its contents in the order of the frame.
    """

    base_id: int
    communication: int
    mapping: int
    objects: tuple[Mapped, ...]

    @property
    def struct(self) -> struct.Struct:
        """Packing of the whole PDO."""
        return struct.Struct("<" + "".join(mapped.code for mapped in self.objects))

    @property
    def bytes(self) -> int:
        """Number of data bytes."""
        return self.struct.size

    def cob_id(self, node: int) -> int:
        """Return the CAN identifier of this PDO of a node (predefined connection set)."""
        return self.base_id + node


CONTROLWORD = Mapped(0x6040, 0, "H")
TARGET_POSITION = Mapped(0x607A, 0, "i")
STATUSWORD = Mapped(0x6041, 0, "H")
POSITION = Mapped(0x6064, 0, "i")
MODE_DISPLAY = Mapped(0x6061, 0, "b")
READING = Mapped(0x6130, 1, "f")
GAUGE_STATUS = Mapped(0x6150, 1, "B")

DRIVE_RPDO = PdoLayout(0x200, 0x1400, 0x1600, (CONTROLWORD, TARGET_POSITION))
DRIVE_TPDO = PdoLayout(0x180, 0x1800, 0x1A00, (STATUSWORD, POSITION, MODE_DISPLAY))
GAUGE_TPDO = PdoLayout(0x180, 0x1800, 0x1A00, (READING, GAUGE_STATUS))
