"""Effect after effect until nothing that matters is missing: look, add what is found, ask again of what was added.

Of one look all causes that are known for sure are added, the largest first. An early choice may have stood in for what
a later one explains better; after every look each earlier one is therefore taken out on trial, and for good where the
model without it has more evidence. What is calibrated, and is off, is fitted from then on. An effect that the readings
cannot tell from another is never added, nor is one that has been taken out before. What the forms of the effects found
leave is added on demand, as functions that describe them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from hexdbb.diagnosis import Diagnosis, Noise, judging_noise
from hexdbb.discovery.discover import Progress, discover
from hexdbb.discovery.result import Discovery
from hexdbb.discovery.words import joined
from hexdbb.evidence.linear.engine import Engine
from hexdbb.ledger import add_effect, remove_effect
from hexdbb.model import Choice, Model
from hexdbb.samples import Samples

MAX_LOOKS = 8
"""Looks after which nothing more is added: each adds up to four causes, and no machine has thirty."""

PREDICTS = 0.98
"""Part of the held-out error that is left at most where a form's function is kept: what gains less is noise's."""


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
    forms: bool = False,
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
    forms : bool
        Whether functions that describe the forms of the effects are added too, where circles left out are predicted
        better with them.

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
    tried: set[str] = set()
    described: set[str] = set()
    """Effects beside which functions describe their forms: of the two the effect is what has a name."""
    for _ in range(MAX_LOOKS):
        found = discover(samples, model, candidates, progress, matters_um=matters_um)
        sure = [each.choice for each in found.causes if each.verdict == "effect"] if found.verdict == "effect" else []
        choices = [each for each in (*found.calibrated, *sure) if each not in tried]
        forms_of = _describing(found, choices) if forms else ()
        refining = [each for each in dict.fromkeys(forms_of) if each not in tried and model.term(each) is None]
        earlier, before = tuple(added), model
        for step in _adding(samples, model, choices, refining, progress):
            model = step.diagnosis.model
            described.update((choices or earlier) if step.choice in refining else ())
            added.append(step.choice)
            yield step
        if model is before:
            yield found
            return
        tried.update(refining)
        needless = [each for each in earlier if each not in described]
        for step in without_needless(samples, model, needless, progress):
            model = step.diagnosis.model
            added.remove(step.choice)
            tried.add(step.choice)
            yield step
    yield discover(samples, model, candidates, progress, matters_um=matters_um)


def _describing(found: Discovery, choices: Sequence[str]) -> tuple[str, ...]:
    """Return the functions that describe the forms of what was found: of what is added, else of what the model has."""
    if not choices:
        return found.refinements
    return tuple(name for each in found.causes if each.choice in choices for name in each.refinements)


def _adding(
    samples: Samples, model: Model, choices: Sequence[str], refining: Sequence[str], progress: Progress
) -> Iterator[AutoStep]:
    """Add every choice; and of functions that describe forms those with which circles left out are predicted better."""
    for each in (*choices, *refining):
        progress(f"adding {each}")
        diagnosis = add_effect(samples, model, each)
        if each in choices or predicts_better(diagnosis.model):
            model = diagnosis.model
            yield AutoStep("add", each, diagnosis)


def predicts_better(model: Model) -> bool:
    """Check whether circles left out are predicted better since a model's last step; not where none could be."""
    step = model.ledger[-1]
    return (step.heldout_after_um or 0.0) < PREDICTS * (step.heldout_before_um or 0.0)


def closing_sentence(steps: Sequence[AutoStep], last: Discovery) -> str:
    """Return what was found and what is left, in one sentence."""
    kept: list[str] = []
    for step in steps:
        if step.what == "add":
            kept.append(step.choice)
        else:
            kept.remove(step.choice)
    found = f"found and added: {joined(kept)}" if kept else "nothing was added"
    return f"{found}; {last.sentence}"


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
    """Check whether a model has more evidence with an effect (or some elements of it) than without.

    Raises
    ------
    InputError
        An effect or element that the model does not have.
    RunError
        Where a fit does not succeed.
    """
    known, noise = model.with_mounts(samples.mounts), judging_noise(samples).noise
    without = known.without_effect(Choice.parse(choice))
    return _log_evidence(samples, known, noise) > _log_evidence(samples, without, noise)


def _log_evidence(samples: Samples, model: Model, noise: Noise) -> float:
    """Return the log marginal likelihood of a model, free values fitted (Laplace)."""
    engine = Engine(samples, model, noise)
    return engine.linearised(engine.base).linear.log_evidence
