"""The slider of one value of the model, as an element of the page: `value_slider.js`."""

from __future__ import annotations

import math
from collections.abc import Callable

from nicegui.element import Element

from hexdbb.model import Parameter
from hexdbb.units import readable_unit, shown_factor, shown_unit

REACH_SIGMAS = 3.0
"""Reach of a slider in prior standard deviations, where the value lies within it: what the value may well be."""
STEPS = 400
"""Steps of a slider: a pixel or two each."""


class ValueSlider(Element, component="value_slider.js"):
    """A value with its name, its size and its uncertainty, to be dragged.

    Parameters
    ----------
    parameter : Parameter
    value, sigma : float
        In engine units; `sigma` is nan where it is not known.
    on_drag : callable
        Called with the label and the value in its unit of output.
    """

    def __init__(self, parameter: Parameter, value: float, sigma: float, on_drag: Callable[[str, float], None]) -> None:
        super().__init__()
        self.label, self._factor = parameter.label, shown_factor(parameter.unit)
        unit = readable_unit(shown_unit(parameter.unit))
        self._size = value * self._factor
        start = parameter.start * self._factor
        reach = max(REACH_SIGMAS * parameter.prior_sigma * self._factor, 1.5 * abs(self._size - start))
        known = f"± {sigma * self._factor:.3g} {unit}" if sigma == sigma else "not known on its own"
        self._props |= {
            "name": f"{parameter.element} {parameter.name}",
            "label": parameter.label,
            "mark": f"value {parameter.label}",
            "unit": unit,
            "known": known,
            "low": start - reach,
            "high": start + reach,
            "step": 2.0 * reach / STEPS,
            "first": self._size,
        }
        self.on("drag", lambda event: self._drag(float(event.args), on_drag))

    def follow(self, value: float) -> None:
        """Show the value that the session has, in engine units."""
        size = value * self._factor
        if not math.isclose(size, self._size):  # a value that was dragged returns rounded: the slider stays
            self._size = size
            self.run_method("set", size)

    def _drag(self, size: float, on_drag: Callable[[str, float], None]) -> None:
        self._size = size
        on_drag(self.label, size)
