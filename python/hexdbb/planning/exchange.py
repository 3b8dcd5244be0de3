"""Choosing circles from a grid: greedy start, then exchange (Fedorov, Theory of Optimal Experiments, 1972).

Greedy start: the circle that improves the score most is added until there are enough. Exchange: each circle in turn is
replaced by the best one for its place, until no replacement improves the score. Cup positions are few, because each
costs the operator's time: they are added one at a time, the best first, and only where they improve the plan.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.planning.criteria import Criterion
from hexdbb.planning.information import Information

Floats = NDArray[np.float64]
CircleIndex = tuple[int, int]
"""A mount, and the index of a circle among the candidates about it."""
ReportStep = Callable[[str], None]
"""Called with a description of each step of the work."""

BETTER = 1e-6
"""Relative improvement above which a score counts as better: equivalent choices, of which the machine's symmetry makes
many, differ by rounding only."""
MAX_PASSES = 20
"""Limit of passes over all circles, against endless exchange; it ends earlier, when no replacement improves."""


@dataclass(frozen=True)
class Selection:
    """A choice of circles and its score."""

    circles: tuple[CircleIndex, ...]
    score: float


@dataclass(frozen=True)
class CircleExchange:
    """The exchange algorithm on candidates.

    Attributes
    ----------
    information : sequence of Information
        Of the candidates, one per mount.
    criterion : callable
        The score to maximise.
    """

    information: Sequence[Information]
    criterion: Criterion

    def score(self, circles: Sequence[CircleIndex]) -> float:
        """Return the score of one choice of circles."""
        return float(self.criterion(self._information_of(circles)[None])[0])

    def rounds(self, count: int, most_mounts: int, start: Criterion, report_step: ReportStep) -> list[list[Selection]]:
        """Choose circles for every cup position, with one more position per round.

        Parameters
        ----------
        count : int
            Number of circles to choose.
        most_mounts : int
            Largest number of cup positions.
        start : callable
            Criterion of the greedy start, where there are too few circles to determine all values.
        report_step : callable
            Called with a description of each step.

        Returns
        -------
        list of list of Selection
            With one cup position, with two and so on; in each round the best first, without duplicates.

        Raises
        ------
        InputError
            No cup position has so many circles.
        """
        rounds: list[list[Selection]] = []
        pool: tuple[int, ...] = ()
        best = -np.inf
        for _ in range(most_mounts):
            tried = [(*pool, mount) for mount in range(len(self.information)) if mount not in pool]
            found: list[tuple[Selection, tuple[int, ...]]] = []
            for number, mounts in enumerate(tried):
                report_step(f"{len(mounts)} of at most {most_mounts} cup positions: {number + 1} of {len(tried)}")
                selection = self._exchanged(self._greedy(mounts, count, start), mounts)
                if selection is not None:
                    found.append((selection, mounts))
            if tried and not found:  # too few circles about these cups: keep the one with most and add another
                pool = max(tried, key=lambda mounts: len(self.information[mounts[-1]]))
                continue
            found.sort(key=lambda each: -each[0].score)
            if not found or not is_better(found[0][0].score, best):
                break
            rounds.append(list({frozenset(each.circles): each for each, _ in reversed(found)}.values())[::-1])
            best, pool = found[0][0].score, found[0][1]
        if not rounds:
            raise InputError(
                f"circles {count}: fewer candidates about {most_mounts} cup position(s) (expected a smaller number)"
            )
        return rounds

    def _greedy(self, mounts: Sequence[int], count: int, start: Criterion) -> tuple[CircleIndex, ...] | None:
        chosen: tuple[CircleIndex, ...] = ()
        for _ in range(count):
            options = list(self._options(chosen, mounts, start))
            if not options:
                return None
            chosen = (*chosen, _first_best(options)[0])
        return chosen

    def _exchanged(self, chosen: tuple[CircleIndex, ...] | None, mounts: Sequence[int]) -> Selection | None:
        if chosen is None:
            return None
        score = self.score(chosen)
        for _ in range(MAX_PASSES):
            before = score
            for place in range(len(chosen)):
                rest = (*chosen[:place], *chosen[place + 1 :])
                option, reached = _first_best(list(self._options(rest, mounts, self.criterion)))
                if is_better(reached, score):
                    chosen, score = (*rest[:place], option, *rest[place:]), reached
            if not is_better(score, before):
                break
        return Selection(chosen, score)

    def _options(
        self, rest: Sequence[CircleIndex], mounts: Sequence[int], criterion: Criterion
    ) -> Iterator[tuple[int, Floats]]:
        """Yield each mount with the scores of adding each of its circles; -inf for one that is chosen already."""
        for mount in mounts:
            candidates = self.information[mount]
            here = [place for own, place in rest if own == mount]
            if len(here) == len(candidates):
                continue
            others = self._information_of([each for each in rest if each[0] != mount])
            scores = criterion(others + candidates.plus(candidates.total(here)).marginal())
            scores[here] = -np.inf
            yield mount, scores

    def _information_of(self, circles: Sequence[CircleIndex]) -> Floats:
        size = self.information[0].shared.shape[1]
        information = np.zeros((size, size))
        for mount in sorted({mount for mount, _ in circles}):
            places = [place for own, place in circles if own == mount]
            information += self.information[mount].total(places).marginal()[0]
        return information


def is_better(score: float, than: float) -> bool:
    """Return whether a score is better by more than rounding."""
    return score > than + BETTER * abs(than) if np.isfinite(than) else score > than


def _first_best(options: Sequence[tuple[int, Floats]]) -> tuple[CircleIndex, float]:
    """Return the first choice as good as the best but for rounding, so that every computer takes the same one."""
    best = max(float(scores.max()) for _, scores in options)
    enough = best - BETTER * abs(best)
    mount, scores = next((mount, scores) for mount, scores in options if scores.max() >= enough)
    place = int(np.flatnonzero(scores >= enough)[0])
    return (mount, place), float(scores[place])
