"""A hypothesis previewed: the model with it, fitted, before anybody decides to add it.

The fit is that of `add_effect` without what makes a step of the ledger: no circle is held out, nothing is judged.
"""

from __future__ import annotations

from hexdbb.diagnosis import evaluate_fit, learned_effect, noise_of
from hexdbb.learned.places import is_learned
from hexdbb.model import Choice, Model
from hexdbb.samples import Samples
from hexdbb.threads import one_thread


@one_thread
def preview_effect(samples: Samples, model: Model, *choices: str) -> Model:
    """Return a model with some effects more, everything that is free fitted; its ledger stays as it is.

    Parameters
    ----------
    samples : Samples
    model : Model
    choices : str
        As `hexdbb.ledger.add_effect` takes them, together.

    Raises
    ------
    InputError
        An effect or element that is not known, or is in the model.
    RunError
        Where the fit did not end in a usable solution.
    """
    known = model.with_mounts(samples.mounts)
    for text in choices:
        choice = Choice.parse(text)
        if is_learned(choice.effect) and known.own(choice.effect) is None:
            known = known.knowing_effects([learned_effect(samples, known, choice.effect)])
        known = known.with_effect(choice)
    return evaluate_fit(samples, known, known.free, noise_of(samples), hypothesis=True)[0]
