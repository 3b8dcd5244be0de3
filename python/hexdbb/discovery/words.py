"""A discovery in words that a fitter understands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hexdbb.evidence.trial import HeldOut
from hexdbb.learned import ALL, Learned

GROUPS = {"circle": "circles", "feed": "feeds", "direction": "directions", "lap": "laps"}
PLACES = {
    "slider": "slider",
    "leg": "leg",
    "lateral": "guideway",
    "vertical": "guideway",
    "platform_joint": "platform joint of leg",
    "ball": "the ball",
    "cup": "the cup",
    "reading": "the gauge's reading",
}
ACROSS = {"lateral": " across", "vertical": " up and down"}
NOTHING = "nothing is missing: what is left is noise"


def place_words(hypothesis: Learned) -> str:
    """Return where a learned hypothesis acts: ``leg 5``, ``all legs``, ``guideway 1 across``."""
    name = PLACES[hypothesis.place]
    if hypothesis.place in ("slider", "leg") and hypothesis.element == ALL:
        return f"all {name}s"
    element = f" {hypothesis.element}" if hypothesis.element else ""
    return f"{name}{element}{ACROSS.get(hypothesis.place, '')}"


def learned_clause(hypothesis: Learned) -> str:
    """Return a learned hypothesis as a clause: ``it acts at leg 5 and follows its turning rate``."""
    variable = hypothesis.variable
    if not variable.column and not variable.times:
        return f"it acts at {place_words(hypothesis)} and is constant"
    return f"it acts at {place_words(hypothesis)} and follows the {variable.name.replace('_', ' ')}"


def unseen_words(heldout: Mapping[str, HeldOut], share: float) -> str:
    """Return on what it holds: ``on circles, feeds and directions not used to find it``; empty where on nothing."""
    held = [GROUPS[name] for name, each in heldout.items() if each.share >= 0.5 * share]
    return f"on {joined(held)} not used to find it" if held else ""


def joined(words: Sequence[str]) -> str:
    """Return words joined by commas and ``and``."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}" if words else ""


def capital(sentence: str) -> str:
    """Return a sentence with a capital letter."""
    return sentence[:1].upper() + sentence[1:]


def percent(share: float) -> str:
    """Return a share in per cent, 100 only where nothing is left."""
    shown = min(max(100.0 * share, 0.0), 100.0)
    return "more than 99 %" if 99.5 <= shown < 100.0 else f"{shown:.0f} %"
