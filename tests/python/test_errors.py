"""A message is one printable line, whatever it quotes."""

from __future__ import annotations

import pickle

import pytest

from hexdbb.errors import LONGEST_MESSAGE, HexdbbError, InputError, RunError


@pytest.mark.parametrize("kind", [HexdbbError, InputError, RunError])
def test_what_would_break_the_line_or_move_the_cursor_is_escaped(kind: type[HexdbbError]) -> None:
    assert str(kind("a.toml: key \x1b[2J: b\r\nc\u2028")) == r"a.toml: key \x1b[2J: b\r\nc\u2028"


def test_ordinary_messages_stay_as_they_are() -> None:
    assert str(InputError("Prüfstand µm.csv: row 3: 5 µm (expected ±1 °)")) == (
        "Prüfstand µm.csv: row 3: 5 µm (expected ±1 °)"
    )


def test_overlong_messages_keep_beginning_and_end() -> None:
    message = str(InputError("a.csv: columns " + "x" * 50_000 + " (expected y)"))
    assert len(message) <= LONGEST_MESSAGE
    assert message.startswith("a.csv: columns x")
    assert message.endswith("x (expected y)")


def test_error_crosses_processes() -> None:
    error = pickle.loads(pickle.dumps(RunError("node 3: a\nb")))
    assert str(error) == r"node 3: a\nb"
