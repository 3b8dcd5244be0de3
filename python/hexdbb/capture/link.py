"""One bus, two ways to use it: a receiving thread while nodes are configured, the loop alone while axes move.

Assumption users get wrong: callbacks through python-can's Notifier lose frames under load, so during motion no thread
reads the bus. Frames of other services (SDO, EMCY, heartbeats) that the loop receives are handed to `canopen` from
the loop, and frames a helper thread wants to send wait in an outbox until the loop sends them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager

import can
import canopen

NOTIFIER_CYCLE_S = 0.02


class Link(canopen.Network):
    """A canopen network whose frames go through a thread or through the loop.

    Parameters
    ----------
    bus : an open python-can bus; closing it is the caller's business
    """

    def __init__(self, bus: can.BusABC) -> None:
        super().__init__(bus)
        self._outbox: deque[can.Message] | None = None

    @contextmanager
    def threaded(self) -> Iterator[None]:
        """While inside, a thread receives and hands frames to `canopen`."""
        notifier = can.Notifier(self.bus, self.listeners, NOTIFIER_CYCLE_S)
        try:
            yield
        finally:
            notifier.stop()

    @contextmanager
    def looped(self) -> Iterator[None]:
        """While inside, the caller receives, and sends what `flush` finds in the outbox."""
        self._outbox = deque()
        try:
            yield
        finally:
            self.flush()
            self._outbox = None

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """Send a frame, or leave it to the loop."""
        if self._outbox is None:
            super().send_message(can_id, data, remote)
        else:
            self._outbox.append(
                can.Message(arbitration_id=can_id, data=data, is_extended_id=False, is_remote_frame=remote)
            )

    def flush(self) -> None:
        """Send the frames in the outbox."""
        while self._outbox:
            self.bus.send(self._outbox.popleft())
