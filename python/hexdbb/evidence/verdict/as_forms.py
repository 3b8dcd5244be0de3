"""What is missing, explained as the forms of the effects that a model has.

An effect 10 % off its formula leaves 1 % of what it explains: if it is 100 times the noise, it leaves 10 times the
noise. A learned function at some other place may follow that remainder; the effect's own place is the simpler answer.
"""

from __future__ import annotations

import numpy as np

from hexdbb.errors import RunError
from hexdbb.evidence.fit.node import Node
from hexdbb.evidence.linear.screen import Known
from hexdbb.evidence.search.refine import refined_forms
from hexdbb.evidence.search.search import Search
from hexdbb.evidence.search.settling import explains_nearly


def as_forms(search: Search, node: Node) -> Node | None:
    """Return functions at the places of the model's effects that explain nearly as much as learned ones elsewhere.

    None where a known effect is among those found, where no functions there do, or where what is missing is more than
    the forms of the model's effects may be off (`Criteria.form_named`).
    """
    if not search.trials.present or any(isinstance(each, Known) for each in node.hypotheses):
        return None
    if search.root.trial.left - 1.0 >= search.criteria.form_named**2 * _explained(search):
        return None
    forms = refined_forms(search)
    return forms if explains_nearly(search, forms.trial.left, node.trial.left) else None


def _explained(search: Search) -> float:
    """Return what the model's effects explain, in noise variances: what its other values, fitted anew, leave more.

    Geometry that is made linear about a fit imitates most of a large effect (`Trials.explained_before`); fitted, it
    cannot bend so far.
    """
    base = search.engine.base
    without = np.array([(each.effect, each.element) in search.trials.present_elements for each in base.parameters()])
    model = base.with_values(np.where(without, base.start, base.values)).with_free(base.free & ~without)
    try:
        fitted = search.engine.fit(model)
    except RunError:
        return 0.0
    return float(np.mean(fitted.linear.residual**2)) - search.root.trial.left
