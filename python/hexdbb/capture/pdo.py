"""Process data of the rig: the objects in each PDO and their bytes.

One table serves the bus configuration (mapping), the bus-load calculation and the cyclic loop (packing), so that they
cannot disagree. Values are little-endian.
Source: CiA 301 (PDO parameters 1400h, 1600h, 1800h, 1A00h; predefined connection set), CiA 402, CiA 404.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

SYNC_ID = 0x080
"""CAN identifier of SYNC (CiA 301, predefined connection set)."""
SYNCHRONOUS = 1
"""Transmission type: taken over, or sampled and sent, at every SYNC."""
NOT_VALID = 1 << 31
"""Bit 31 of a PDO's COB-ID (1400h:01, 1800h:01): the PDO is disabled."""

WITHOUT_REMOTE = 1 << 30
"""Bit 30 of a TPDO's COB-ID: the PDO is not sent on remote requests, of which there are none here."""


@dataclass(frozen=True)
class Mapped:
    """One object in a PDO.

    Attributes
    ----------
    index, subindex : int
        Its place in the object dictionary.
    code : str
        Its `struct` code.
    without : str
        Consequence if the device has no such object, or no PDO can hold it.
    """

    index: int
    subindex: int
    code: str
    without: str

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
    without : str
        Consequence if the device has no such PDO.
    """

    base_id: int
    communication: int
    mapping: int
    objects: tuple[Mapped, ...]
    without: str

    @property
    def entries(self) -> dict[int, int]:
        """Values of the mapping parameter by sub-index: the number of objects, then each of them."""
        return {0: len(self.objects)} | {k: mapped.entry for k, mapped in enumerate(self.objects, start=1)}

    @property
    def struct(self) -> struct.Struct:
        """Packing of the whole PDO."""
        return together([self])

    @property
    def bytes(self) -> int:
        """Number of data bytes."""
        return self.struct.size

    def cob_id(self, node: int) -> int:
        """Return the CAN identifier of this PDO of a node (predefined connection set)."""
        return self.base_id + node


CONTROLWORD = Mapped(0x6040, 0, "H", "it can neither be enabled nor stopped")
TARGET_POSITION = Mapped(0x607A, 0, "i", "it is given no targets")
STATUSWORD = Mapped(0x6041, 0, "H", "its state is not known")
POSITION = Mapped(0x6064, 0, "i", "its position is not known")
MODE_DISPLAY = Mapped(0x6061, 0, "b", "it cannot be seen whether it follows cyclic targets")
READING = Mapped(0x6130, 1, "f", "there is no reading")
GAUGE_STATUS = Mapped(0x6150, 1, "B", "readings that are not valid cannot be told from others")

DRIVE_RPDO = PdoLayout(
    0x200, 0x1400, 0x1600, (CONTROLWORD, TARGET_POSITION), "it receives no targets in time with SYNC"
)
DRIVE_TPDO = PdoLayout(
    0x180, 0x1800, 0x1A00, (STATUSWORD, POSITION, MODE_DISPLAY), "it does not answer in time with SYNC"
)
GAUGE_TPDO = PdoLayout(0x180, 0x1800, 0x1A00, (READING, GAUGE_STATUS), "it does not answer in time with SYNC")


def together(layouts: Sequence[PdoLayout]) -> struct.Struct:
    """Return the packing of several PDOs one after the other."""
    return struct.Struct("<" + "".join(mapped.code for layout in layouts for mapped in layout.objects))
