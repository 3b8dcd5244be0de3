"""One bus with two readers: a receiving thread while nodes are configured, the cyclic loop alone while axes move.

Assumption users get wrong: callbacks through python-can's Notifier lose frames under load, so no thread reads the bus
during motion. The loop passes frames of other services (SDO, EMCY, heartbeats) on to `canopen`, and frames that a
helper thread sends wait in an outbox until the loop sends them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager

import can
import canopen

NOTIFIER_CYCLE_S = 0.02
"""Longest time the receiving thread blocks in one read: the delay until it ends when the configuration is finished."""


class Link(canopen.Network):
    """A canopen network whose frames are received by a thread or by the loop.

    Parameters
    ----------
    bus : can.BusABC
        An open bus; the caller closes it.
    """

    def __init__(self, bus: can.BusABC) -> None:
        super().__init__(bus)
        self._outbox: deque[can.Message] | None = None

    @contextmanager
    def threaded(self) -> Iterator[None]:
        """Receive in a thread that passes frames on to `canopen`, for the length of the context."""
        notifier = can.Notifier(self.bus, self.listeners, NOTIFIER_CYCLE_S)
        try:
            yield
        finally:
            notifier.stop()

    @contextmanager
    def looped(self) -> Iterator[None]:
        """Leave receiving to the caller and queue outgoing frames until `flush`, for the length of the context."""
        self._outbox = deque()
        try:
            yield
        finally:
            self.flush()
            self._outbox = None

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """Send a frame now, or queue it for the loop."""
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
