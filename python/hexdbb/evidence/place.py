"""Whether a learned function acts where a cause does, so that it may be a part of that cause's form."""

from __future__ import annotations

from hexdbb.evidence.screen import Hypothesis
from hexdbb.evidence.search import Search
from hexdbb.learned import Learned, part_of


def at_its_place(search: Search, cause: Hypothesis, learned: Learned) -> bool:
    """Check that a learned function acts at an element where a cause does; a known effect acts at those of its kin."""
    return any(learned.is_within(part_of(home), home.element) for home in homes_of(search, cause))


def homes_of(search: Search, cause: Hypothesis) -> list[Learned]:
    """Return the learned functions in which a cause lives: itself, or the kin of a known effect."""
    if isinstance(cause, Learned):
        return [cause]
    by_name = search.learnable.by_name
    return [by_name[name] for name in search.kin.get(cause.name, set())]
