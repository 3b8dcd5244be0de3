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
MOST_FRAMES = 16
"""Frames of a text that is known at most: twice those of a cycle. What waited while the rig was held up is read
together and will hardly come so again."""
BYTE = b"[0-9a-fA-F]{2}"


class ReceivedBursts:
    """Frames of a client that it has sent together before."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[re.Pattern[bytes], list[int]]] = {}
        self._seen: tuple[int, ...] = ()

    def frames_of(self, text: bytes) -> list[Frame] | None:
        """Return the frames of a text, or None where it is none of those that are known."""
        known = self._known.get(len(text))
        found = known[0].fullmatch(text) if known is not None else None
        if known is None or found is None:
            return None
        data = [bytes.fromhex(each.decode("ascii")) for each in found.groups()]
        return list(zip(known[1], data, strict=True))

    def learn(self, frames: Sequence[Frame | None], text: bytes) -> None:
        """Know a text from now on that the general parser has read twice; of usual frames in usual form, and no other.

        An expression takes milliseconds to compile: one for every text that comes once would hold the rig up.
        """
        usual = [frame for frame in frames if frame is not None]
        if not 2 <= len(usual) <= MOST_FRAMES or len(usual) < len(frames):
            return
        can_ids = tuple([can_id for can_id, _ in usual])
        if can_ids != self._seen or (len(self._known) >= MOST and len(text) not in self._known):
            self._seen = can_ids
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
