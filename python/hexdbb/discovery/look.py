"""One look for what is missing: a search and its verdict, and whether it says more than another look."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import get_args

from hexdbb.discovery.begun import Begun
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.sure import Grade
from hexdbb.evidence.verdict.quieter import judged
from hexdbb.evidence.verdict.verdict import Verdict

GRADES = get_args(Grade)
"""Verdicts, the surest first, as their type lists them."""


@dataclass(frozen=True)
class Look:
    """A search, its verdict, and what it began with."""

    begun: Begun
    search: Search
    verdict: Verdict

    @classmethod
    def of(cls, begun: Begun, names: Sequence[str], matters_um: float | None, *, learns: bool) -> Look:
        """Search what a model lacks, by the noise of what is left where that is much less.

        Parameters
        ----------
        begun : Begun
        names : sequence of str
            Known effects that could be missing.
        matters_um : float or None
            As for `discover`.
        learns : bool
            Whether learned functions are looked at.
        """
        first = Search(begun.engine, list(names), begun.engine.criteria, learns=learns)
        search, verdict = judged(first, begun.enough(matters_um).matters_um)
        return cls(begun if search is first else begun.by_noise_of(search.engine), search, verdict)

    @property
    def is_sure(self) -> bool:
        """Whether nothing is missing, or every cause is for sure."""
        return all(each.grade == "effect" for each in self.verdict.found) and self.verdict.grade in ("none", "effect")

    @property
    def _doubt(self) -> tuple[int, float]:
        """How much in doubt it leaves: more than with any number of causes where nothing tried explains it."""
        is_told = self.verdict.grade == "none" or self.verdict.found
        return GRADES.index(self.verdict.grade), len(self.verdict.found) if is_told else float("inf")

    def is_better(self, other: Look) -> bool:
        """Check that this says it as surely as another look, with no more causes, and has more evidence.

        By the noise of the other. One value more fits whatever leaves a little: a hose that pulls at the platform was
        two functions beside a bar that was as long as stated.
        """
        if self._doubt > other._doubt:
            return False
        trial, engine = self.verdict.node.trial, self.search.engine
        by_own = 0.5 * len(engine.readings) * trial.left
        by_other = by_own * (engine.noise.sigma_mm / other.search.engine.noise.sigma_mm) ** 2
        gain = self.verdict.node.score + by_own - by_other - other.verdict.node.score
        return gain > self.search.criteria.margin_nats
