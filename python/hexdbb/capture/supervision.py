"""Supervision beside process data: emergency messages, heartbeats, missing answers.

Source: CiA 301: EMCY 080h + node (error code, error register, five vendor bytes), heartbeat 700h + node (NMT state).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from operator import itemgetter
from typing import ClassVar

from hexdbb.capture.exchange import SLOTS, Feedback
from hexdbb.capture.frames import EMCY_BASE, HEARTBEAT_BASE, NMT, emergency_code, malformed, service_of
from hexdbb.capture.pdo import SYNC_ID

NMT_OPERATIONAL, NMT_BOOT_UP = 0x05, 0x00
"""NMT states as a heartbeat carries them."""
NO_ERROR = 0x0000
"""EMCY code 'error reset or no error'."""
SILENT_AFTER = 3
"""Consecutive unanswered SYNCs after which a node is silent: one or two lost frames cost their samples only, and three
(12 ms at 250 Hz) still stop the axes well before the drives' own RPDO timeout (100 ms)."""


@dataclass(frozen=True)
class Emergency:
    """An EMCY message.

    Attributes
    ----------
    node : int
        Node id.
    code : int
        Error code of CiA 301 and the device profiles.
    data : bytes
        The whole message: error code, error register 1001h, vendor bytes; eight unless it was cut short.
    reset : bool
        Whether the node has since reported 'no error'.
    """

    node: int
    code: int
    data: bytes
    reset: bool = False

    def __str__(self) -> str:
        whole = malformed(EMCY_BASE + self.node, self.data) is None
        rest = (
            f"error register {self.data[2]:02X}h"
            if whole
            else f"cut short to {len(self.data)} bytes ({self.data.hex(' ').upper()})"
        )
        return f"EMCY {self.code:04X}h, {rest}" + (", since reset by the node" if self.reset else "")


@dataclass
class Supervision:
    """Receives the frames that are not process data and keeps what the checks need.

    Parameters
    ----------
    nodes : sequence of int
        Node id of each slot: drives 1 to 6, gauge.
    passed_on : callable
        Called with identifier, data and timestamp of every frame, for SDO answers.
    heartbeat_limit_s : float
        Age (s) above which a heartbeat is lost.
    silent_after : int
        Consecutive unanswered SYNCs after which a node counts as silent.

    Attributes
    ----------
    emergencies : dict of int to Emergency
        The last EMCY with a code other than 'no error', by node id; 'no error' after it does not remove it.
    nmt_states : dict of int to int
        NMT state of the last heartbeat, by node id; the first one that is not operational stays.
    malformed : dict of int to str
        The first frame of a node that its service does not allow, in words, by node id; 0 for NMT commands.
    heard_s : dict of int to float
        Monotonic time of the last heartbeat, by node id.
    missing_in_a_row : list of int
        Consecutive SYNCs without an answer, by slot.
    unanswered : list of int
        All SYNCs without an answer in time, by slot.
    foreign_syncs : int
        SYNCs received: of another producer, since no bus returns this controller's own.
    foreign_number : int or None
        Counter of the last one (1019h); None where it carried none.
    """

    nodes: Sequence[int]
    passed_on: Callable[[int, bytes | bytearray, float], None]
    heartbeat_limit_s: float
    silent_after: int = SILENT_AFTER
    emergencies: dict[int, Emergency] = field(default_factory=dict)
    nmt_states: dict[int, int] = field(default_factory=dict)
    malformed: dict[int, str] = field(default_factory=dict)
    heard_s: dict[int, float] = field(default_factory=dict)
    missing_in_a_row: list[int] = field(default_factory=lambda: [0] * SLOTS)
    unanswered: list[int] = field(default_factory=lambda: [0] * SLOTS)
    foreign_syncs: int = 0
    foreign_number: int | None = None

    def on_frame(self, can_id: int, data: bytes | bytearray, timestamp: float) -> None:
        """Process a frame that is not process data."""
        if can_id == SYNC_ID:
            self.foreign_syncs += 1
            self.foreign_number = data[0] if len(data) == 1 else None
        service, node = service_of(can_id)
        if node in self.nodes or can_id == NMT:
            wrong = malformed(can_id, data)
            if wrong is not None:
                self.malformed.setdefault(node, wrong)
            handler = self._HANDLERS.get(service)
            if handler is not None and can_id != NMT:
                handler(self, node, data)
        self.passed_on(can_id, data, timestamp)

    def count_missing(self, feedback: Feedback) -> None:
        """Update the counts of missing answers after a SYNC."""
        if not feedback.missing:
            if any(self.missing_in_a_row):
                self.missing_in_a_row = [0] * SLOTS
            return
        for slot in feedback.missing:
            self.unanswered[slot] += 1
        self.missing_in_a_row = [
            count + 1 if slot in feedback.missing else 0 for slot, count in enumerate(self.missing_in_a_row)
        ]

    def late_answers(self, labels: Sequence[str]) -> list[str]:
        """Return whose answers did not come in time: those of every node, and of the one with most beyond that."""
        every, most = min(self.unanswered), max(self.unanswered)
        said = [(labels[self.unanswered.index(most)], most - every), ("every node", every)]
        return [f"{who}: no answer in time to {count} SYNC{'s' * (count > 1)}" for who, count in said if count]

    def silent(self) -> list[int]:
        """Return the slots that have left `silent_after` consecutive SYNCs unanswered."""
        return [slot for slot, count in enumerate(self.missing_in_a_row) if count >= self.silent_after]

    def reason(self, slot: int) -> str:
        """Return the EMCY behind a drive's state as the tail of a message, or an empty text."""
        emergency = self.emergencies.get(self.nodes[slot])
        return f", EMCY {emergency.code:04X}h" if emergency else ""

    def forget_earlier(self) -> None:
        """Forget what a fault reset has settled: EMCY messages that their nodes have since reset."""
        self.emergencies = {node: each for node, each in self.emergencies.items() if not each.reset}

    def forget_stale_states(self) -> None:
        """Forget heartbeats sent before the nodes were started; a boot-up is no such heartbeat."""
        self.nmt_states = {node: state for node, state in self.nmt_states.items() if state == NMT_BOOT_UP}

    def late_heartbeat(self) -> tuple[int, float] | None:
        """Return slot and age (s) of a lost heartbeat, or None.

        A node is supervised from its first heartbeat on (CiA 301, 1016h).
        """
        if not self.heard_s:
            return None
        age_s = time.monotonic() - min(self.heard_s.values())
        if age_s <= self.heartbeat_limit_s:
            return None
        node, _ = min(self.heard_s.items(), key=itemgetter(1))
        return self.nodes.index(node), age_s

    def _emergency(self, node: int, data: bytes | bytearray) -> None:
        code = emergency_code(data)
        if code is None:
            return
        if code != NO_ERROR:
            self.emergencies[node] = Emergency(node, code, bytes(data))
        elif node in self.emergencies:
            self.emergencies[node] = replace(self.emergencies[node], reset=True)

    def _heartbeat(self, node: int, data: bytes | bytearray) -> None:
        if data:
            if self.nmt_states.get(node, NMT_OPERATIONAL) == NMT_OPERATIONAL:
                self.nmt_states[node] = data[0] & 0x7F
            self.heard_s[node] = time.monotonic()

    _HANDLERS: ClassVar = {EMCY_BASE: _emergency, HEARTBEAT_BASE: _heartbeat}
