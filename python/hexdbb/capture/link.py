"""One bus with two readers: a receiving thread while nodes are configured, the cyclic loop alone while axes move.

Assumption users get wrong: callbacks through python-can's Notifier lose frames under load, so no thread reads the bus
during motion. The loop passes frames of other services (SDO, EMCY, heartbeats) on to `canopen`, and frames that a
helper thread sends wait in an outbox until the loop sends them.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager

import can
import canopen

from hexdbb.capture.frames import SDO_ANSWER_BASE, GuardedBus, malformed, service_of

READ_S = 0.02
"""Longest time the receiving thread blocks in one read: the delay until it ends when the configuration is finished."""


class Link(canopen.Network):
    """A canopen network whose frames are received by a thread or by the loop.

    Parameters
    ----------
    bus : can.BusABC
        An open bus; the caller closes it.

    Attributes
    ----------
    malformed : dict of int to str
        The last frame of a node that its service does not allow, in words, by node id; 0 for NMT commands.
    """

    def __init__(self, bus: can.BusABC) -> None:
        self._guard = GuardedBus(bus)
        super().__init__(self._guard)
        self.malformed: dict[int, str] = {}
        self._outbox: deque[can.Message] | None = None
        self._lost: Exception | None = None

    @contextmanager
    def threaded(self) -> Iterator[None]:
        """Receive in a thread that passes frames on to `canopen`, for the length of the context."""
        finished = threading.Event()
        thread = threading.Thread(target=self._receive, args=(finished,), name="hexdbb-receive", daemon=True)
        thread.start()
        try:
            yield
        finally:
            finished.set()
            thread.join()

    @contextmanager
    def looped(self) -> Iterator[None]:
        """Leave receiving to the caller and queue outgoing frames until `flush`, for the length of the context."""
        self._outbox = deque()
        try:
            yield
        finally:
            self.flush()
            self._outbox = None

    def notify(self, can_id: int, data: bytes | bytearray, timestamp: float) -> None:
        """Process a frame: keep what is wrong with it, or pass an SDO answer on to `canopen`.

        `canopen` is given nothing else: its consumers of EMCY, NMT and heartbeat raise for frames cut short and keep
        every EMCY of a run.
        """
        service, node = service_of(can_id)
        wrong = malformed(can_id, data)
        if wrong is not None:
            self.malformed[node] = wrong
        elif service == SDO_ANSWER_BASE:
            super().notify(can_id, data, timestamp)

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """Send a frame now, or queue it for the loop; raises `can.CanError` if the bus is lost."""
        if self._lost is not None:
            raise self._lost
        if self._outbox is None:
            super().send_message(can_id, data, remote)
        else:
            self._outbox.append(
                can.Message(arbitration_id=can_id, data=data, is_extended_id=False, is_remote_frame=remote)
            )

    def flush(self) -> None:
        """Send the queued frames."""
        while self._outbox:
            self.bus.send(self._outbox.popleft())

    def notes(self) -> list[str]:
        """Return one line for each frame or message that was skipped or malformed outside the cyclic loop."""
        named = [f"node {node}: {wrong}" if node else f"bus: {wrong}" for node, wrong in self.malformed.items()]
        return [*named, *self._guard.notes()]

    def _receive(self, finished: threading.Event) -> None:
        while not finished.is_set():
            try:
                frame = self._guard.take(READ_S)
            except (can.CanError, OSError) as error:
                self._lost = error  # raised where the next frame is sent: nobody waits for this thread
                return
            if frame is not None:
                self.notify(*frame)
