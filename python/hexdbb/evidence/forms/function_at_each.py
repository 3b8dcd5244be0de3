"""The function that says an effect's law with a size of its own at each of six elements, as a model can hold it.

The effect has one value for all, and where the machine's elements differ most of its error stays. Free functions of
time at each leg take that away as well, but predict no circle that is left out; the law with six sizes does.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence.forms.form_functions import FormFunctions
from hexdbb.evidence.forms.laws_at_each import Law
from hexdbb.learned import Learned
from hexdbb.learned.following import creep
from hexdbb.learned.places import EACH

Floats = NDArray[np.float64]

SPANS = (0.01, 100.0)
"""Time constants over the length of a test, between which one is sought: shorter it is a step, longer a straight line,
to a hundredth of what grows."""

SAME_LAW = 1e-3
"""Part of a law's square that a growth towards an end leaves at most where it is the law: a time constant that is read
to a few per cent leaves less."""


def function_at_each(functions: FormFunctions, law: Law) -> Learned:
    """Return the function, one for each of six elements, that an effect's law is: with one size each, if it can.

    Parameters
    ----------
    functions : FormFunctions
        On the rows that the law was found on.
    law : Law

    Returns
    -------
    Learned
        A growth towards an end where the law is one; else a free function of the law's variable.
    """
    free = replace(law.shared, element=EACH)
    if not law.shared.is_of_time:
        return free
    from scipy.optimize import minimize_scalar  # takes a tenth of a second to import

    pushed = np.asarray(functions.signature(law.shared).table, np.float64) @ law.coefficients
    span_s = float(np.ptp(functions.readings.state["time_s"]))

    def growing(log_spans: float) -> Learned:
        return replace(law.shared, variable=creep(span_s * float(np.exp(log_spans))))

    def missed(log_spans: float) -> float:
        unit = np.asarray(functions.signature(growing(log_spans)).table, np.float64)[:, 0]
        return 1.0 - float(unit @ pushed) ** 2 / float((unit @ unit) * (pushed @ pushed))

    found = minimize_scalar(missed, bounds=np.log(SPANS), method="bounded")
    return replace(growing(float(found.x)), element=EACH) if found.fun <= SAME_LAW else free
