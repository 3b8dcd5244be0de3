"""One communication cycle on the bus: six targets and a SYNC out, seven answers in.

Pairing: at a SYNC every node samples its values and sends them, then acts on the target it received before that SYNC.
The answers to one SYNC therefore belong together, and the positions sampled at SYNC k are the result of the target of
SYNC k-1: they are recorded with row k-1 of the table of targets.
Source: CiA 301, synchronous PDOs of transmission type 1.
"""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Iterable, Sequence

import can

from hexdbb.capture.pdo import DRIVE_RPDO, DRIVE_TPDO, GAUGE_TPDO, SYNC_ID

GAUGE_SLOT = 6
SLOTS = 7
"""Number of answers to one SYNC; slots 0 to 5 are the drives, slot 6 is the gauge."""
MAX_BACKLOG = 1000
"""Frames to read at most once the time for them is over: what a bus of 1 Mbit/s carries in the longest stall that a run
survives (100 ms). A limit in time would drop answers that have waited while this process was stalled."""


class Feedback:
    """Answers of the seven nodes to one SYNC; a node that did not answer keeps its previous values.

    Attributes
    ----------
    statusword : list of int
        Object 6041h of the drives, shape (6,).
    position : list of int
        Object 6064h of the drives, counts, shape (6,).
    mode : list of int
        Object 6061h of the drives, shape (6,).
    reading_um : float
        Process value 6130h:01 of the gauge, µm.
    gauge_status : int
        Status 6150h:01 of the gauge.
    missing : tuple of int
        Slots that did not answer.
    settled : bool
        Whether the answers certainly belong to this SYNC: none was missing, now or before, and none arrived late.
    cycle : int
        Number of the SYNC, from 0.
    flooded : int
        Consecutive SYNCs sent although more frames were waiting than `MAX_BACKLOG`.
    """

    __slots__ = (
        "cycle",
        "flooded",
        "gauge_status",
        "missing",
        "mode",
        "position",
        "reading_um",
        "settled",
        "statusword",
    )

    def __init__(self) -> None:
        self.cycle = -1
        self.flooded = 0
        self.statusword = [0] * 6
        self.position = [0] * 6
        self.mode = [0] * 6
        self.reading_um = 0.0
        self.gauge_status = 0
        self.missing: tuple[int, ...] = tuple(range(SLOTS))
        self.settled = False


class Exchange:
    """Sends and receives the process data of a cycle; its memory does not grow.

    Parameters
    ----------
    bus : can.BusABC
        An open bus that nothing else reads.
    drive_nodes : sequence of int
        Node ids of the drives of sliders 1 to 6.
    gauge_node : int
        Node id of the gauge.
    other : callable
        Called with identifier, data and timestamp of every frame that is not process data.

    Attributes
    ----------
    feedback : Feedback
        Answers to the last SYNC.
    late_frames : int
        Answers that arrived too late to be paired.
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
        """Send the six RPDOs, which take effect at the next SYNC.

        Parameters
        ----------
        controlwords : sequence of int
            Object 6040h of each drive, shape (6,).
        counts : sequence of int
            Object 607Ah of each drive, shape (6,).

        Raises
        ------
        can.CanError
            The bus cannot send.
        """
        pack, send = self._rpdo.pack_into, self._bus.send
        for message, controlword, count in zip(self._targets, controlwords, counts, strict=True):
            pack(message.data, 0, controlword, count)
            send(message)

    def send_sync(self) -> None:
        """Send the SYNC; raises `can.CanError` if the bus cannot send."""
        self._bus.send(self._sync)
        self.feedback.cycle += 1
        self.feedback.settled = not self.feedback.missing and self.late_frames == self._late_before
        self._late_before = self.late_frames

    def collect(self, timeout_s: float) -> Feedback:
        """Receive the answers to the last SYNC.

        Parameters
        ----------
        timeout_s : float
            Longest time to wait, s.

        Returns
        -------
        Feedback
            The same object in every cycle; `missing` names the slots without an answer.
        """
        end_s = time.monotonic() + timeout_s
        pending = set(range(SLOTS)) - self._given_up
        recv, backlog = self._bus.recv, MAX_BACKLOG
        while pending and backlog:
            left_s = end_s - time.monotonic()
            backlog -= left_s <= 0.0
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
        """Receive the frames that arrived since the last answers; process data among them are too late to be paired."""
        for _ in range(MAX_BACKLOG):
            message = self._bus.recv(0.0)
            if message is None:
                self.feedback.flooded = 0
                return
            if message.arbitration_id in self._slots:
                self.late_frames += 1
            else:
                self._other(message.arbitration_id, message.data, message.timestamp)
        self.feedback.flooded += 1

    def give_up(self, slots: Iterable[int]) -> None:
        """Stop waiting for the answers of some slots; they count as missing."""
        self._given_up.update(slots)

    def listen(self, timeout_s: float) -> None:
        """Receive frames that are not process data for `timeout_s` seconds while no SYNC is being answered."""
        end_s = time.monotonic() + timeout_s
        while (left_s := end_s - time.monotonic()) > 0.0:
            message = self._bus.recv(left_s)
            if message is not None and message.arbitration_id not in self._slots:
                self._other(message.arbitration_id, message.data, message.timestamp)

    def _decode(self, slot: int, data: bytearray) -> bool:
        """Decode one answer; return False if its length is not the configured one, so that it counts as missing."""
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
