"""What an effect that all legs share does at each of them: larger at one than at another it is the same law.

Legs that warm in a gradient grow by the same law, each by its own size. Geometry takes what they have in common, and
most of what the readings show is then how they differ, which one value for all does not say. The functions of a form
say it with a spline for each leg; six sizes of the effect's own law say it too, and those are no other form.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.alike import DIFFERENCES
from hexdbb.evidence.form import Form
from hexdbb.evidence.homes import at_each, is_shared
from hexdbb.evidence.readings import Linear
from hexdbb.evidence.screen import Known
from hexdbb.evidence.trial import Trial
from hexdbb.evidence.trials import Trials
from hexdbb.learned import Learned

Floats = NDArray[np.float64]


def with_laws_at_each(trials: Trials, trial: Trial, only: Form | None = None) -> Linear:
    """Return a trial's linearisation with what effects push at each of the elements that they share.

    Parameters
    ----------
    trials : Trials
    trial : Trial
    only : Form, optional
        Of the one effect that is asked for; of all where not given.

    Returns
    -------
    Linear
        With a value for each element of the effects whose forms differ from one to the other, behind all others.
    """
    linear = trials.linear(trial)
    found: list[Floats] = []
    for member, form in zip(trial.members, trial.forms, strict=True):
        if form is None or not isinstance(member.hypothesis, Known) or (only is not None and form is not only):
            continue
        shared = next(_shared(form), None)
        law = None if shared is None else _law(trials, trial, member.hypothesis, shared)
        if shared is not None and law is not None:
            # Legs of one make differ by a third at most.
            found += [DIFFERENCES[-1] * (trials.forms.table(each) @ law) for each in at_each(shared)]
    return linear.wider(np.stack(found, axis=1)) if found else linear


def _shared(form: Form) -> Iterator[Learned]:
    """Yield the functions of a form that all elements share, and that each has besides."""
    for function in map(Learned.parse, form.functions):
        if is_shared(function) and {each.name for each in at_each(function)} <= {*form.functions}:
            yield function


def _law(trials: Trials, trial: Trial, known: Known, shared: Learned) -> Floats | None:
    """Return the coefficients with which a function says what an effect does; None where it does not say it."""
    linear, model = trials.linear(trial), trial.model
    own = np.zeros(linear.own.shape[1], bool)
    free = np.flatnonzero(model.free)
    is_shape = np.array([each.is_shape for each in model.parameters()])[free]
    own[: len(free)] = trials.engine.values_of(model, known.effect, known.elements) & ~is_shape
    pushed = linear.own[:, own] @ linear.standing[own]
    table = trials.forms.table(shared)
    law, *_ = np.linalg.lstsq(table, pushed, rcond=None)
    missed = float(np.sum((pushed - table @ law) ** 2))
    says_it = missed <= (1.0 - trials.criteria.same_form) * float(np.sum(pushed**2))
    return np.asarray(law, np.float64) if says_it else None
