"""What the formulas of a set of effects explain alone, without the functions of their forms beside them.

Geometry may take most of an effect, and then a form that is a small part of its push can be most of what the readings
show of it: functions beside an effect's formula, or beside several that undo each other, imitate what is none of it.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.linear.readings import Linear


def left_by_formulas(forms: Iterable[Form | None], linear: Linear) -> float:
    """Return the mean square (noise variances) that effects leave where they have no form but their own.

    Parameters
    ----------
    forms : iterable of Form or None
        Of each effect of a trial.
    linear : Linear
        The trial's linearisation, in whose residual the functions of forms are explained.
    """
    beside = np.zeros(len(linear.standing), bool)
    for form in forms:
        if form is not None:
            beside[form.first : form.first + form.columns] = True
    # Values of which nothing is subtracted are fitted anew; those of the functions become zero. All follows from sums.
    information, gradient = linear.normal[:-1, :-1], linear.normal[:-1, -1]
    change = np.where(beside, -linear.standing, 0.0)
    left = gradient - information @ change
    square = information[np.ix_(~beside, ~beside)] + np.eye(int(np.sum(~beside)))
    change[~beside] = np.linalg.solve(square, (left - linear.standing)[~beside])
    squared = linear.normal[-1, -1] - 2.0 * change @ gradient + change @ information @ change
    return float(squared / len(linear.residual))
