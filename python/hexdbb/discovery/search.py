"""The candidates for what is missing beside one fitted model: screened all at once, the best tried in earnest."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hexdbb import _core
from hexdbb.discovery.lack_of_fit import FitTest, LackOfFit
from hexdbb.discovery.result import Candidate
from hexdbb.discovery.screen import Screened, screen
from hexdbb.discovery.trial import Base, contributing, fitted_base, holm, try_effect, weighed
from hexdbb.model import Model

SHAPES = (-2.0, 2.0)
"""Shaping values are screened at these expected sizes besides zero."""

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Trial:
    """An effect fitted beside the base, and whether anything is missing still."""

    candidate: Candidate
    result: _core.FitResult
    lack: LackOfFit


@dataclass(frozen=True)
class Search:
    """What can be missing from `base`: the effects of these names.

    `test` judges residuals of the base's records; `progress` is told what is being done.
    """

    base: Base
    test: FitTest
    names: tuple[str, ...]
    progress: Progress

    @property
    def lack(self) -> LackOfFit:
        """Whether anything is missing from the base."""
        return self.test.of(self.base.residual_mm, _adjusted(self.base.model))

    def ranked(self) -> tuple[list[Screened], int]:
        """Rank effects by the evidence they offer to first order; give also how many effects and elements there were.

        Those with a shape of their own (a time constant) are screened at several.
        """
        base = self.base
        screened = screen(base.samples, base.model, self.names, base.noise, 1.0)
        best = {name: screened.best_elements(name) for name in screened.effects()}
        shaping = [name for name in self.names if any(each.is_shape for each in base.model.info(name).parameters)]
        for shape in SHAPES if shaping else ():
            again = screen(base.samples, base.model, shaping, base.noise, 1.0, shape)
            for name in again.effects():
                best[name] = max(best[name], again.best_elements(name), key=lambda each: each.bic_drop(again.readings))
        ranked = sorted(best.values(), key=lambda each: -each.bic_drop(screened.readings))
        return ranked, sum(1 + len(screened.elements(name)) for name in best)

    def trials(self, chosen: Sequence[Screened], tried: int) -> list[Trial]:
        """Fit some effects in earnest, the largest evidence first; p-values count all that were `tried`.

        Neighbouring readings are as dependent as the fit leaves them that leaves them least so: what goes together
        beyond that is what the others miss, and must not make their evidence incomparable.
        """
        found = [self.trial(each.effect, each.elements, each.shape) for each in chosen]
        least = min((trial.result.correlation for trial in found), default=1.0)
        found = [
            replace(trial, candidate=weighed(self.base, trial.candidate, least, trial.result.correlation))
            for trial in found
        ]
        corrected = {each.effect: each for each in holm([trial.candidate for trial in found], tried)}
        with_p = [replace(trial, candidate=corrected[trial.candidate.effect]) for trial in found]
        return sorted(with_p, key=lambda trial: -trial.candidate.bic_drop)

    def trial(self, effect: str, elements: Sequence[str], shape: float = 0.0) -> Trial:
        """Fit one effect in earnest."""
        self.progress(f"trying {effect}")
        candidate, result = try_effect(self.base, effect, elements, shape)
        adjusted = _adjusted(self.base.model) + len(candidate.values)
        return Trial(candidate, result, self.test.of(result.residual_mm, adjusted))

    def beside(self, candidate: Candidate) -> Search:
        """Give the search for what is missing once a candidate has been added."""
        base = fitted_base(self.base.samples, candidate.model, self.base.noise)
        names = tuple(name for name in absent_effects(base.model) if name in self.names)
        return replace(self, base=base, names=names)

    def without_needless(self, first: Trial, second: Trial) -> Trial | None:
        """Give the first effect with those of its elements only that contribute beside the second; None without any."""
        candidate = first.candidate
        kept = contributing(self.base, second.candidate.model, second.result, candidate.effect, candidate.elements)
        if not kept or kept == candidate.elements:
            return first if kept else None
        again = self.trial(candidate.effect, kept)
        return replace(again, candidate=replace(again.candidate, p_value=candidate.p_value))


def absent_effects(model: Model) -> list[str]:
    """Name the effects that could be missing: known ones that the model lacks, or holds in part."""
    partly = {term.effect for term in model.terms if not term.free.all() and not np.any(term.values[~term.free])}
    wholly = {term.effect for term in model.terms} - partly
    return [name for name in (*_core.effect_names("catalogue"), *model.own_effects) if name not in wholly]


def _adjusted(model: Model) -> int:
    """Directions a fit can adjust, at most: a bound that keeps the test for smoothness on the safe side."""
    return int(model.free.sum())
