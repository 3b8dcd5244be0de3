"""Which screened hypotheses are worth a full fit."""

from __future__ import annotations

import numpy as np

from hexdbb.evidence.linear.screen import Known, Scored

ENDS_OF_BAR = ("ball", "cup")


def better_shaped(scored: list[Scored], others: list[Scored]) -> list[Scored]:
    """Exchange hypotheses for the same with another shape where that explains more.

    Parameters
    ----------
    scored, others : list of Scored
        Of the same effects with two values of their shape parameters.
    """
    of = {each.hypothesis: each for each in others}
    return [max(each, of.get(each.hypothesis, each), key=lambda one: one.log_evidence) for each in scored]


def shortlist(scored: list[Scored], count: int, of_one_effect: int) -> list[Scored]:
    """Choose by evidence and by held-out share, two to one; none whose evidence is against it.

    Parameters
    ----------
    scored : list of Scored
    count : int
        How many may be chosen.
    of_one_effect : int
        Most elements of one effect: neighbours look alike to first order.
    """
    ranked: list[Scored] = []
    for each in sorted(scored, key=lambda each: -each.log_evidence):
        few = _count(ranked, each.hypothesis) < of_one_effect if isinstance(each.hypothesis, Known) else True
        if few and each.log_evidence > 0.0 and not any(_is_of_one_pair(each, one) for one in ranked):
            ranked.append(each)
    chosen = ranked[: count - count // 3]
    rest = [each for each in ranked[len(chosen) :] if np.isfinite(each.heldout_share)]
    rest.sort(key=lambda each: -each.heldout_share)
    return [*chosen, *rest[: count - len(chosen)]]


def _is_of_one_pair(one: Scored, other: Scored) -> bool:
    """Check for one state at the ball and at the cup: the two say nearly the same, and the other is tried in the end.

    Two of three places went to a free function of time at both, and the time since the cup was fixed was never fitted.
    """
    if isinstance(one.hypothesis, Known) or isinstance(other.hypothesis, Known):
        return False
    places = {one.hypothesis.place, other.hypothesis.place}
    return places == {*ENDS_OF_BAR} and one.hypothesis.variable.name == other.hypothesis.variable.name


def _count(ranked: list[Scored], known: Known) -> int:
    return sum(isinstance(each.hypothesis, Known) and each.hypothesis.effect == known.effect for each in ranked)
