"""Known effects at all their elements, screened beside a set: what they explain more so than at the best one alone."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.absent import Signatures
from hexdbb.evidence.linear.physical import is_one_sided
from hexdbb.evidence.linear.screen import Hypothesis, Known, Scored, Screen
from hexdbb.evidence.search.screened import known_beside

if TYPE_CHECKING:
    from hexdbb.evidence.search.search import Search

Floats = NDArray[np.float64]

FEWEST = 4
"""Elements at which an effect is seen that is one cause at all of them; a search finds fewer one by one."""


def at_all_elements(search: Search, node: Node, screen: Screen, single: Sequence[Scored] = ()) -> list[Scored]:
    """Return effects at all elements that explain more so than their forms may at the best one alone.

    Effects of one value at each, of one sign by their nature. Others only where they err alike, one value for all
    explaining most of what a value for each does, or where what each element explains alone adds up to what all do:
    six leads, some long and some short, stand in for each other and are as free as a function; pitch errors of six
    screws do not. Effects of the set-up are excluded: a ball may sit anywhere in each set-up.

    Parameters
    ----------
    search : Search
    node : Node
        Beside which they are screened, at the elements that it does not have.
    screen : Screen
        Of its linearisation.
    single : sequence of Scored, optional
        The same at single elements, where they were screened.
    """
    single = single or known_beside(search, node.trial, screen)
    found: dict[str, Scored] = {}
    for table, whose in _tables(search, node):
        columns: dict[str, list[int]] = defaultdict(list)
        for place, (effect, *_) in enumerate(whose):
            columns[effect].append(place)
        for effect, at in columns.items():
            scored = _at_all(search, screen, single, table, whose, at)
            if scored is not None and (effect not in found or scored.log_evidence > found[effect].log_evidence):
                found[effect] = scored
    return [*found.values()]


def _tables(search: Search, node: Node) -> Iterator[Signatures]:
    """Yield the signatures of the known effects beside a set, and of those with shapes for every start of these."""
    absent, model = search.engine.absent, node.trial.model
    yield absent.signatures(model, search.known)
    if shaped := [name for name in search.known if absent.has_shape(name)]:
        yield from (absent.signatures(model, shaped, each) for each in filter(None, search.criteria.shape_starts))


def _at_all(
    search: Search,
    screen: Screen,
    single: Sequence[Scored],
    table: Floats,
    whose: Sequence[tuple[str, str, str, float]],
    at: Sequence[int],
) -> Scored | None:
    """Score an effect at all elements of a table; None where it explains no more so, or does not err alike."""
    effect, criteria = whose[at[0]][0], search.criteria
    elements = tuple(dict.fromkeys(whose[place][1] for place in at))
    info = search.engine.base.info(effect)
    if len(elements) < FEWEST:
        return None
    known = Known(effect, elements)
    scored = screen.at_several(known, table[:, at])
    best = max((each.share for each in single if effect_of(each.hypothesis) == effect), default=0.0)
    if scored.share - best <= criteria.form_variance:
        return None
    has_one_sign = all(is_one_sided(info, whose[place][2]) for place in at) and len(at) == len(elements)
    shares = [each.share for each in single if effect_of(each.hypothesis) == effect]
    if not info.is_set_up and _are_apart(shares, scored.share, criteria):
        return scored
    alike = scored if has_one_sign else screen.at_several(known, _alike(table, whose, at))
    return alike if alike.share >= criteria.explained_min * scored.share else None


def _are_apart(shares: Sequence[float], together: float, criteria: Criteria) -> bool:
    """Check that elements explain alone, added up, what they do together, and that enough are more than a form."""
    seen = sum(each > criteria.form_variance * together for each in shares)
    added = sum(each for each in shares if each > 0.0)
    return seen >= FEWEST and criteria.explained_min * together <= added <= together / criteria.explained_min


def _alike(table: Floats, whose: Sequence[tuple[str, str, str, float]], at: Sequence[int]) -> Floats:
    """Return what an effect does where all its elements err alike, a column for each of its values."""
    names = dict.fromkeys(whose[place][2] for place in at)
    return np.stack(
        [table[:, [place for place in at if whose[place][2] == name]].sum(axis=1) for name in names], axis=1
    )


def effect_of(hypothesis: Hypothesis) -> str:
    """Return the name of a known effect; empty of a learned function."""
    return hypothesis.effect if isinstance(hypothesis, Known) else ""
