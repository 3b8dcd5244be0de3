"""What is known of the rig beside process data: emergency messages, heartbeats, answers that stay out.

Source: CiA 301: EMCY 080h + node (code, error register, five vendor bytes), heartbeat 700h + node (NMT state).
"""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from operator import itemgetter
from typing import ClassVar

from hexdbb.capture.exchange import SLOTS, Feedback

EMCY_BASE, HEARTBEAT_BASE = 0x080, 0x700
NODE_MASK = 0x7F
NO_ERROR = 0x0000
SILENT_AFTER = 3
"""SYNCs in a row a node leaves unanswered before it counts as silent."""


@dataclass(frozen=True)
class Emergency:
    """An EMCY message: node, code of CiA 301 and its profiles, error register."""

    node: int
    code: int
    register: int


@dataclass
class Supervision:
    """Takes frames of other services as they come, and keeps what the checks ask for.

    Parameters
    ----------
    labels : name of each slot's node in messages: drives 1 to 6, gauge
    nodes : node id of each slot
    passed_on : called with every frame, for SDO answers
    heartbeat_limit_s : age at which a heartbeat counts as lost
    silent_after : SYNCs in a row a node leaves unanswered before it counts as silent

    Attributes
    ----------
    emergencies : EMCY messages with a code other than 'no error', by node id, the last one
    nmt_states : last NMT state heard, by node id
    heard_s : monotonic time of the last heartbeat, by node id
    missing_in_a_row : per slot, SYNCs without an answer
    missing_total : answers that stayed out
    """

    labels: Sequence[str]
    nodes: Sequence[int]
    passed_on: Callable[[int, bytearray, float], None]
    heartbeat_limit_s: float
    silent_after: int = SILENT_AFTER
    emergencies: dict[int, Emergency] = field(default_factory=dict)
    nmt_states: dict[int, int] = field(default_factory=dict)
    heard_s: dict[int, float] = field(default_factory=dict)
    missing_in_a_row: list[int] = field(default_factory=lambda: [0] * SLOTS)
    missing_total: int = 0

    def on_frame(self, can_id: int, data: bytearray, timestamp: float) -> None:
        """Take a frame that is not process data."""
        service, node = can_id & ~NODE_MASK, can_id & NODE_MASK
        handler = self._HANDLERS.get(service)
        if handler is not None and node in self.nodes:
            handler(self, node, data)
        self.passed_on(can_id, data, timestamp)

    def count_missing(self, feedback: Feedback) -> None:
        """Keep count of answers that stayed out."""
        if not feedback.missing:
            if any(self.missing_in_a_row):
                self.missing_in_a_row = [0] * SLOTS
            return
        self.missing_total += len(feedback.missing)
        self.missing_in_a_row = [
            count + 1 if slot in feedback.missing else 0 for slot, count in enumerate(self.missing_in_a_row)
        ]

    def silent(self) -> list[int]:
        """Slots whose answers have stayed out `silent_after` times in a row."""
        return [slot for slot, count in enumerate(self.missing_in_a_row) if count >= self.silent_after]

    def late_heartbeat(self) -> tuple[int, float] | None:
        """Slot and age (s) of a heartbeat that is lost; nodes are watched from their first heartbeat on (CiA 301)."""
        if not self.heard_s:
            return None
        node, heard_s = min(self.heard_s.items(), key=itemgetter(1))
        age_s = time.monotonic() - heard_s
        return (self.nodes.index(node), age_s) if age_s > self.heartbeat_limit_s else None

    def _emergency(self, node: int, data: bytearray) -> None:
        if len(data) < 3:
            return
        code, register = struct.unpack_from("<HB", data)
        if code == NO_ERROR:
            self.emergencies.pop(node, None)
        else:
            self.emergencies[node] = Emergency(node, code, register)

    def _heartbeat(self, node: int, data: bytearray) -> None:
        if data:
            self.nmt_states[node] = data[0] & 0x7F
            self.heard_s[node] = time.monotonic()

    _HANDLERS: ClassVar = {EMCY_BASE: _emergency, HEARTBEAT_BASE: _heartbeat}
