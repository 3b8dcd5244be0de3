"""Effect after effect until nothing is missing: look, add what is found, ask again of what was added before.

Effects come in the order of their evidence, the largest first. An early choice may have stood in for what a later one
explains better; after every addition each earlier one is therefore taken out on trial, and for good where BIC prefers
the model without it. An effect that the readings cannot tell from another is never added.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from hexdbb.diagnosis import Diagnosis, Noise, evaluate_fit
from hexdbb.discovery.discover import discover
from hexdbb.discovery.judging import judging_noise
from hexdbb.discovery.result import Discovery
from hexdbb.discovery.search import Progress
from hexdbb.ledger import add_effect, remove_effect
from hexdbb.model import Choice, Model
from hexdbb.samples import Samples

MOST_STEPS = 20
"""Effects added and removed at most, lest two take turns."""


@dataclass(frozen=True)
class AutoStep:
    """One thing done to the model; `diagnosis.model` is the model after it."""

    what: Literal["add", "remove"]
    choice: str
    diagnosis: Diagnosis


def discover_all(
    samples: Samples,
    model: Model,
    candidates: Sequence[str] | None = None,
    progress: Progress = lambda _: None,
) -> Iterator[AutoStep | Discovery]:
    """Add missing effects one after another.

    Parameters
    ----------
    samples : Samples
    model : Model
    candidates : sequence of str, optional
        As for `discover`.
    progress : callable
        Is told what is being done.

    Yields
    ------
    AutoStep or Discovery
        Every step as soon as it is done; last of all the look after which nothing was added: nothing is missing, it is
        not known what, or several effects explain it alike.

    Raises
    ------
    InputError, RunError
        What `discover` and `hexdbb.ledger.add_effect` raise.
    """
    added: list[str] = []
    steps = 0
    while True:
        found = discover(samples, model, candidates, progress)
        if found.verdict != "effect" or found.best is None or steps >= MOST_STEPS:
            yield found
            return
        choice = found.best.choice
        progress(f"adding {choice}")
        diagnosis = add_effect(samples, model, choice)
        model = diagnosis.model
        steps += 1
        yield AutoStep("add", choice, diagnosis)
        for step in without_needless(samples, model, added, progress):
            model = step.diagnosis.model
            added.remove(step.choice)
            steps += 1
            yield step
        added.append(choice)


def without_needless(
    samples: Samples, model: Model, choices: Sequence[str], progress: Progress = lambda _: None
) -> Iterator[AutoStep]:
    """Take those of some effects (or elements of them) out of a model that it does as well without.

    Yields
    ------
    AutoStep
        For each effect taken out, as soon as it is.

    Raises
    ------
    InputError, RunError
        What `is_needed` and `hexdbb.ledger.remove_effect` raise.
    """
    for choice in tuple(choices):
        progress(f"asking whether {choice} is still needed")
        if not is_needed(samples, model, choice):
            diagnosis = remove_effect(samples, model, choice)
            model = diagnosis.model
            yield AutoStep("remove", choice, diagnosis)


def is_needed(samples: Samples, model: Model, choice: str) -> bool:
    """Whether a model explains records better, by BIC, with an effect (or some elements of it) than without.

    Raises
    ------
    InputError
        An effect or element that the model does not have.
    """
    known, noise = model.with_mounts(samples.mounts), judging_noise(samples).noise
    without = known.without_effect(Choice.parse(choice))
    values = int(known.free.sum()) - int(without.free.sum())
    more, correlation, readings = _squared(samples, without, noise)
    less, correlation, readings = _squared(samples, known, noise)
    return (more - less) / correlation > values * float(np.log(readings / correlation))


def _squared(samples: Samples, model: Model, noise: Noise) -> tuple[float, float, int]:
    """Squared residuals over the noise's variance, how many neighbours tell as much as one, and number of readings."""
    result = evaluate_fit(samples, model, model.free, noise, hypothesis=True)[1]
    squared = float(result.residual_mm @ result.residual_mm) / noise.sigma_mm**2
    return squared, result.correlation, len(result.residual_mm)
