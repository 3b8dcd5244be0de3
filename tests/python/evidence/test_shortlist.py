"""Which hypotheses get a full fit."""

from __future__ import annotations

import numpy as np

from hexdbb.evidence.linear.marginal import Marginal
from hexdbb.evidence.linear.screen import Scored
from hexdbb.evidence.search.shortlist import shortlist
from hexdbb.learned import Learned

NONE = np.zeros(0)


def _scored(name: str, log_evidence: float) -> Scored:
    marginal = Marginal(log_evidence, (0, 0), 1.0, NONE, NONE, NONE, NONE)
    return Scored(Learned.parse(name), log_evidence, 0.5, 0.5, marginal)


def test_one_state_at_the_ball_and_at_the_cup_has_one_place() -> None:
    """Both by a free function of time took two places of three."""
    scored = [
        _scored("learned:ball:fine_time", 101.0),
        _scored("learned:cup:fine_time", 101.0),
        _scored("learned:cup:time_since_fixing", 90.0),
        _scored("learned:ball:time_since_fixing", 80.0),
        _scored("learned:leg:1:time", 70.0),
    ]
    names = [each.hypothesis.name for each in shortlist(scored, 3, 2)]
    assert names == ["learned:ball:fine_time", "learned:cup:time_since_fixing", "learned:leg:1:time"]


def test_one_state_at_two_legs_has_two() -> None:
    scored = [_scored(f"learned:leg:{each}:time", 10.0 - each) for each in range(1, 7)]
    assert len(shortlist(scored, 3, 2)) == 3
