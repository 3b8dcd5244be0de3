"""The socketcand client against servers that misbehave, over TCP on 127.0.0.1."""

from __future__ import annotations

import random
import socket
import threading
from collections.abc import Callable, Iterator

import can
import pytest

from hexdbb.capture.frames import GuardedBus
from hexdbb.capture.socketcand import parse_frame, parse_frames
from hexdbb.capture.transport import open_bus
from hexdbb.errors import InputError

Script = Callable[[socket.socket], None]
WAIT_S = 5.0


def serve(connection: socket.socket, *, joined: bool = False) -> None:
    """Answer the handshake; `joined` sends its answers in as few segments as there can be."""
    connection.sendall(b"< hi >< ok >< ok >" if joined else b"< hi >")
    asked = b""
    for request in (b"open can0 >", b"rawmode >"):
        while request not in asked:
            asked += connection.recv(100)
        if not joined:
            connection.sendall(b"< ok >")


@pytest.fixture
def server() -> Iterator[Callable[[Script], str]]:
    """Start a server that runs a script on its first connection; return its bus."""
    threads: list[threading.Thread] = []

    def started(script: Script) -> str:
        listener = socket.create_server(("127.0.0.1", 0))

        def run() -> None:
            with listener, listener.accept()[0] as connection:
                script(connection)

        threads.append(threading.Thread(target=run))
        threads[-1].start()
        return f"socketcand:127.0.0.1:{listener.getsockname()[1]}"

    yield started
    for thread in threads:
        thread.join()


@pytest.mark.parametrize(
    "garbage",
    [
        b"< frame 18X 1.0 00 >",
        b"< frame 181 now 00 >",
        b"< frame 181 1.0 0 >",
        b"< frame 181 1.0 000102030405060708 >",
        b"< frame >",
        b"\xff\xfe>",
        b"< whatever >",
        b">>>",
        b"x" * 500 + b">",
    ],
)
def test_a_message_that_cannot_be_parsed_costs_itself_only(garbage: bytes, server: Callable[[Script], str]) -> None:
    def script(connection: socket.socket) -> None:
        serve(connection)
        connection.sendall(b"< frame 181 1.0 01 >" + garbage + b"< frame 182 1.5 0203 >")
        assert connection.recv(100)  # until the test has read them

    with open_bus(server(script), 1_000_000) as bus:
        guarded = GuardedBus(bus)
        received = [guarded.recv(WAIT_S), guarded.recv(WAIT_S)]
        bus.send(can.Message(arbitration_id=1, is_extended_id=False))
        assert [(each.arbitration_id, bytes(each.data)) for each in received] == [(0x181, b"\1"), (0x182, b"\2\3")]
        assert any("cannot be parsed" in note for note in guarded.notes())


def test_frames_split_over_segments_and_answers_joined_in_one(server: Callable[[Script], str]) -> None:
    def script(connection: socket.socket) -> None:
        serve(connection, joined=True)
        for piece in (b"< fra", b"me 181 1.0 ", b"01", b" >"):
            connection.sendall(piece)
        assert connection.recv(100)

    with open_bus(server(script), 1_000_000) as bus:
        message = bus.recv(WAIT_S)
        bus.send(can.Message(arbitration_id=1, is_extended_id=False))
    assert (message.arbitration_id, bytes(message.data)) == (0x181, b"\1")


def test_closed_connection_is_no_silence(server: Callable[[Script], str]) -> None:
    with open_bus(server(serve), 1_000_000) as bus, pytest.raises(can.CanError, match="closed the connection"):
        bus.recv(WAIT_S)


def test_sent_frame_is_what_the_protocol_prescribes(server: Callable[[Script], str]) -> None:
    seen: list[bytes] = []

    def script(connection: socket.socket) -> None:
        serve(connection)
        seen.append(connection.recv(100))

    with open_bus(server(script), 1_000_000) as bus:
        bus.send(can.Message(arbitration_id=0x203, data=b"\x0f\x00\xab", is_extended_id=False))
        with pytest.raises(can.CanError):
            bus.recv(WAIT_S)
    assert seen == [b"< send 203 3 0f 00 ab >"]


@pytest.mark.parametrize("greeting", [b"HTTP/1.1 400 Bad Request\r\n>", b"< hello >", b"\xff" * 300, b""])
def test_server_of_something_else_is_one_line(greeting: bytes, server: Callable[[Script], str]) -> None:
    with pytest.raises(InputError, match=r"^--bus socketcand:\S+: cannot be opened: the .*server") as caught:
        open_bus(server(lambda connection: connection.sendall(greeting)), 1_000_000)
    assert "\n" not in str(caught.value)


def test_error_frame_is_told_from_data() -> None:
    message = parse_frame(b"< error 040 1.0 ", "can0")
    assert message is not None
    assert message.is_error_frame


def general(text: bytes) -> list[tuple[int, bytes, float]] | None:
    """Return what the parser of single messages makes of a text; None unless all are data frames of 11 bits."""
    found = [parse_frame(message, "can0") for message in text.split(b">")[:-1]]
    if not text.endswith(b">") or any(each is None or each.is_extended_id or each.is_error_frame for each in found):
        return None
    return [(each.arbitration_id, bytes(each.data), each.timestamp) for each in found if each is not None]


BURST = b"< frame 181 12.5 37960102030408 >< frame 080 12.5  >< frame 187 12.500001 0000803F00 >"


def test_frames_parsed_together_are_those_parsed_one_by_one() -> None:
    found = parse_frames(BURST)
    assert found == general(BURST)
    assert [(can_id, len(data)) for can_id, data, _ in found or ()] == [(0x181, 7), (0x080, 0), (0x187, 5)]


@pytest.mark.parametrize("seed", range(4))
def test_a_burst_with_an_error_is_left_to_the_general_parser_or_read_alike(seed: int) -> None:
    rng = random.Random(seed)
    alike = 0
    for _ in range(3000):
        text = bytearray(BURST)
        for _ in range(rng.randint(1, 3)):
            where = rng.randrange(len(text))
            text[where : where + rng.randint(0, 2)] = rng.choice(
                [b"", b" ", b"\t", b"\n", b"0", b"g", b"_", b"-", b"<", b">", b"nan", b"inf", b"1e999", b"FF", b"\xff"]
            )
        found = parse_frames(bytes(text))
        assert found is None or found == general(bytes(text)), bytes(text)
        alike += found is not None
    assert alike > 100
