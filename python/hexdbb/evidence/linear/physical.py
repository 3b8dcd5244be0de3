"""What values are physically possible, and what a value outside costs.

A parameter with a one-sided domain has a half-normal prior. Against the two-sided normal of the fit its evidence is
multiplied by 2 Phi(value / sigma): a value well inside gains a factor of two, one outside loses everything.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hexdbb import _core
from hexdbb.evidence.criteria import Criteria
from hexdbb.evidence.linear.engine import Fitted
from hexdbb.evidence.linear.screen import Known
from hexdbb.learned import Learned
from hexdbb.units import readable_unit, shown_factor, shown_unit


def outside_domain(
    fitted: Fitted, hypotheses: Sequence[Known | Learned], criteria: Criteria
) -> tuple[tuple[str, ...], float]:
    """Check the values of hypotheses.

    Returns
    -------
    refused : tuple of str
        Reasons: `negative play of slider 2 (-3.7 µm)`.
    log_evidence : float
        Change of the log evidence by the one-sided priors and by values beyond their limits.
    """
    parameters = fitted.model.parameters()
    known = {(each.effect, element) for each in hypotheses if isinstance(each, Known) for element in each.elements}
    refused, change = [], 0.0
    for place, column in enumerate(fitted.free):
        each = parameters[column]
        if (each.effect, each.element) not in known:
            continue
        value, sigma = float(fitted.model.values[column]), float(fitted.spread[place] * fitted.prior_sigma[place])
        shown = f"{value * shown_factor(each.unit):.3g} {readable_unit(shown_unit(each.unit))}"
        if is_one_sided(fitted.model.info(each.effect), each.name):
            change += float(np.log(2.0)) + _core.log_normal_below(value / sigma)
            if value < -criteria.domain_sigmas * sigma:
                refused.append(f"negative {each.name} ({each.element}: {shown})")
        if abs(value) > each.limit:
            refused.append(f"{each.name} beyond its limit ({each.element}: {shown})")
    return tuple(refused), change


def is_one_sided(info: _core.EffectInfo, name: str) -> bool:
    """Check whether a value of an effect is physically of one sign."""
    return any(each.name == name and each.lower >= 0.0 for each in info.parameters)
