"""Refinement of chosen circles off the grid by coordinate exchange (Meyer, Nachtsheim, Technometrics 37(1), 1995).

Every circle in turn is replaced by its best neighbour, with decreasing steps.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hexdbb.planning.candidates import CandidateCircle, neighbours, other_radii
from hexdbb.planning.criteria import Criterion
from hexdbb.planning.exchange import CircleExchange, CircleIndex, is_better
from hexdbb.planning.known_circles import KnownCircles

STEPS_DEG = (6.0, 3.0, 1.0)
"""Steps of the refinement: the finest spacing of the grid's tilts, half of it, and 1 deg,
which moves the end of a bar of 100 mm by less than 2 mm."""
MAX_PASSES = 10
"""Limit of passes over all circles with one step, against endless refinement; it ends earlier, when no neighbour is
better."""


class Refinement:
    """Search for better circles near chosen ones.

    Parameters
    ----------
    known : KnownCircles
    criterion : Criterion
    off_nominal : bool
        Whether radii may differ from the bar's length.
    """

    def __init__(self, known: KnownCircles, criterion: Criterion, *, off_nominal: bool) -> None:
        self.known, self.criterion, self.off_nominal = known, criterion, off_nominal

    def refined(self, chosen: Sequence[CandidateCircle]) -> list[CandidateCircle]:
        """Return a choice with every circle replaced by its best neighbour until none is better."""
        best = list(chosen)
        for step_deg in STEPS_DEG:
            for _ in range(MAX_PASSES):
                moved = [self._moved(best, place, step_deg) for place in range(len(best))]
                if not any(moved):
                    break
        return best

    def best(self, choices: Sequence[list[CandidateCircle]]) -> list[CandidateCircle]:
        """Return the best choice, the first among equals."""
        best, score = choices[0], -np.inf
        for each in choices:
            exchange, others = self._exchange_about(each[:1], each[1:])
            reached = exchange.score([*others, (0, 0)])
            if is_better(reached, score):
                best, score = each, reached
        return best

    def _moved(self, best: list[CandidateCircle], place: int, step_deg: float) -> bool:
        """Replace one circle by its best neighbour; return whether there was a better one."""
        own = best[place]
        near = [*neighbours(own, step_deg), *(other_radii(own, self.known.template) if self.off_nominal else ())]
        options = [own, *self.known.within_reach(each for each in near if each not in best)]
        exchange, others = self._exchange_about(options, [*best[:place], *best[place + 1 :]])
        scores = [exchange.score([*others, (0, option)]) for option in range(len(options))]
        if not is_better(max(scores), scores[0]):
            return False
        best[place] = options[int(np.argmax(scores))]
        return True

    def _exchange_about(
        self, options: Sequence[CandidateCircle], others: Sequence[CandidateCircle]
    ) -> tuple[CircleExchange, list[CircleIndex]]:
        """Return the exchange over the options for one circle, and the indices of the other circles in it."""
        cups = list(dict.fromkeys([options[0].cup_mm, *(each.cup_mm for each in others)]))
        groups = [[each for each in others if each.cup_mm == cup] for cup in cups]
        groups[0] = [*options, *groups[0]]
        information = [self.known.information(group) for group in groups if group]
        fixed = [
            (mount, place)
            for mount, group in enumerate(groups)
            for place in range(len(options) if mount == 0 else 0, len(group))
        ]
        return CircleExchange(information, self.criterion), fixed
