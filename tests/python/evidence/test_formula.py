"""What formulas explain without the functions of their forms, on columns at right angles."""

from __future__ import annotations

import numpy as np
import pytest

from hexdbb.evidence.fit.formula import left_by_formulas
from hexdbb.evidence.forms.form import Form
from hexdbb.evidence.linear.readings import Linear

FORMULA, FORM, NOISE = 30.0, 40.0, 1.0


@pytest.mark.parametrize(("columns", "left"), [(1, FORM**2 + NOISE**2), (0, NOISE**2)])
def test_functions_of_a_form_are_taken_out_again(columns: int, left: float) -> None:
    """What they had explained is left; a trial whose effect has no form leaves what it leaves."""
    own, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(4000, 3)))
    effect, form, noise = (own * np.sqrt(len(own))).T
    # At the fit both columns stand where they explain all but the noise, well within their priors.
    standing = np.array([FORMULA, FORM]) * 1e-6
    linear = Linear(NOISE * noise, np.column_stack([effect, form]) * 1e6, standing)
    form_of_it = Form(0.1, 0.1, ("learned:slider:1:position",), columns, 1)
    assert left_by_formulas([form_of_it], linear) == pytest.approx(left, rel=1e-3)
