"""The sets of hypotheses tried, as a discovery shows them: evidence, part explained, errors where not fitted."""

from __future__ import annotations

import numpy as np

from hexdbb.discovery.result import GROUPINGS, Candidate, GroupError, Grouping
from hexdbb.evidence.fit.heldout import HeldOut
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Hypothesis
from hexdbb.evidence.search.search import Search
from hexdbb.learned import Learned
from hexdbb.learned.variable import NUMBERED
from hexdbb.model import Choice

MAX_CANDIDATES = 6
"""Candidates shown: those of the verdict and the best others, what fits on a screen."""
MAX_CHECKED = 4
"""Candidates whose prediction of what was left out is computed for the table: each costs a pass over all groups."""


def choice_of(hypothesis: Hypothesis) -> str:
    """Return a hypothesis as `hexdbb add` takes it."""
    if isinstance(hypothesis, Learned) or hypothesis.is_whole:
        return hypothesis.name
    return str(Choice(hypothesis.effect, hypothesis.elements))


def shown_candidates(search: Search, node: Node, checked: int = MAX_CHECKED) -> tuple[Candidate, ...]:
    """Return the sets tried that are worth showing: that of the verdict, then single hypotheses by their evidence.

    The errors of the first few (`checked`) where circles, feeds, directions or laps were left out are computed.
    """
    single = [each for each in search.nodes if len(each.members) == 1 and each is not node]
    single.sort(key=lambda each: -each.score)
    shown: dict[tuple[str, ...], Node] = {} if node is search.root else {_unnumbered(node): node}
    for each in single:
        shown.setdefault(_unnumbered(each), each)
    nodes = list(shown.values())[:MAX_CANDIDATES]
    return tuple(_candidate(search, each, rank < checked) for rank, each in enumerate(nodes))


def _unnumbered(node: Node) -> tuple[str, ...]:
    """Return names without the numbers that readings chose: a function with each number it was tuned by is one."""
    return tuple(name.partition(NUMBERED)[0] for name in node.trial.names)


def _candidate(search: Search, node: Node, is_checked: bool) -> Candidate:
    noise_um = float(np.mean(search.engine.row_noise_mm)) * 1e3
    one_um = search.engine.noise.sigma_mm * 1e3
    left, before = node.trial.left, search.root.trial.left
    checked = search.checked(node) if is_checked else None
    held = {} if checked is None else checked.heldout
    heldout: dict[Grouping, GroupError] = {
        name: _group(held[name], noise_um, one_um) for name in GROUPINGS if name in held
    }
    return Candidate(
        names=tuple(choice_of(each) for each in node.hypotheses),
        log_evidence=node.score - search.root.score,
        rms_after_um=float(np.sqrt(max(one_um**2 + (left - 1.0) * noise_um**2, 0.0))),
        share=(before - left) / max(before - 1.0, 1e-9),
        heldout=heldout,
        refused=(*node.trial.refused, *(checked.reasons if checked is not None else ())),
    )


def _group(held: HeldOut, rows_um: float, one_um: float) -> GroupError:
    """Return errors of single readings; rows are means of some, whose noise is smaller."""
    before, after = (
        float(np.sqrt(max(one_um**2 + (each**2 - 1.0) * rows_um**2, 0.0))) for each in (held.before, held.after)
    )
    return GroupError(before, after, held.share)
