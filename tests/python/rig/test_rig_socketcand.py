"""Messages of a client to the rig's bus: the usual form is parsed by table, every other one word by word."""

from __future__ import annotations

import pytest

from hexdbb.rig.bursts import MOST_FRAMES, ReceivedBursts
from hexdbb.rig.frame import Frame
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


def text_of(frames: list[Frame]) -> bytes:
    return b"".join(b"< send %03X %d %s >" % (can_id, len(data), data.hex(" ").encode()) for can_id, data in frames)


def test_frames_that_come_together_twice_are_known_from_then_on_with_other_data_too() -> None:
    known, frames, later = ReceivedBursts(), [(0x201, b"\x01\x02"), (0x080, b"")], [(0x201, b"\xfe\xff"), (0x080, b"")]
    known.learn(frames, text_of(frames))
    assert known.frames_of(text_of(later)) is None
    known.learn(frames, text_of(frames))
    assert known.frames_of(text_of(later)) == later
    assert known.frames_of(text_of([(0x202, b"\xfe\xff"), (0x080, b"")])) is None


def test_frames_that_were_read_together_because_the_rig_was_held_up_are_not_learned() -> None:
    known, frames = ReceivedBursts(), [(0x201, b"\x01\x02")] * (MOST_FRAMES + 1)
    for _ in range(3):
        known.learn(frames, text_of(frames))
    assert known.frames_of(text_of(frames)) is None
