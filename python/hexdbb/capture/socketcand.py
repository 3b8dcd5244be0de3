"""Client of a socketcand server, which passes on every frame that can be parsed and drops the rest by name.

python-can's own client parses the same text again after a message it cannot parse, so that one such message ends the
connection for good; it takes a closed connection for silence, and expects each answer of the handshake in a read of
its own.
Source: socketcand protocol description (github.com/linux-can/socketcand), raw mode.
"""

from __future__ import annotations

import select
import socket
from collections import deque

import can

SEND_TIMEOUT_S = 1.0
"""Longest time until the server takes a frame, s. A server that reads nothing for a second has lost its bus: the drives
stop on their own by then (RPDO timeout, 100 ms)."""
ANSWER_TIMEOUT_S = 3.0
"""Longest time for one answer of the handshake, s: as long as for the connection."""
LONGEST_MESSAGE = 200
"""Characters without an end of message after which they are dropped; a frame message has less than 60."""
RECEIVE_BYTES = 65536
KEPT_DROPPED = 16
"""Number of dropped messages that are kept as text: enough to recognise their cause, and memory does not grow."""


class SocketcandBus(can.BusABC):
    """A CAN bus behind a socketcand server.

    Parameters
    ----------
    connection : socket.socket
        Connection to the server, just established; closed by `shutdown`.
    channel : str
        Bus of the server.

    Attributes
    ----------
    dropped : deque of str
        The last messages that were dropped because they cannot be parsed.

    Raises
    ------
    can.CanInitializationError
        The server does not answer as the protocol prescribes.
    """

    def __init__(self, connection: socket.socket, channel: str) -> None:
        self._connection, self._text = connection, b""
        self._received: deque[can.Message] = deque()
        self.dropped: deque[str] = deque(maxlen=KEPT_DROPPED)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._expect(b"< hi >")
        for request in (f"< open {channel} >", "< rawmode >"):
            connection.sendall(request.encode("ascii"))
            self._expect(b"< ok >")
        connection.settimeout(SEND_TIMEOUT_S)
        host, port = connection.getpeername()[:2]
        self.channel_info = f"socketcand {channel}@{host}:{port}"
        super().__init__(channel)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame; raises `can.CanOperationError` if the server does not take it."""
        data = " ".join(f"{byte:x}" for byte in msg.data)
        identifier = f"{msg.arbitration_id:08X}" if msg.is_extended_id else f"{msg.arbitration_id:03X}"
        try:
            self._connection.sendall(f"< send {identifier} {msg.dlc:X} {data} >".encode("ascii"))
            self._acknowledge_at_once()
        except OSError as error:
            raise can.CanOperationError(f"cannot send: {error.strerror or error}") from None

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        if not self._received:
            try:
                ready, _, _ = select.select([self._connection], [], [], timeout)
                if ready:
                    self._parse(self._connection.recv(RECEIVE_BYTES))
                    self._acknowledge_at_once()
            except OSError as error:
                raise can.CanOperationError(f"cannot receive: {error.strerror or error}") from None
        return (self._received.popleft(), False) if self._received else (None, False)

    def shutdown(self) -> None:
        """Close the connection."""
        super().shutdown()
        self._connection.close()

    def _acknowledge_at_once(self) -> None:
        # Without it the kernel delays acknowledgements by up to 40 ms, and with them the server's next frames.
        self._connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_QUICKACK, 1)

    def _expect(self, answer: bytes) -> None:
        """Receive one answer of the handshake."""
        self._connection.settimeout(ANSWER_TIMEOUT_S)
        while b">" not in self._text and len(self._text) < LONGEST_MESSAGE:
            received = self._connection.recv(RECEIVE_BYTES)
            if not received:
                raise can.CanInitializationError("the socketcand server closed the connection")
            self._text += received
        found, _, rest = self._text.partition(b">")
        if (found + b">").split() != answer.split():
            raise can.CanInitializationError(f"the server answers {_shown(found)} (expected {answer.decode()})")
        self._text = rest

    def _parse(self, received: bytes) -> None:
        """Append the frames of whole messages to those received; keep the beginning of the next message."""
        if not received:
            raise can.CanOperationError("the socketcand server closed the connection")
        *messages, self._text = (self._text + received).split(b">")
        for message in messages:
            frame = parse_frame(message, self.channel_info)
            if frame is None:
                self.dropped.append(_shown(message))
            else:
                self._received.append(frame)
        if len(self._text) > LONGEST_MESSAGE:
            self.dropped.append(_shown(self._text))
            self._text = b""


def parse_frame(message: bytes, channel: str) -> can.Message | None:
    """Parse ``< frame ID SECONDS DATA`` or ``< error ...``, the closing ``>`` taken away; None if it is neither."""
    words = message.split()
    try:
        if words[:2] == [b"<", b"error"]:
            return can.Message(arbitration_id=int(words[2], 16) & 0x1FFFFFFF, is_error_frame=True, channel=channel)
        if words[:2] != [b"<", b"frame"] or not 4 <= len(words) <= 5:
            return None
        data = bytes.fromhex(words[4].decode("ascii")) if len(words) == 5 else b""
        return can.Message(
            timestamp=float(words[3]),
            arbitration_id=int(words[2], 16),
            is_extended_id=len(words[2]) != 3,
            data=data,
            channel=channel,
            check=True,
        )
    except (ValueError, IndexError):
        return None


def _shown(message: bytes) -> str:
    """Return the beginning of a message as printable text on one line."""
    return ascii(message[:60].decode("latin-1").strip())
