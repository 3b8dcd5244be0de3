"""One cycle on the bus: six targets and a SYNC out, seven answers in.

Pairing: a SYNC makes every node sample its values and send them, then act on the targets received before that SYNC.
So the answers to one SYNC belong together, and positions sampled at SYNC k show where the target of SYNC k-1 has led:
they are recorded with the table's row k-1.
"""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Iterable, Sequence

import can

from hexdbb.capture.pdo import DRIVE_RPDO, DRIVE_TPDO, GAUGE_TPDO, SYNC_ID

GAUGE_SLOT = 6
SLOTS = 7
"""Answers to one SYNC: drives 0 to 5, the gauge 6."""


class Feedback:
    """What the seven nodes answered to one SYNC; values of a node that did not answer are those of before.

    Attributes
    ----------
    statusword, position, mode : lists of 6; position in counts
    reading_um, gauge_status : process value and status of the gauge
    missing : slots that did not answer
    settled : whether the answers belong to this SYNC for sure: none was missing, now or before, and none came late
    cycle : number of the SYNC
    """

    __slots__ = ("cycle", "gauge_status", "missing", "mode", "position", "reading_um", "settled", "statusword")

    def __init__(self) -> None:
        self.cycle = -1
        self.statusword = [0] * 6
        self.position = [0] * 6
        self.mode = [0] * 6
        self.reading_um = 0.0
        self.gauge_status = 0
        self.missing: tuple[int, ...] = tuple(range(SLOTS))
        self.settled = False


class Exchange:
    """Sends and receives the process data of a cycle; allocates nothing that grows.

    Parameters
    ----------
    bus : open bus, read by nobody else
    drive_nodes, gauge_node : node ids
    other : called with identifier, data and time of every frame that is not process data
    """

    def __init__(
        self,
        bus: can.BusABC,
        drive_nodes: Sequence[int],
        gauge_node: int,
        other: Callable[[int, bytearray, float], None],
    ) -> None:
        self._bus, self._other = bus, other
        self._targets = [_message(DRIVE_RPDO.cob_id(node), DRIVE_RPDO.bytes) for node in drive_nodes]
        self._sync = _message(SYNC_ID, 0)
        self._slots = {DRIVE_TPDO.cob_id(node): slot for slot, node in enumerate(drive_nodes)}
        self._slots[GAUGE_TPDO.cob_id(gauge_node)] = GAUGE_SLOT
        self._rpdo, self._drive, self._gauge = DRIVE_RPDO.struct, DRIVE_TPDO.struct, GAUGE_TPDO.struct
        self.feedback = Feedback()
        self.late_frames = 0
        self._given_up: set[int] = set()
        self._late_before = 0

    def send_targets(self, controlwords: Sequence[int], counts: Sequence[int]) -> None:
        """Send the six RPDOs; they act at the next SYNC."""
        pack, send = self._rpdo.pack_into, self._bus.send
        for message, controlword, count in zip(self._targets, controlwords, counts, strict=True):
            pack(message.data, 0, controlword, count)
            send(message)

    def send_sync(self) -> None:
        """Send the SYNC."""
        self._bus.send(self._sync)
        self.feedback.cycle += 1
        self.feedback.settled = not self.feedback.missing and self.late_frames == self._late_before
        self._late_before = self.late_frames

    def collect(self, timeout_s: float) -> Feedback:
        """Receive the answers to the last SYNC, for at most `timeout_s`.

        Returns
        -------
        Feedback
            The same object every time; `missing` names the slots without an answer.
        """
        end_s = time.monotonic() + timeout_s
        pending = set(range(SLOTS)) - self._given_up
        recv = self._bus.recv
        while pending:
            left_s = end_s - time.monotonic()
            message = recv(max(left_s, 0.0))
            if message is None:
                if left_s <= 0.0:
                    break
                continue
            slot = self._slots.get(message.arbitration_id)
            if slot is None:
                self._other(message.arbitration_id, message.data, message.timestamp)
            elif self._decode(slot, message.data):
                pending.discard(slot)
        self.feedback.missing = tuple(sorted(pending | self._given_up))
        self.feedback.settled = self.feedback.settled and not self.feedback.missing
        return self.feedback

    def drain(self) -> None:
        """Take the frames that have come since the last answers; process data among them are too late to be paired."""
        while (message := self._bus.recv(0.0)) is not None:
            if message.arbitration_id in self._slots:
                self.late_frames += 1
            else:
                self._other(message.arbitration_id, message.data, message.timestamp)

    def give_up(self, slots: Iterable[int]) -> None:
        """Wait no longer for the answers of some slots; they count as missing."""
        self._given_up.update(slots)

    def listen(self, timeout_s: float) -> None:
        """Receive frames that are not process data for `timeout_s`, no SYNC being under way."""
        end_s = time.monotonic() + timeout_s
        while (left_s := end_s - time.monotonic()) > 0.0:
            message = self._bus.recv(left_s)
            if message is not None and message.arbitration_id not in self._slots:
                self._other(message.arbitration_id, message.data, message.timestamp)

    def _decode(self, slot: int, data: bytearray) -> bool:
        """Take over one answer; one of another length than configured is as good as none."""
        feedback = self.feedback
        try:
            if slot == GAUGE_SLOT:
                feedback.reading_um, feedback.gauge_status = self._gauge.unpack(data)
            else:
                feedback.statusword[slot], feedback.position[slot], feedback.mode[slot] = self._drive.unpack(data)
        except struct.error:
            return False
        return True


def _message(can_id: int, length: int) -> can.Message:
    return can.Message(arbitration_id=can_id, is_extended_id=False, data=bytearray(length))
