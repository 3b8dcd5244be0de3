"""Messages of a client to the rig's bus: the usual form is parsed by table, every other one word by word."""

from __future__ import annotations

import pytest

from hexdbb.rig.socketcand import parse_frame


@pytest.mark.parametrize(
    ("message", "frame"),
    [
        (b"< send 201 6 0f 00 12 34 56 78 ", (0x201, b"\x0f\x00\x124Vx")),
        (b"< send 7FF 8 00 11 22 33 44 55 66 FF ", (0x7FF, b"\x00\x11\x22\x33\x44\x55\x66\xff")),
        (b"< send 080 0  ", (0x080, b"")),
    ],
)
def test_the_usual_form_is_parsed_at_once(message: bytes, frame: tuple[int, bytes]) -> None:
    assert parse_frame(message) == frame


@pytest.mark.parametrize(
    "message",
    [
        b"",
        b"< send ",
        b"< send 201",
        b"< send 201 2 f 0 ",
        b"< send 201 2 0f00  ",
        b"< send 201 2 \t0f00 ",
        b"< send 201 2 0f\t00 ",
        b"< send 201 2 01 02 03 ",
        b"< send 201 2 01 02 0",
        b"< send 201 1    ",
        b"< send 201 1 \t\t ",
        b"< send 201 1 zz ",
        b"< send 201 9 01 02 03 04 05 06 07 08 09 ",
        b"< send 00000201 1 01 ",
        b"\n< send 201 1 01 ",
        b"< echo ",
        b"< send 201 1 \xff\xff ",
    ],
)
def test_every_other_message_is_left_to_be_read_word_by_word(message: bytes) -> None:
    assert parse_frame(message) is None
