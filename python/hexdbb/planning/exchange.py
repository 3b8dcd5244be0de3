"""Choosing circles from a grid: greedy start, then exchange (Fedorov, Theory of Optimal Experiments, 1972).

Starting from nothing, the circle that adds most is taken until there are enough; then each in turn is exchanged for
the best one in its place, until none can be bettered. Cups are few, as each costs an operator's time: they are added
one at a time, the best first, and a further one only where it betters the plan.
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
Choice = tuple[int, int]
"""A mount and the place of a circle among its candidates."""
Progress = Callable[[str], None]

BETTER = 1e-6
"""Part by which a score must rise to count as better: symmetric choices differ by rounding."""
MOST_PASSES = 20


@dataclass(frozen=True)
class Chosen:
    """Circles chosen, and their score."""

    circles: tuple[Choice, ...]
    score: float


@dataclass(frozen=True)
class Search:
    """The candidates, by mount, and what makes a choice good."""

    information: Sequence[Information]
    criterion: Criterion

    def score(self, circles: Sequence[Choice]) -> float:
        """Score one choice."""
        return float(self.criterion(self._told(circles)[None])[0])

    def rounds(self, count: int, most_mounts: int, start: Criterion, progress: Progress) -> list[list[Chosen]]:
        """Choose circles, in as many ways as cup places were tried.

        Parameters
        ----------
        count : int
            Circles to choose.
        most_mounts : int
            Cup places at most.
        start : callable
            Criterion of the greedy start, where too few circles to tell everything are compared.
        progress : callable
            Told what is being done.

        Returns
        -------
        list of list of Chosen
            With at most one cup place, at most two and so on; in each the best first, none twice.

        Raises
        ------
        InputError
            Where no cup place has so many circles.
        """
        rounds: list[list[Chosen]] = []
        pool: tuple[int, ...] = ()
        best = -np.inf
        for _ in range(most_mounts):
            tried = [(*pool, mount) for mount in range(len(self.information)) if mount not in pool]
            found: list[tuple[Chosen, tuple[int, ...]]] = []
            for number, mounts in enumerate(tried):
                progress(f"{len(mounts)} of at most {most_mounts} cup places: trying {number + 1} of {len(tried)}")
                chosen = self._exchanged(self._greedy(mounts, count, start), mounts)
                if chosen is not None:
                    found.append((chosen, mounts))
            if tried and not found:  # too few circles about these cups: the one with most, and another to come
                pool = max(tried, key=lambda mounts: len(self.information[mounts[-1]]))
                continue
            found.sort(key=lambda each: -each[0].score)
            if not found or not is_better(found[0][0].score, best):
                break
            rounds.append(list({frozenset(chosen.circles): chosen for chosen, _ in reversed(found)}.values())[::-1])
            best, pool = found[0][0].score, found[0][1]
        if not rounds:
            raise InputError(f"circles {count}: not so many candidates about {most_mounts} cup places (expected fewer)")
        return rounds

    def _greedy(self, mounts: Sequence[int], count: int, start: Criterion) -> tuple[Choice, ...] | None:
        chosen: tuple[Choice, ...] = ()
        for _ in range(count):
            options = list(self._options(chosen, mounts, start))
            if not options:
                return None
            chosen = (*chosen, _first_best(options)[0])
        return chosen

    def _exchanged(self, chosen: tuple[Choice, ...] | None, mounts: Sequence[int]) -> Chosen | None:
        if chosen is None:
            return None
        score = self.score(chosen)
        for _ in range(MOST_PASSES):
            before = score
            for place in range(len(chosen)):
                rest = (*chosen[:place], *chosen[place + 1 :])
                option, reached = _first_best(list(self._options(rest, mounts, self.criterion)))
                if is_better(reached, score):
                    chosen, score = (*rest[:place], option, *rest[place:]), reached
            if not is_better(score, before):
                break
        return Chosen(chosen, score)

    def _options(
        self, rest: Sequence[Choice], mounts: Sequence[int], criterion: Criterion
    ) -> Iterator[tuple[int, Floats]]:
        """Yield each mount with the scores of adding each of its circles; one chosen already scores nothing."""
        for mount in mounts:
            candidates = self.information[mount]
            here = [place for own, place in rest if own == mount]
            if len(here) == len(candidates):
                continue
            others = self._told([choice for choice in rest if choice[0] != mount])
            scores = criterion(others + candidates.plus(candidates.total(here)).told())
            scores[here] = -np.inf
            yield mount, scores

    def _told(self, circles: Sequence[Choice]) -> Floats:
        size = self.information[0].shared.shape[1]
        told = np.zeros((size, size))
        for mount in sorted({mount for mount, _ in circles}):
            places = [place for own, place in circles if own == mount]
            told += self.information[mount].total(places).told()[0]
        return told


def is_better(score: float, than: float) -> bool:
    """Say whether a score is better by more than rounding."""
    return score > than + BETTER * abs(than) if np.isfinite(than) else score > than


def _first_best(options: Sequence[tuple[int, Floats]]) -> tuple[Choice, float]:
    """Give the first choice that is as good as the best but for rounding, so that every computer takes the same one."""
    best = max(float(scores.max()) for _, scores in options)
    enough = best - BETTER * abs(best)
    mount, scores = next((mount, scores) for mount, scores in options if scores.max() >= enough)
    place = int(np.flatnonzero(scores >= enough)[0])
    return (mount, place), float(scores[place])
