"""Frames that come, or go, together in every cycle, as one text of the socketcand protocol.

Their identifiers and lengths stay, so that the text around the data is known from the first time on: a cycle then costs
one step for all frames in place of one for each. A text that differs in a single other character is read by the general
parser.
Source: socketcand protocol description (github.com/linux-can/socketcand), raw mode.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from hexdbb.rig.frame import Frame

MOST = 16
"""Texts that are known at most: a controller sends two or three kinds of them in every cycle, and memory does not grow
with what others send."""
BYTE = b"[0-9a-fA-F]{2}"


class ReceivedBursts:
    """Frames of a client that it has sent together before."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[re.Pattern[bytes], list[int]]] = {}

    def frames_of(self, text: bytes) -> list[Frame] | None:
        """Return the frames of a text, or None where it is none of those that are known."""
        known = self._known.get(len(text))
        found = known[0].fullmatch(text) if known is not None else None
        if known is None or found is None:
            return None
        data = [bytes.fromhex(each.decode("ascii")) for each in found.groups()]
        return list(zip(known[1], data, strict=True))

    def learn(self, frames: Sequence[Frame | None], text: bytes) -> None:
        """Know a text from now on that the general parser has read; of usual frames in usual form, and nothing else."""
        usual = [frame for frame in frames if frame is not None]
        if len(usual) < 2 or len(usual) < len(frames) or (len(self._known) >= MOST and len(text) not in self._known):
            return
        parts = [
            b"< send %03X %d (%s) >" % (can_id, len(data), b" ".join([BYTE] * len(data))) for can_id, data in usual
        ]
        self._known[len(text)] = re.compile(b"".join(parts)), [can_id for can_id, _ in usual]


class SentBursts:
    """Frames of the rig that leave together."""

    def __init__(self) -> None:
        self._forms: dict[tuple[int, ...], str] = {}

    def text(self, frames: Sequence[Frame], stamp: str) -> bytes:
        """Return the messages of frames with one time stamp, s."""
        can_ids = tuple([can_id for can_id, _ in frames])
        form = self._forms.get(can_ids)
        if form is None:
            form = "".join([f"< frame {can_id:03X} {{0}} %s >" for can_id in can_ids])
            if len(self._forms) < MOST:
                self._forms[can_ids] = form
        return (form % tuple([data.hex().upper() for _, data in frames])).replace("{0}", stamp).encode("ascii")
