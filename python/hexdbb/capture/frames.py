"""What a frame from the bus must be like before anything else looks at it.

One guard for all readers: a bus hands on data frames with 11-bit identifiers only, and a frame of a CANopen service is
examined for its length before its service is processed. Nothing that a device or another computer sends raises behind
this guard.
Source: CiA 301, predefined connection set and frame lengths of NMT, EMCY, SDO and error control.
"""

from __future__ import annotations

import struct
import time
from collections import deque
from collections.abc import Callable, Sequence
from typing import ParamSpec, Protocol, TypeVar

import can

from hexdbb.capture.bursts import ReceivedBurst, SentBurst
from hexdbb.capture.socketcand import Frame, SocketcandBus, as_frame, as_message
from hexdbb.capture.transport import one_line

P = ParamSpec("P")
T = TypeVar("T")

NODE_MASK = 0x7F
NMT, EMCY_BASE, SDO_ANSWER_BASE, HEARTBEAT_BASE = 0x000, 0x080, 0x580, 0x700
"""CAN identifiers of node 0 (predefined connection set)."""
LENGTHS = {
    NMT: ("NMT command", 2),
    EMCY_BASE: ("EMCY", 8),
    SDO_ANSWER_BASE: ("SDO answer", 8),
    HEARTBEAT_BASE: ("heartbeat", 1),
}
"""Name and number of data bytes of a service, by its identifier for node 0."""
MAX_FOREIGN = 1000
"""Frames of another kind to skip in one read: twenty times what a bus carries in a cycle of 4 ms, and a flood of them
cannot hold up the loop."""
KEPT_FOREIGN = 16
"""Number of foreign frames kept as text; memory does not grow."""


class FrameSource(Protocol):
    """What `GuardedBus` needs of a bus."""

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """Return the next frame, or None after `timeout` seconds."""

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame."""


class GuardedBus:
    """A bus of which nothing but data frames with 11-bit identifiers is seen, and that raises `can.CanError` only.

    From and to a socketcand server frames come without an object for each of them, and several leave together.

    Parameters
    ----------
    bus : can.BusABC
        An open bus; the caller closes it.

    Attributes
    ----------
    foreign : deque of str
        The last frames that were skipped: error frames of the controller, remote and extended frames.
    """

    def __init__(self, bus: FrameSource) -> None:
        self._bus = bus
        self._next: Callable[[float | None], Frame | can.Message | None] = self._next_of_any
        self._send_all: Callable[[Sequence[can.Message]], None] = self._send_each
        self._received: deque[Frame | can.Message] = deque()
        self._send_burst: Callable[[SentBurst, bytes], None] = lambda burst, data: self._send_each(burst.filled(data))
        self._next_burst: Callable[[ReceivedBurst, float | None], bytes | None] = lambda burst, timeout: None
        if isinstance(bus, SocketcandBus):
            self._next, self._send_all, self._received = bus.receive, bus.send_all, bus.received
            self._send_burst, self._next_burst = bus.send_burst, bus.receive_burst
        self.foreign: deque[str] = deque(maxlen=KEPT_FOREIGN)

    def take(self, timeout: float | None = None) -> Frame | None:
        """Return the next data frame with an 11-bit identifier, or None after `timeout` seconds.

        Raises
        ------
        can.CanError
            The bus cannot receive.
        """
        frame = self._received.popleft() if self._received else self._receive(timeout)
        if frame is None or isinstance(frame, tuple):
            return frame
        end_s = None if timeout is None else time.monotonic() + timeout
        for _ in range(MAX_FOREIGN):
            self.foreign.append(str(frame).strip())
            frame = self._receive(None if end_s is None else max(end_s - time.monotonic(), 0.0))
            if frame is None or isinstance(frame, tuple):
                return frame
        return None

    def take_burst(self, burst: ReceivedBurst, timeout: float | None = None) -> bytes | None:
        """Return the data of frames that arrive together, and alone, from a server that sends them so; or None.

        Waits `timeout` seconds at most, and on a bus without such a server not at all. What else arrives is left to
        `take`.

        Raises
        ------
        can.CanError
            The bus cannot receive.
        """
        return _guarded("receive", self._next_burst, burst, timeout)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """Return what `take` returns as python-can represents it."""
        frame = self.take(timeout)
        return None if frame is None else as_message(frame)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame; raises `can.CanError` if the bus cannot."""
        self.send_all([msg])

    def send_all(self, messages: Sequence[can.Message]) -> None:
        """Send frames in order; raises `can.CanError` if the bus cannot."""
        _guarded("send", self._send_all, messages)

    def send_burst(self, burst: SentBurst, data: bytes) -> None:
        """Send frames in order with the data of all of them; raises `can.CanError` if the bus cannot."""
        _guarded("send", self._send_burst, burst, data)

    def notes(self) -> list[str]:
        """Return one line for each kind of thing that was skipped, with the last of them."""
        skipped = {"frame other than data with an 11-bit identifier": self.foreign}
        skipped["message that cannot be parsed"] = getattr(self._bus, "dropped", deque())
        return [f"bus: skipped, {what}: {last[-1]}" for what, last in skipped.items() if last]

    def _next_of_any(self, timeout: float | None) -> Frame | can.Message | None:
        """Return the next frame of a bus of python-can; a message where it is no data frame of 11 bits."""
        message = self._bus.recv(timeout)
        return None if message is None else as_frame(message)

    def _send_each(self, messages: Sequence[can.Message]) -> None:
        for message in messages:
            self._bus.send(message)

    def _receive(self, timeout: float | None) -> Frame | can.Message | None:
        return _guarded("receive", self._next, timeout)


def _guarded(what: str, call: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """Call a driver, which raises what its libraries and parsers raise: the bus is lost, by any name."""
    try:
        return call(*arguments, **named)
    except (can.CanError, OSError):
        raise
    except Exception as error:
        raise can.CanOperationError(f"cannot {what}: {one_line(error)}") from error


def service_of(can_id: int) -> tuple[int, int]:
    """Return service (its identifier for node 0) and node of an 11-bit identifier."""
    return can_id & ~NODE_MASK, can_id & NODE_MASK


def malformed(can_id: int, data: bytes | bytearray) -> str | None:
    """Return what is wrong with a frame of a CANopen service as part of a message, or None.

    Parameters
    ----------
    can_id : int
        Its 11-bit identifier.
    data : bytes
        Its data, 0 to 8 bytes.
    """
    service, node = service_of(can_id)
    if service not in LENGTHS or (service == NMT) != (node == 0):
        return None
    what, length = LENGTHS[service]
    if len(data) == length:
        return None
    found = f"{len(data)} bytes ({data.hex(' ').upper()})" if data else "0 bytes"
    return f"{what} of {found} (expected {length})"


def emergency_code(data: bytes | bytearray) -> int | None:
    """Return the error code of an EMCY, also of one cut short; None if its first two bytes are missing."""
    return int(struct.unpack_from("<H", data)[0]) if len(data) >= 2 else None
