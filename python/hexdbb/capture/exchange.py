"""One communication cycle on the bus: six targets and a SYNC out, seven answers in.

Pairing: at a SYNC every node samples its values and sends them, then acts on the target it received before that SYNC.
The answers to one SYNC therefore belong together, and the positions sampled at SYNC k are the result of the target of
SYNC k-1: they are recorded with row k-1 of the table of targets.

Frames of a cycle leave together where the bus permits it. Answers are taken one by one: what arrives after the last
answer to a SYNC is too late or one too many, also where it was read together with that answer.
An answer carries nothing that tells its SYNC, so answers are counted: exactly one of every node between two SYNCs. One
that is missing may still come and is waited for before the next SYNC (`Loop`); one too many makes the answers doubtful.
Source: CiA 301, synchronous PDOs of transmission type 1.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence

from hexdbb.capture.bursts import ReceivedBurst, SentBurst
from hexdbb.capture.frames import GuardedBus
from hexdbb.capture.pdo import DRIVE_RPDO, DRIVE_TPDO, GAUGE_TPDO, SYNC_ID, together
from hexdbb.capture.socketcand import Frame

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
        Whether the answers belong to this SYNC as far as known: none is missing and none of an earlier SYNC was
        outstanding. One too many may still show otherwise (`Exchange.doubtful`).
    wrong_length : tuple of int, or None
        Slot of an answer that has not the configured length, its number of bytes, and the expected one.
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
        "wrong_length",
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
        self.wrong_length: tuple[int, int, int] | None = None


class Exchange:
    """Sends and receives the process data of a cycle; its memory does not grow.

    Parameters
    ----------
    bus : GuardedBus
        An open bus that nothing else reads.
    drive_nodes : sequence of int
        Node ids of the drives of sliders 1 to 6.
    gauge_node : int
        Node id of the gauge.
    other : callable
        Called with identifier, data and timestamp of every frame that is not process data.
    sync_overflow : int
        Largest number that SYNCs carry, after which they count from 1 again (1019h); 0 for SYNCs without data.

    Attributes
    ----------
    feedback : Feedback
        Answers to the last SYNC.
    late_s : dict of int to float
        Time (s) from the SYNC to the last late answer of a slot.
    doubtful : bool
        Whether answers since `Loop.confirm` reset it may belong to another SYNC: a node answered once more than it was
        asked.
    repeated : int
        Answers too many, so far.
    sync_s : float
        Monotonic time of the last SYNC, s.
    """

    def __init__(
        self,
        bus: GuardedBus,
        drive_nodes: Sequence[int],
        gauge_node: int,
        other: Callable[[int, bytes | bytearray, float], None],
        sync_overflow: int = 0,
    ) -> None:
        self._bus, self._other = bus, other
        self._sync_overflow = sync_overflow
        targets = [(DRIVE_RPDO.cob_id(node), DRIVE_RPDO.bytes) for node in drive_nodes]
        sync = (SYNC_ID, 1 if sync_overflow else 0)
        self._targets, self._sync, self._both = SentBurst(targets), SentBurst([sync]), SentBurst([*targets, sync])
        self._answers = ReceivedBurst(
            [
                *((DRIVE_TPDO.cob_id(node), DRIVE_TPDO.bytes) for node in drive_nodes),
                (GAUGE_TPDO.cob_id(gauge_node), GAUGE_TPDO.bytes),
            ]
        )
        self._slots = {DRIVE_TPDO.cob_id(node): slot for slot, node in enumerate(drive_nodes)}
        self._slots[GAUGE_TPDO.cob_id(gauge_node)] = GAUGE_SLOT
        self._drive, self._gauge = DRIVE_TPDO.struct, GAUGE_TPDO.struct
        self._rpdos = together([DRIVE_RPDO] * len(drive_nodes))
        self._tpdos = together([DRIVE_TPDO] * len(drive_nodes) + [GAUGE_TPDO])
        self._packed, self._number = bytes(self._rpdos.size), 0
        self.feedback = Feedback()
        self.late_s: dict[int, float] = {}
        self.doubtful = False
        self.repeated = 0
        self.last_repeated: int | None = None
        self._given_up: set[int] = set()
        self._outstanding: set[int] = set()
        self._owed = [0] * SLOTS
        self._alone = True
        self.sync_s = 0.0

    def set_targets(self, controlwords: Sequence[int], counts: Sequence[int]) -> None:
        """Pack the six RPDOs, which take effect at the SYNC after they were sent.

        Parameters
        ----------
        controlwords : sequence of int
            Object 6040h of each drive, shape (6,).
        counts : sequence of int
            Object 607Ah of each drive, shape (6,).
        """
        values: list[int] = [0] * (2 * GAUGE_SLOT)
        values[0::2], values[1::2] = controlwords, counts
        self._packed = self._rpdos.pack(*values)

    def send_targets(self) -> None:
        """Send the RPDOs as packed last; raises `can.CanError` if the bus cannot send."""
        self._bus.send_burst(self._targets, self._packed)

    def send_sync(self, with_targets: bool = False) -> None:
        """Send the SYNC, the RPDOs before it if asked for; raises `can.CanError` if the bus cannot send."""
        number = b""
        if self._sync_overflow:
            self._number = self._number % self._sync_overflow + 1
            number = bytes((self._number,))
        self._alone = not any(self._owed)
        if with_targets:
            self._bus.send_burst(self._both, self._packed + number)
        else:
            self._bus.send_burst(self._sync, number)
        self.sync_s = time.monotonic()
        self.feedback.cycle += 1
        self._outstanding = set(range(SLOTS))

    def collect(self, timeout_s: float) -> Feedback:
        """Receive the answers to the last SYNC; called again, those that have come since.

        Parameters
        ----------
        timeout_s : float
            Longest time to wait, s; also where frames of others never end.

        Returns
        -------
        Feedback
            The same object in every cycle; `missing` names the slots without an answer.
        """
        end_s = time.monotonic() + timeout_s
        take, outstanding, given_up, backlog = self._bus.take, self._outstanding, self._given_up, MAX_BACKLOG
        if len(outstanding) == SLOTS and not given_up:
            data = self._bus.take_burst(self._answers, timeout_s)
            if data is not None:
                self._decode_all(data)
                outstanding.clear()
        while backlog and not outstanding <= given_up:
            left_s = end_s - time.monotonic()
            backlog -= left_s <= 0.0
            frame = take(left_s if left_s > 0.0 else 0.0)
            if frame is not None:
                self._take(frame)
            elif left_s <= 0.0:
                break
        self.feedback.missing = tuple(sorted(outstanding))
        self.feedback.settled = self._alone and not outstanding
        return self.feedback

    def drain(self, quiet_s: float = 0.0) -> None:
        """Receive the frames that arrived since the last answers, until none arrives for `quiet_s` seconds.

        Answers among them come late, to be paired no more, or are one too many.
        """
        for _ in range(MAX_BACKLOG):
            frame = self._bus.take(quiet_s)
            if frame is None:
                self.feedback.flooded = 0
                return
            self._take(frame, late=True)
        self.feedback.flooded += 1

    def await_late(self, timeout_s: float) -> None:
        """Wait for the missing answers to the last SYNC; after that they count as lost and may come no more."""
        end_s = time.monotonic() + timeout_s
        while self.is_waiting() and (left_s := end_s - time.monotonic()) > 0.0:
            frame = self._bus.take(left_s)
            if frame is not None:
                self._take(frame, late=True)

    def is_waiting(self) -> bool:
        """Return whether an answer to the last SYNC may still come."""
        return not self._outstanding <= self._given_up

    def end_waiting(self) -> None:
        """Wait no longer for the missing answers: they are owed, and may come instead of those to a later SYNC."""
        for slot in self._outstanding:
            self._owed[slot] += 1
        self._outstanding = set()

    @property
    def owed(self) -> int:
        """Number of answers that no SYNC waits for any more but that may still come."""
        return sum(self._owed)

    def forget_owed(self) -> None:
        """Count the answers owed as lost: those to the next SYNC are its own."""
        self._owed = [0] * SLOTS

    def give_up(self, slots: Iterable[int]) -> None:
        """Stop waiting for the answers of some slots; they count as missing."""
        self._given_up.update(slots)

    def listen(self, timeout_s: float) -> None:
        """Receive frames for `timeout_s` seconds while no SYNC is being answered."""
        end_s = time.monotonic() + timeout_s
        while (left_s := end_s - time.monotonic()) > 0.0:
            frame = self._bus.take(left_s)
            if frame is not None:
                self._take(frame, late=True)

    def _take(self, frame: Frame, late: bool = False) -> None:
        """Take in one frame: an answer, one too many or too late, or a frame of another service."""
        can_id, data, _ = frame
        slot = self._slots.get(can_id)
        if slot is None:
            self._other(*frame)
        elif slot not in self._outstanding:
            self.doubtful = True
            if self._owed[slot]:
                self._owed[slot] -= 1
            else:
                self.last_repeated = slot
                self.repeated += 1
        elif late:
            self._outstanding.discard(slot)
            self.late_s[slot] = time.monotonic() - self.sync_s
        elif self._decode(slot, data):
            self._outstanding.discard(slot)

    def _decode_all(self, data: bytes) -> None:
        """Decode the answers of all slots in order."""
        feedback, values = self.feedback, self._tpdos.unpack(data)
        feedback.statusword[:], feedback.position[:], feedback.mode[:] = values[0:18:3], values[1:18:3], values[2:18:3]
        feedback.reading_um, feedback.gauge_status = values[18:]

    def _decode(self, slot: int, data: bytes | bytearray) -> bool:
        """Decode one answer; return False if its length is not the configured one, so that it counts as missing."""
        feedback = self.feedback
        layout = self._gauge if slot == GAUGE_SLOT else self._drive
        if len(data) != layout.size:
            feedback.wrong_length = (slot, len(data), layout.size)
            return False
        if slot == GAUGE_SLOT:
            feedback.reading_um, feedback.gauge_status = layout.unpack(data)
        else:
            feedback.statusword[slot], feedback.position[slot], feedback.mode[slot] = layout.unpack(data)
        return True
