"""Failing inputs made small: lines, then bytes, are removed as long as the reader fails in the same way."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tests.fuzz.formats import Format
from tests.fuzz.inputs import FAILED, Outcome, outcome_of


def signature(outcome: Outcome) -> str:
    """Return the failure without the values and paths in its text: exception and place, or kind of message."""
    kind, _, rest = outcome.text.partition(":")
    place = re.search(r" in \S+$", rest)
    return f"{outcome.format}: {re.sub('[0-9]+', '', kind)}{place[0] if place else ''}"


def smaller(chosen: Format, failure: Outcome) -> bytes:
    """Return a smaller input that fails in the same way."""
    wanted = signature(failure)

    def fails(data: bytes) -> bool:
        outcome = outcome_of(chosen, data)
        return outcome.kind == FAILED and signature(outcome) == wanted

    lines = without_parts(failure.data.splitlines(keepends=True), lambda parts: fails(b"".join(parts)))
    data = b"".join(lines)
    if len(data) < SMALL:
        data = bytes(without_parts(list(data), lambda parts: fails(bytes(parts))))
    return data


SMALL = 2000
"""Bytes of an input whose bytes are removed one by one: more would take minutes."""


def without_parts(parts: Sequence, still_fails) -> list:
    """Return the parts that are needed for a failure: runs of half, a quarter ... of them are removed in turn."""
    parts = list(parts)
    run = len(parts) // 2
    while run:
        begin = 0
        while begin < len(parts):
            fewer = parts[:begin] + parts[begin + run :]
            if fewer and still_fails(fewer):
                parts = fewer
            else:
                begin += run
        run //= 2
    return parts
