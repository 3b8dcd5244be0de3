"""Every hypothesis at once, to first order: marginal likelihood and prediction of circles left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.linear.marginal import Marginal, marginal, solved
from hexdbb.evidence.linear.signatures import Signature, signature_of, varying
from hexdbb.evidence.linear.sums import Block, Sums, Training, squared_error
from hexdbb.evidence.linear.thinned import Thinned
from hexdbb.learned import Learned, Variable

Floats = NDArray[np.float64]


MOST_AXES = 2
"""Axes along which functions push that may be finer at once: of one carriage; along three, fine functions explain
whatever there is."""

MOST_ANEW_MM = 0.1
"""Largest size of what is another with each sweep: who mounts a cup sees when it shifts by more each time. Arcs hardly
hold the three axes of a cup: steps of two millimetres, which nearly cancelled, said what a bar did that cooled."""


@dataclass(frozen=True)
class Known:
    """A hypothesis of the catalogue or of the user's file: an effect and some of its elements."""

    effect: str
    elements: tuple[str, ...]
    is_whole: bool = False

    @property
    def name(self) -> str:
        """Name, as `hexdbb add` takes it."""
        return self.effect if self.is_whole else ":".join((self.effect, *self.elements))


Hypothesis = Known | Learned


@dataclass(frozen=True, eq=False)
class Scored:
    """A hypothesis screened: log evidence over the base (tempered), explained shares, and its most probable size.

    `heldout_left` is the mean square (noise variances) that it leaves of circles left out.
    """

    hypothesis: Hypothesis
    log_evidence: float
    share: float
    heldout_share: float
    marginal: Marginal
    heldout_left: float = float("nan")


def may_be_finer_at_once(hypothesis: Learned) -> bool:
    """Check for few axes, and for a variable of which readings may ask for more splines than it has."""
    return hypothesis.components <= MOST_AXES and may_be_finer(hypothesis.variable)


def may_be_finer(variable: Variable) -> bool:
    """Check for a variable of which readings may ask for more splines than it has, before it is fitted."""
    return variable.may_be_finer and not _is_dense(variable)


def _is_dense(variable: Variable) -> bool:
    """Check for what is fine where it changes fast, has a fine function of its own, or is known by a period."""
    return variable.signed or variable.is_log or variable.column in ("time_s", "deflection_mm", "gauge_scale_mm")


class Screen:
    """Scores hypotheses on one linearisation.

    Parameters
    ----------
    sums : Sums
    criteria : Criteria
    thinned : Thinned
        Rows of the readings on which learned hypotheses are ranked first.
    penalties : sequence of (roughness, steepness), optional
        Over which the evidence of a spline is averaged; `Criteria.roughness` where not given.
    unexplained : float, optional
        Mean square beyond the noise (noise variances) of which a part counts as noise (`Criteria.temper`); what the
        linearisation leaves where not given.
    """

    def __init__(
        self,
        sums: Sums,
        criteria: Criteria,
        thinned: Thinned,
        penalties: Sequence[tuple[float, float]] = (),
        unexplained: float | None = None,
    ) -> None:
        self._penalties = penalties or [(roughness, 0.0) for roughness in criteria.roughness]
        self.sums, self.criteria, self.thinned = sums, criteria, thinned
        self._evidence: dict[Learned, float] = {}
        own = self.whole.own_values()
        self.left = squared_error(sums, self.whole.cells, own, None, None)
        self.excess = max(self.left - self.whole.rows, 1e-9)
        unexplained = self.excess / self.whole.rows if unexplained is None else unexplained
        self.temper = 1.0 + criteria.temper**2 * unexplained
        smallest, largest, count = criteria.size_um
        self.sizes_mm = np.geomspace(smallest * 1e-3, largest * 1e-3, count)

    @property
    def whole(self) -> Training:
        """All rows."""
        return self.sums.whole

    @cached_property
    def folds(self) -> list[tuple[Training, NDArray[np.intp], float]]:
        """Circle by circle: training set without it, its cells, and the base's squared error there."""
        found = []
        for cells in self.sums.groups("circle"):
            training = self.sums.without(cells)
            found.append((training, cells, squared_error(self.sums, cells, training.own_values(), None, None)))
        return found

    def learned(self, hypotheses: Sequence[Learned], *, finely: bool = False) -> list[Scored]:
        """Score learned hypotheses, the largest evidence first: the best of those ranked on few rows, or finer ones."""
        best = self.ranked(hypotheses)[: self.criteria.held_out]
        return self._held_out([self._of(each) for each in (self._fine_enough(best) if finely else best)])

    def scored(self, hypothesis: Learned) -> Scored:
        """Score one learned hypothesis, held out too."""
        scored, block = self._of(hypothesis)
        return self._with_held_out(scored, block)

    def most_explained(self, hypotheses: Sequence[Learned]) -> float:
        """Return the largest share that one of some learned hypotheses explains, of the few with the most evidence."""
        ranked = self.ranked(hypotheses)[: self.criteria.full_fits]
        return max((self._of(each)[0].share for each in ranked), default=0.0)

    def _of(self, hypothesis: Learned) -> tuple[Scored, Block]:
        space = signature_of(hypothesis, self.sums.readings)
        block = self.sums.block(space.table)
        is_anew = hypothesis.variable.is_anew
        sizes_mm = self.sizes_mm[self.sizes_mm <= MOST_ANEW_MM] if is_anew else self.sizes_mm
        return self._scored(hypothesis, block, self._factors(space), sizes_mm), block

    def ranked(self, hypotheses: Sequence[Learned]) -> list[Learned]:
        """Sort learned hypotheses by their evidence on few rows, the largest first."""
        new = [each for each in hypotheses if each not in self._evidence]
        found = self.thinned.log_evidences(new, self.sums.linear, self.sizes_mm, self.temper)
        self._evidence.update(zip(new, found, strict=True))
        return sorted(hypotheses, key=lambda each: -self._evidence[each])

    def _fine_enough(self, hypotheses: Sequence[Learned]) -> list[Learned]:
        """Return hypotheses with as many splines as have the most evidence on few rows.

        What repeats within a joint's angle is not described by a dozen splines over all of it, and a function of
        another state that resembles it may then have more evidence than the true one. What changes its sign with a rate
        is dense about zero already: more splines would describe how gradually another function does (`turning.py`); so
        is what is a function of a logarithm. What is narrow along the gauge's scale repeats there; a finer function of
        time, or of three axes, explains whatever there is. One carriage that is pushed aside is so along two.
        """
        may_be = filter(may_be_finer_at_once, hypotheses)
        finer = [each.finer(times) for each in may_be for times in self.criteria.finer_at_once]
        few = [each for each in finer if each.size <= self.criteria.most_tuned]
        best = {each.name: each for each in reversed(self.ranked([*hypotheses, *varying(few, self.sums.readings)]))}
        return [best[each.name] for each in hypotheses]

    def _factors(self, space: Signature) -> list[Floats]:
        penalties = self._penalties if space.hypothesis.variable.is_smooth else self._penalties[:1]
        return [space.prior_factor(*each) for each in penalties]

    def known(self, signatures: Floats, whose: Sequence[tuple[str, str, str, float]], kinds: set[str]) -> list[Scored]:
        """Score effects of the catalogue, element by element; `kinds` are effects that have one element only."""
        block = self.sums.block(signatures)
        scored = []
        for effect, element in dict.fromkeys((effect, element) for effect, element, _, _ in whose):
            at = [index for index, each in enumerate(whose) if each[:2] == (effect, element)]
            own = Block(block.own[:, at][:, :, at], block.cross[:, at])
            known = Known(effect, (element,), effect in kinds)
            sizes = np.array(self.criteria.catalogue_scale)
            scored.append((self._scored(known, own, [np.eye(len(at))], sizes), own))
        return self._held_out(scored)

    def at_several(self, known: Known, signatures: Floats) -> Scored:
        """Score an effect at several of its elements together, not held out; signatures of shape (n, k)."""
        sizes = np.array(self.criteria.catalogue_scale)
        return self._scored(known, self.sums.block(signatures), [np.eye(signatures.shape[1])], sizes)

    def _held_out(self, scored: list[tuple[Scored, Block]]) -> list[Scored]:
        """Add the held-out shares of those with the largest evidence."""
        ranked = sorted(scored, key=lambda each: -each[0].log_evidence)
        chosen = [self._with_held_out(each, block) for each, block in ranked[: self.criteria.held_out]]
        return [*chosen, *(each for each, _ in ranked[self.criteria.held_out :])]

    def _scored(self, hypothesis: Hypothesis, block: Block, factors: list[Floats], sizes: Floats) -> Scored:
        projected = self.whole.project(block)
        found = marginal(projected.information, projected.gradient, factors, sizes, temper=self.temper)
        own = self.whole.own_values(projected, found.coefficients)
        left = squared_error(self.sums, self.whole.cells, own, block, found.coefficients)
        return Scored(
            hypothesis,
            found.log_evidence,
            (self.left - left) / self.excess,
            float("nan"),
            found,
        )

    def _with_held_out(self, scored: Scored, block: Block) -> Scored:
        before = after = 0.0
        rows, found = self.whole.rows, scored.marginal
        for training, cells, base in self.folds:
            projected = training.project(block)
            size = found.size / np.sqrt(self.temper)
            coefficients = solved(projected.information, projected.gradient, found.factor, size)
            own = training.own_values(projected, coefficients)
            before += base
            after += squared_error(self.sums, cells, own, block, coefficients)
        share = (before - after) / max(before - rows, 1e-9)
        return replace(scored, heldout_share=share, heldout_left=after / rows)
