"""How large functions beside an effect are: of those that push one thing, their sum counts."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from hexdbb.evidence.criteria import DEFAULT
from hexdbb.evidence.forms.form_functions import FormFunctions
from hexdbb.evidence.linear.readings import Readings
from hexdbb.learned import Learned


@pytest.mark.parametrize(("element", "expected"), [("1", 0.0), ("2", np.sqrt(2.0))], ids=["one slider", "two sliders"])
def test_functions_that_push_one_thing_may_undo_each_other(readings: Readings, element: str, expected: float) -> None:
    """Splines sum to one: the one function is 1 mm everywhere, the other -1 mm."""
    functions = tuple(map(Learned.parse, ("learned:slider:1:position", f"learned:slider:{element}:fine_position")))
    columns = [each.variable.columns for each in functions]
    found = SimpleNamespace(coefficients=np.concatenate([np.ones(columns[0]), -np.ones(columns[1])]))
    beside: Any = SimpleNamespace(functions=SimpleNamespace(functions=functions, ends=columns[:1]), found=found)
    assert FormFunctions(readings, DEFAULT).rms_mm(beside) == pytest.approx(expected, abs=1e-6)
