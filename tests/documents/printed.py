"""Whether a command printed what a page shows.

``...`` alone on a line stands for any number of lines, within a line for any number of words. White space may differ.
Numbers may differ by one unit of their last place or by `RELATIVE`: another processor sums in another order, and a fit
ends an iteration earlier. Speeds of the computer are not compared.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

NUMBER = re.compile(r"[-+]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?")
RELATIVE = 0.02
"""Printed standard deviations and evidence repeat to well below 1 % between processors; 2 % leaves room."""
SPEED = re.compile(r"[\d.]+ ms/cycle|\d+ iterations")
"""What depends on how fast the computer is, or where rounding ends a fit."""


def first_difference(expected: Sequence[str], printed: Sequence[str]) -> str | None:
    """Return the first expected line that was not printed where it should be, with what stands there; else None."""
    lines = [line for line in printed if line.strip()]
    at, anywhere = 0, False
    for line in (each for each in expected if each.strip()):
        if line.strip() == "...":
            anywhere = True
            continue
        place = next((k for k in range(at, len(lines)) if _same(line, lines[k])), None) if anywhere else at
        if place is None or place >= len(lines) or not _same(line, lines[place]):
            there = lines[at] if at < len(lines) else "(nothing more)"
            return f"shown:   {line}\nprinted: {there}"
        at, anywhere = place + 1, False
    if not anywhere and at < len(lines):
        return f"shown:   (nothing more)\nprinted: {lines[at]}"
    return None


def _same(shown: str, line: str) -> bool:
    return _same_words(SPEED.sub("", shown).split(), SPEED.sub("", line).split())


def _same_words(shown: Sequence[str], printed: Sequence[str]) -> bool:
    if not shown:
        return not printed
    if shown[0].rstrip(",") == "...":
        return any(_same_words(shown[1:], printed[k:]) for k in range(len(printed) + 1))
    return bool(printed) and _same_word(shown[0], printed[0]) and _same_words(shown[1:], printed[1:])


def _same_word(shown: str, printed: str) -> bool:
    if shown == printed:
        return True
    if NUMBER.sub("#", shown) != NUMBER.sub("#", printed):
        return False
    return all(map(_same_number, NUMBER.findall(shown), NUMBER.findall(printed)))


def _same_number(shown: str, printed: str) -> bool:
    one, other = float(shown.replace(",", "")), float(printed.replace(",", ""))
    places = len(shown.partition(".")[2]) if "e" not in shown else 0
    return abs(one - other) <= max(1.5 * 10.0**-places if "." in shown else 0.0, RELATIVE * abs(one))
