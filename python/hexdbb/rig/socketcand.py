"""A CAN bus served as socketcand over TCP on the loopback interface.

Model: clients use the text protocol of socketcand in raw mode. A frame of one client reaches the rig and all other
clients; a frame of the rig reaches all clients. The frames of one burst leave in one segment, so that clients do not
receive parts of a frame.
Assumption: trusted local clients; 11-bit data frames only.
Source: socketcand protocol description (github.com/linux-can/socketcand); python-can's client expects `< hi >` and
each `< ok >` in a read of its own, which holds because nothing else is sent to a client before these answers.
"""

from __future__ import annotations

import logging
import selectors
import socket
import time
from collections.abc import Callable

from hexdbb.errors import InputError
from hexdbb.rig.bursts import ReceivedBursts, SentBursts
from hexdbb.rig.frame import Frame

log = logging.getLogger(__name__)

POLL_S = 0.002
"""Time between two polls with a client, s: half a cycle at 250 Hz, short against every timeout of the nodes."""
RECEIVE_BYTES = 65536
LONGEST_MESSAGE = 200
"""Bytes without an end of message after which a client is disconnected; a frame message has less than 60."""
SETTLE_S = 0.02
"""Silence after the handshake, s, because python-can expects the last `< ok >` in a read of its own."""
IDLE_S = 0.1
"""Time between two polls without a client, s."""
HEAD = 12
"""Characters of a message up to its data, for an 11-bit identifier."""
SPACES = b" " * 9
"""A space before and after every byte."""
_HEADS = {f"< send {can_id:03X} {n}".encode(): (can_id, n) for can_id in range(0x800) for n in range(9)}
"""Identifier and number of data bytes by the beginning of a message."""


class _Client:
    """One connection."""

    def __init__(self, connection: socket.socket) -> None:
        self.connection = connection
        self.buffer = b""
        self.raw_since_s: float | None = None
        self.bursts = ReceivedBursts()

    @property
    def may_receive(self) -> bool:
        """Whether frames may be sent to it: after its first frame or `SETTLE_S`, apart from the handshake."""
        return self.raw_since_s is not None and time.monotonic() - self.raw_since_s > SETTLE_S


class SocketcandServer:
    """Server of one bus.

    Parameters
    ----------
    port : int
        TCP port on 127.0.0.1; 0 takes a free one.
    on_frames : callable
        Called with frames of a client that were read together, in order.
    on_poll : callable
        Called with the monotonic time every few milliseconds.
    on_last_client_gone : callable
        Called when the last client has disconnected.

    Raises
    ------
    InputError
        The port is taken.
    """

    def __init__(
        self,
        port: int,
        on_frames: Callable[[list[Frame]], None],
        on_poll: Callable[[float], None],
        on_last_client_gone: Callable[[], None],
    ) -> None:
        self._on_frames, self._on_poll, self._on_last_client_gone = on_frames, on_poll, on_last_client_gone
        self._clients: dict[socket.socket, _Client] = {}
        self._bursts = SentBursts()
        self._selector = selectors.DefaultSelector()
        self._listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            self._listener.bind(("127.0.0.1", port))
        except OSError as error:
            self._listener.close()
            raise InputError(f"--port {port}: {error.strerror} (expected a free port, or 0)") from None
        self._listener.listen()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._running, self._ending = True, False

    @property
    def port(self) -> int:
        """The TCP port it listens on."""
        return int(self._listener.getsockname()[1])

    def stop(self) -> None:
        """End `serve`; may be called from a signal handler or a callback."""
        self._running = False

    def stop_when_alone(self) -> None:
        """End `serve` when no client is connected; at once if called twice."""
        if self._ending or not self._clients:
            self.stop()
        self._ending = True

    def serve(self) -> None:
        """Serve until stopped."""
        next_poll_s = 0.0
        while self._running:
            for key, _ in self._selector.select(POLL_S if self._clients else IDLE_S):
                if key.data is None:
                    self._accept()
                else:
                    self._read(key.data)
            now_s = time.monotonic()
            if now_s >= next_poll_s:
                next_poll_s = now_s + POLL_S
                self._on_poll(now_s)
        self.close()

    def close(self) -> None:
        """Close all connections."""
        for client in list(self._clients.values()):
            client.connection.close()
        self._clients.clear()
        self._listener.close()
        self._selector.close()

    def transmit(self, frames: list[Frame]) -> None:
        """Send frames to all clients, in one segment."""
        self._broadcast(frames, None)

    def disconnect_all(self) -> None:
        """Break all connections; new clients are accepted."""
        for client in list(self._clients.values()):
            self._drop(client)

    def _broadcast(self, frames: list[Frame], but: _Client | None) -> None:
        listening = [client for client in self._clients.values() if client.may_receive and client is not but]
        if listening:
            stamp = f"{time.time():.6f}"
            text = self._bursts.text(frames, stamp)
            for client in listening:
                self._send(client, text)

    def _send(self, client: _Client, data: bytes) -> None:
        try:
            client.connection.sendall(data)
        except OSError as error:
            log.warning("client lost: %s", error.strerror)
            self._drop(client)

    def _accept(self) -> None:
        connection, address = self._listener.accept()
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        client = _Client(connection)
        self._clients[connection] = client
        self._selector.register(connection, selectors.EVENT_READ, client)
        log.info("client connected from %s:%d", *address)
        self._send(client, b"< hi >")

    def _drop(self, client: _Client) -> None:
        if self._clients.pop(client.connection, None) is None:
            return
        self._selector.unregister(client.connection)
        client.connection.close()
        log.info("client disconnected")
        if not self._clients:
            self._on_last_client_gone()
            self._running = self._running and not self._ending

    def _read(self, client: _Client) -> None:
        try:
            data = client.connection.recv(RECEIVE_BYTES)
        except OSError:
            data = b""
        if not data:
            self._drop(client)
            return
        text, is_raw = client.buffer + data, client.raw_since_s is not None
        frames = client.bursts.frames_of(text) if is_raw else None
        if frames is not None:
            client.buffer = b""
            self._pass_on(client, frames)
            return
        *messages, client.buffer = text.split(b">")
        parsed = [parse_frame(message) if client.raw_since_s is not None else None for message in messages]
        if not client.buffer:
            client.bursts.learn(parsed, text)
        for message, each in zip(messages, parsed, strict=True):
            if each is None:
                self._obey(client, message.split())
            else:
                self._pass_on(client, [each])
        if len(client.buffer) > LONGEST_MESSAGE:
            self._drop(client)

    def _obey(self, client: _Client, words: list[bytes]) -> None:
        verb = words[1] if len(words) > 1 and words[0] == b"<" else b""
        if verb == b"send" and client.raw_since_s is not None:
            self._take_frame(client, words)
        elif verb == b"open":
            self._send(client, b"< ok >")
        elif verb == b"rawmode":
            self._send(client, b"< ok >")
            client.raw_since_s = time.monotonic()
        elif verb == b"echo":
            self._send(client, b"< echo >")
        else:
            self._send(client, b"< error could not be understood >")

    def _take_frame(self, client: _Client, words: list[bytes]) -> None:
        try:
            cob_id, length = int(words[2], 16), int(words[3], 16)
            data = bytes([int(word, 16) for word in words[4:]])
        except (ValueError, IndexError):
            self._send(client, b"< error malformed frame >")
            return
        if len(data) != length or length > 8 or cob_id > 0x7FF:
            self._send(client, b"< error malformed frame >")
            return
        self._pass_on(client, [(cob_id, data)])

    def _pass_on(self, client: _Client, frames: list[Frame]) -> None:
        client.raw_since_s = 0.0
        if len(self._clients) > 1:
            self._broadcast(frames, client)
        self._on_frames(frames)


def parse_frame(message: bytes) -> Frame | None:
    """Parse ``< send ID LENGTH BYTE BYTE ... `` of 11-bit identifier and bytes of two digits, the usual form.

    Returns
    -------
    Frame or None
        None for every other message, which is then read word by word.
    """
    head = _HEADS.get(message[:HEAD])
    if head is None or message[HEAD::3] != SPACES[: head[1] + 1]:
        return None
    try:
        data = bytes.fromhex(message[HEAD:].decode("ascii"))
    except ValueError:
        return None
    return (head[0], data) if len(data) == head[1] else None
