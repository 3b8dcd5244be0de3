"""Effect after effect until nothing that matters is missing: look, add what is found, ask again of what was added.

Of one look all causes that are known for sure are added, the largest first. An early choice may have stood in for what
a later one explains better; after every look each earlier one is therefore taken out on trial, and for good where BIC
prefers the model without it. An effect that the readings cannot tell from another is never added, nor is one that has
been taken out before.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from hexdbb.diagnosis import Diagnosis, Noise, evaluate_fit, judging_noise
from hexdbb.discovery.discover import Progress, discover
from hexdbb.discovery.result import Discovery
from hexdbb.discovery.words import joined
from hexdbb.ledger import add_effect, remove_effect
from hexdbb.model import Choice, Model
from hexdbb.samples import Samples

MAX_LOOKS = 8
"""Looks after which nothing more is added: each adds up to four causes, and no machine has thirty."""


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
    *,
    matters_um: float | None = None,
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
    matters_um : float, optional
        As for `discover`.

    Yields
    ------
    AutoStep or Discovery
        Every step as soon as it is done; last of all the look after which nothing was added: nothing that matters is
        missing, it is not known what, or several effects explain it alike.

    Raises
    ------
    InputError, RunError
        What `discover` and `hexdbb.ledger.add_effect` raise.
    """
    added: list[str] = []
    taken_out: set[str] = set()
    for _ in range(MAX_LOOKS):
        found = discover(samples, model, candidates, progress, matters_um=matters_um)
        sure = [each.choice for each in found.causes if each.verdict == "effect"] if found.verdict == "effect" else []
        choices = [each for each in sure if each not in taken_out]
        if not choices:
            yield found
            return
        earlier = tuple(added)
        for choice in choices:
            progress(f"adding {choice}")
            diagnosis = add_effect(samples, model, choice)
            model = diagnosis.model
            added.append(choice)
            yield AutoStep("add", choice, diagnosis)
        for step in without_needless(samples, model, earlier, progress):
            model = step.diagnosis.model
            added.remove(step.choice)
            taken_out.add(step.choice)
            yield step
    yield discover(samples, model, candidates, progress, matters_um=matters_um)


def closing_sentence(steps: Sequence[AutoStep], last: Discovery) -> str:
    """Return what was found and what is left, in one sentence."""
    kept: list[str] = []
    for step in steps:
        if step.what == "add":
            kept.append(step.choice)
        else:
            kept.remove(step.choice)
    found = f"found and added: {joined(kept)}" if kept else "nothing was added"
    left = last.sufficiency.sentence if last.verdict == "none" else last.sentence
    return f"{found}; left: {left}" if last.verdict == "none" else f"{found}; but {left}"


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
