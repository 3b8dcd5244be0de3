"""Picture of the singular values of the machine's errors under several plans, largest first.

A plan that determines more has more singular values and higher ones; where the curve falls steeply, a combination of
errors is determined only by many readings. Figures are made without pyplot, so that drawing keeps no state and opens no
window.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from hexdbb.identifiability import Observability


def spectrum_figure(plans: Mapping[str, Observability]) -> Figure:
    """Return a figure of the singular values of several plans, each under its name."""
    figure = Figure(figsize=(8.0, 4.5), layout="constrained")
    axes = figure.add_subplot()
    for name, found in plans.items():
        seen = found.singular_values[: found.rank]
        label = f"{name}: rank {found.rank}, condition {found.condition:.0f}"
        axes.semilogy(np.arange(1, found.rank + 1), 1e3 * seen, "o-", markersize=4, label=label)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlabel("combination of errors, best determined first")
    axes.set_ylabel("reading error, RMS (µm)\nper prior standard deviation of the combination")
    axes.grid(which="both", color="0.88", linewidth=0.6)
    axes.legend()
    return figure
