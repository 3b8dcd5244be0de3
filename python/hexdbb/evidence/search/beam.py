"""Which sets a search follows: those that predict, of different kinds, each of whose members is needed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Hypothesis
from hexdbb.evidence.search.last_resort import state_of
from hexdbb.evidence.search.needed import needs
from hexdbb.evidence.search.settling import predicts
from hexdbb.learned import Learned

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search


def needed(search: Search, children: Iterable[Node]) -> list[Node]:
    """Return those whose last member is needed and refused by nothing, the best first."""
    found = (each for each in children if not each.trial.refused and needs(search, each, each.members[-1]))
    return sorted(found, key=lambda each: -each.score)


def followed(search: Search, children: Sequence[Node]) -> list[Node]:
    """Choose the best sets that predict, of different kinds, and the best of known effects only, the best first.

    Beside the known one another fault shows as it is, beside what imitates both it does not: it is second at least
    where its own formula explains most of what it does.
    """
    kept: list[Node] = []
    children = sorted(children, key=lambda each: -each.score)
    for child in children:
        alike = any(_alike(search, child, other) for other in kept)
        if len(kept) < search.criteria.beam and not alike and predicts(search, child):
            kept.append(child)
    # Of two faults neither predicts alone, and one of another form may not either: the best is looked at further.
    best = next((each for each in children if each.is_known), None)
    if best is not None and not any(best is each for each in kept):
        kept.insert(1 if _is_by_formula(search, best) else len(kept), best)
    return kept


def _is_by_formula(search: Search, node: Node) -> bool:
    """Check that formulas explain most of what a set of known effects does."""
    left = search.root.trial.left
    by_formulas = left - search.left_by_formulas(node.trial)
    return by_formulas >= search.criteria.own_formula * (left - node.trial.left)


def _alike(search: Search, one: Node, other: Node) -> bool:
    """Check whether every hypothesis of one set has one of its kind in another, or the same state at another place."""
    return all(
        any(search.same_kind(first, second) or _is_same_state(first, second) for second in other.hypotheses)
        for first in one.hypotheses
    )


def _is_same_state(one: Hypothesis, other: Hypothesis) -> bool:
    return isinstance(one, Learned) and isinstance(other, Learned) and state_of(one) == state_of(other)
