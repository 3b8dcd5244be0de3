"""Whether a learned function acts where a cause does, so that it may be a part of that cause's form."""

from __future__ import annotations

from hexdbb.evidence.screen import Hypothesis
from hexdbb.evidence.search import Search
from hexdbb.learned import Learned, part_of


def at_its_place(search: Search, cause: Hypothesis, learned: Learned) -> bool:
    """Check that a learned function acts at an element where a cause does; a known effect acts at those of its kin."""
    return any(learned.is_within(part_of(home), home.element) for home in homes_of(search, cause))


def at_a_place_of_its_kin(search: Search, cause: Hypothesis, learned: Learned) -> bool:
    """Check the same of all that a cause's form reads like, at another port too."""
    return any(learned.is_within(part_of(home), home.element) for home in _kin_of(search, cause))


def homes_of(search: Search, cause: Hypothesis) -> list[Learned]:
    """Return the learned functions in which a cause lives: itself, or those of a known effect's kin at its own ports.

    At another port a form reads the same and goes wrong otherwise.
    """
    kin = _kin_of(search, cause)
    if isinstance(cause, Learned):
        return kin
    ports = search.engine.absent.ports(cause.effect)
    return [each for each in kin if each.port in ports]


def _kin_of(search: Search, cause: Hypothesis) -> list[Learned]:
    if isinstance(cause, Learned):
        return [cause]
    by_name = search.learnable.by_name
    return [by_name[name] for name in search.kin.get(cause.name, set())]
