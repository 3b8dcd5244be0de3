"""Frames that go together in every cycle with fixed identifiers and lengths, as one text of the socketcand protocol.

Only their data change, so what stands around the data is written, or expected, once for a whole run: a cycle then costs
one step for all frames of a direction in place of one for each. A received text that differs in a single character is
no burst, and its frames are taken one by one.
Source: socketcand protocol description (github.com/linux-can/socketcand), raw mode.
"""

from __future__ import annotations

import re
from binascii import unhexlify
from collections.abc import Sequence

import can

Layout = Sequence[tuple[int, int]]
"""Identifier (11 bits) and number of data bytes of each frame."""
TIME = rb"\d{1,12}\.\d{1,9}"
"""Time stamp of a frame, s, as servers write it: a finite number that is not negative."""


class SentBurst:
    """Frames that are sent together.

    Parameters
    ----------
    layout : sequence of (int, int)
        Identifier and number of data bytes of each frame, in order.

    Attributes
    ----------
    messages : list of can.Message
        The frames for a bus of python-can, with the data of the last `filled`.
    """

    def __init__(self, layout: Layout) -> None:
        self._form = "".join([f"< send {can_id:03X} {length:X} %s >" for can_id, length in layout])
        self._parts = [slice(start, start + length) for start, length in _places(layout)]
        # As hexadecimal text a byte takes three characters, of which the last one separates it from the next.
        self._words = [slice(3 * part.start, max(3 * part.stop - 1, 3 * part.start)) for part in self._parts]
        self.messages = [
            can.Message(arbitration_id=can_id, is_extended_id=False, data=bytearray(length))
            for can_id, length in layout
        ]

    def text(self, data: bytes) -> bytes:
        """Return the request to send all frames; `data` are those of all of them in order."""
        words = data.hex(" ")
        return (self._form % tuple([words[part] for part in self._words])).encode("ascii")

    def filled(self, data: bytes) -> list[can.Message]:
        """Return the frames for a bus of python-can; `data` are those of all of them in order."""
        for message, part in zip(self.messages, self._parts, strict=True):
            message.data[:] = data[part]
        return self.messages


class ReceivedBurst:
    """Frames that arrive together.

    Parameters
    ----------
    layout : sequence of (int, int)
        Identifier and number of data bytes of each frame, in the order in which a server sends them most often.
    """

    def __init__(self, layout: Layout) -> None:
        frames = [b"< frame %03X %s ([0-9A-F]{%d}) >" % (can_id, TIME, 2 * length) for can_id, length in layout]
        self._match = re.compile(b"".join(frames)).fullmatch

    def data_of(self, text: bytes) -> bytes | None:
        """Return the data of all frames in order, or None where a text is anything but these frames in this order."""
        found = self._match(text)
        return None if found is None else unhexlify(b"".join(found.groups()))


def _places(layout: Layout) -> list[tuple[int, int]]:
    """Return where the data of each frame begin, and their number."""
    starts, at = [], 0
    for _, length in layout:
        starts.append((at, length))
        at += length
    return starts
