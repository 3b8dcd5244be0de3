"""What a search for causes begins with: a model fitted as it is, to readings that do not stand alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from hexdbb.diagnosis import (
    FitTest,
    JudgingNoise,
    Sufficiency,
    assess_sufficiency,
    glitches_in,
    glitches_sentence,
    judging_noise,
)
from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.linear.engine import Engine
from hexdbb.model import Model
from hexdbb.samples import Samples


@dataclass(frozen=True)
class Begun:
    """What a search begins with: readings that do not stand alone, the noise they are judged by, what was left out."""

    engine: Engine
    judging: JudgingNoise
    left_out: str | None

    def by_noise_of(self, engine: Engine) -> Begun:
        """Return the same readings judged by the noise of another engine of them."""
        return replace(self, engine=engine, judging=replace(self.judging, noise=engine.noise))

    def suffices(self, matters_um: float | None) -> Callable[[Model, np.ndarray], Sufficiency]:
        """Return what tells whether a model, and what it leaves, is sufficient."""
        samples = self.engine.samples
        test = FitTest(samples, self.judging.noise)

        def sufficiency(fitted: Model, residual_mm: np.ndarray) -> Sufficiency:
            return assess_sufficiency(
                samples, fitted, residual_mm, noise=self.judging, matters_um=matters_um, test=test
            )

        return sufficiency

    def enough(self, matters_um: float | None) -> Sufficiency:
        """Judge the model that was begun with."""
        return self.suffices(matters_um)(self.engine.base, self.engine.residual_mm)


def begin(samples: Samples, model: Model, criteria: Criteria) -> Begun:
    """Fit a model as it is, leave out readings that stand alone, and find the noise to judge it by.

    Raises
    ------
    RunError
        Where the model cannot be fitted.
    """
    judging = judging_noise(samples)
    engine = Engine(samples, model, judging.noise, criteria)
    alone = glitches_in(samples, engine.residual_mm, judging.noise.sigma_mm)
    kept, left_out = samples, None
    if alone.any():
        kept = samples.part(~alone)
        judging = judging_noise(kept)
        left_out = glitches_sentence(samples, engine.residual_mm, alone)
    quieter = judging.beside(kept, engine.residual_mm[~alone])
    if left_out is not None or quieter is not judging:
        engine = Engine(kept, model, quieter.noise, criteria)
    return Begun(engine, quieter, left_out)
