"""The socketcand client against servers that misbehave, over TCP on 127.0.0.1."""

from __future__ import annotations

import random
import socket
import threading
import time
from collections.abc import Callable, Iterator

import can
import pytest

from hexdbb.capture.bursts import ReceivedBurst, SentBurst
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


LAYOUT = [(0x181, 7), (0x080, 0), (0x187, 5)]


def test_data_of_expected_frames_are_those_of_the_general_parser() -> None:
    found = general(BURST)
    assert found is not None
    assert ReceivedBurst(LAYOUT).data_of(BURST) == b"".join(data for _, data, _ in found)


@pytest.mark.parametrize("layout", [LAYOUT[:2], [*LAYOUT, (0x186, 1)], [LAYOUT[1], LAYOUT[0], LAYOUT[2]]])
def test_frames_other_than_expected_are_left_to_the_general_parser(layout: list[tuple[int, int]]) -> None:
    assert ReceivedBurst(layout).data_of(BURST) is None


def test_frames_sent_together_are_those_sent_one_by_one(server: Callable[[Script], str]) -> None:
    received: list[bytes] = []

    def script(connection: socket.socket) -> None:
        serve(connection)
        while chunk := connection.recv(1000):
            received.append(chunk)

    layout = [(0x201, 6), (0x080, 0), (0x080, 1)]
    data = bytes(range(0xF8, 0xFF))
    with open_bus(server(script), 1_000_000) as bus:
        guarded = GuardedBus(bus)
        burst = SentBurst(layout)
        guarded.send_burst(burst, data)
        for message in burst.filled(data):
            guarded.send(message)
    end_s = time.monotonic() + WAIT_S
    while b"".join(received).count(b">") < 2 + 6 and time.monotonic() < end_s:
        time.sleep(0.01)
    text = b"".join(received)
    half = text[: len(text) // 2]
    assert text == 2 * half
    assert half == b"< send 201 6 f8 f9 fa fb fc fd >< send 080 0  >< send 080 1 fe >"


def test_frames_that_arrive_together_are_taken_at_once_and_alone(server: Callable[[Script], str]) -> None:
    def script(connection: socket.socket) -> None:
        serve(connection)
        for text in (BURST, BURST + b"< frame 701 1.0 05 >"):
            connection.sendall(text)
            connection.recv(100)

    burst = ReceivedBurst(LAYOUT)
    with open_bus(server(script), 1_000_000) as bus:
        guarded = GuardedBus(bus)
        data = guarded.take_burst(burst, WAIT_S)
        assert data is not None
        assert len(data) == 12
        bus.send(can.Message(arbitration_id=0, is_extended_id=False))
        assert guarded.take_burst(burst, WAIT_S) is None
        frames = [guarded.take(WAIT_S) for _ in range(4)]
        assert [each and each[0] for each in frames] == [0x181, 0x080, 0x187, 0x701]


@pytest.mark.parametrize("seed", range(4))
def test_a_burst_with_an_error_is_left_to_the_general_parser_or_read_alike(seed: int) -> None:
    rng, expected = random.Random(seed), ReceivedBurst(LAYOUT)
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
        data = expected.data_of(bytes(text))
        assert data is None or data == b"".join(each for _, each, _ in general(bytes(text)) or ()), bytes(text)
        alike += found is not None
    assert alike > 100
