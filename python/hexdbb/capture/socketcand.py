"""Client of a socketcand server, which passes on every frame that can be parsed and drops the rest by name.

python-can's own client parses the same text again after a message it cannot parse, so that one such message ends the
connection for good; it takes a closed connection for silence, and expects each answer of the handshake in a read of
its own. It also makes an object of every frame and a system call of every frame sent, which costs more than the rest of
a cycle: here all messages that have arrived are read and parsed together, and several frames are sent together.
Source: socketcand protocol description (github.com/linux-can/socketcand), raw mode.
"""

from __future__ import annotations

import math
import select
import socket
from binascii import unhexlify
from collections import deque
from collections.abc import Sequence

import can

from hexdbb.capture.bursts import ReceivedBurst, SentBurst

Frame = tuple[int, bytes | bytearray, float]
"""A data frame with an 11-bit identifier: identifier, data, timestamp (s)."""

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
IDENTIFIERS = {f"{can_id:03X}".encode(): can_id for can_id in range(0x800)}
"""11-bit identifiers as a server writes them."""
WORDS = 5
"""Words of a message up to the one that the next begins with: ``<``, ``frame``, identifier, seconds, data."""
MAX_BYTES = 8
"""Data bytes of a classical frame."""


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
    received : deque of Frame or can.Message
        Frames that were read and not taken yet; messages where they are no data frames of 11 bits.
    dropped : deque of str
        The last messages that were dropped because they cannot be parsed.

    Raises
    ------
    can.CanInitializationError
        The server does not answer as the protocol prescribes.
    """

    def __init__(self, connection: socket.socket, channel: str) -> None:
        self._connection, self._text = connection, b""
        self.received: deque[Frame | can.Message] = deque()
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
        self.send_all([msg])

    def send_all(self, messages: Sequence[can.Message]) -> None:
        """Send frames in order, in one segment; raises `can.CanOperationError` if the server does not take them."""
        self._send("".join([_sent(message) for message in messages]).encode("ascii"))

    def send_burst(self, burst: SentBurst, data: bytes) -> None:
        """Send frames in one segment; raises `can.CanOperationError` if the server does not take them."""
        self._send(burst.text(data))

    def _send(self, text: bytes) -> None:
        try:
            self._connection.sendall(text)
            self._acknowledge_at_once()
        except OSError as error:
            raise can.CanOperationError(f"cannot send: {error.strerror or error}") from None

    def receive(self, timeout: float | None) -> Frame | can.Message | None:
        """Return the next frame, or None after `timeout` seconds; a message where it is no data frame of 11 bits.

        Raises
        ------
        can.CanOperationError
            The connection is lost.
        """
        if not self.received and (text := self._read(timeout)) is not None:
            self._parse(text)
        return self.received.popleft() if self.received else None

    def receive_burst(self, burst: ReceivedBurst, timeout: float | None) -> bytes | None:
        """Return the data of frames that arrive together, and alone; None where anything else, or nothing, arrives.

        What else arrives is received by `receive`, frame by frame.

        Raises
        ------
        can.CanOperationError
            The connection is lost.
        """
        if self.received or (text := self._read(timeout)) is None:
            return None
        data = None if self._text else burst.data_of(text)
        if data is None:
            self._parse(text)
        return data

    def _read(self, timeout: float | None) -> bytes | None:
        """Return what has arrived, or None after `timeout` seconds."""
        try:
            ready, _, _ = select.select([self._connection], [], [], timeout)
            if not ready:
                return None
            text = self._connection.recv(RECEIVE_BYTES)
            self._acknowledge_at_once()
        except OSError as error:
            raise can.CanOperationError(f"cannot receive: {error.strerror or error}") from None
        return text

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        frame = self.receive(timeout)
        return as_message(frame, self.channel_info) if isinstance(frame, tuple) else frame, False

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
        text = self._text + received
        frames = parse_frames(text)
        if frames is not None:
            self.received += frames
            self._text = b""
            return
        *messages, self._text = text.split(b">")
        for message in messages:
            frame = parse_frame(message, self.channel_info)
            if frame is None:
                self.dropped.append(_shown(message))
            else:
                self.received.append(as_frame(frame))
        if len(self._text) > LONGEST_MESSAGE:
            self.dropped.append(_shown(self._text))
            self._text = b""


def parse_frames(text: bytes) -> list[Frame] | None:
    """Parse whole messages of data frames with 11-bit identifiers, as a server writes them, all at once.

    Parameters
    ----------
    text : bytes
        ``< frame ID SECONDS DATA >`` any number of times, without anything between them.

    Returns
    -------
    list of Frame, or None
        None where a single character differs: then `parse_frame` decides, message by message.
    """
    words = text.split(b" ")
    count, rest = divmod(len(words), WORDS)
    if rest != 1 or words[0] != b"<" or words[-1] != b">" or words[WORDS:-1:WORDS] != [b"><"] * (count - 1):
        return None
    if words[1::WORDS] != [b"frame"] * count:
        return None
    try:
        can_ids = [IDENTIFIERS[word] for word in words[2::WORDS]]
        data = [unhexlify(word) for word in words[4::WORDS]]
        times_s = [float(word) for word in words[3::WORDS]]
    except (KeyError, ValueError):
        return None
    # A sum is not below infinity where one of its terms is infinite or no number.
    if max(map(len, data)) > MAX_BYTES or min(times_s) < 0.0 or not sum(times_s) < math.inf:
        return None
    return list(zip(can_ids, data, times_s, strict=True))


def as_frame(message: can.Message) -> Frame | can.Message:
    """Return a message of python-can as a frame; the message itself where it is no data frame of 11 bits."""
    if message.is_extended_id or message.is_error_frame or message.is_remote_frame or message.is_fd:
        return message
    return message.arbitration_id, message.data, message.timestamp


def as_message(frame: Frame, channel: str | None = None) -> can.Message:
    """Return a frame as python-can represents it."""
    can_id, data, time_s = frame
    return can.Message(timestamp=time_s, arbitration_id=can_id, is_extended_id=False, data=data, channel=channel)


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


def _sent(message: can.Message) -> str:
    """Return the request to send a frame."""
    identifier = f"{message.arbitration_id:08X}" if message.is_extended_id else f"{message.arbitration_id:03X}"
    return f"< send {identifier} {message.dlc:X} {message.data.hex(' ')} >"


def _shown(message: bytes) -> str:
    """Return the beginning of a message as printable text on one line."""
    return ascii(message[:60].decode("latin-1").strip())
