"""Operating curves: shares of outcomes over the size of a fault, by deviation of form; beside them outside faults."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from tests.truth.forms import cases as forms

Line = dict[str, Any]
GROUPS = (
    ("right", ("right", "more"), "#004B76"),
    ("right effect or place, wrong element or variable", ("element", "variable", "port"), "#56B4E9"),
    ("ambiguous or unknown", ("ambiguous", "missed"), "#BBBBBB"),
    ("false name", ("false",), "#D55E00"),
)
"""What is drawn: label, outcomes, colour (Okabe and Ito 2008)."""


def draw_curves(lines: Sequence[Line], path: Path) -> None:
    """Write a PNG of single faults."""
    panels: list[tuple[str, list[Line]]] = [
        (
            f"form {100 * deviation:.0f} % off",
            [e for e in lines if e["hidden"] and e["hidden"][0]["catalogued"] and _deviation(e) == deviation],
        )
        for deviation in forms.DEVIATIONS
    ]
    panels.append(("outside the catalogue", [e for e in lines if e["hidden"] and not e["hidden"][0]["catalogued"]]))
    with mpl.rc_context({"font.size": 9}):
        figure = Figure(figsize=(12.0, 3.2), layout="constrained")
        every = figure.subplots(1, len(panels), sharey=True)
        for axes, (title, chosen) in zip(every, panels, strict=True):
            _stack(axes, chosen)
            axes.set_title(title, fontsize=9)
            axes.set_xlabel("size of the fault, × noise")
        every[0].set_ylabel("share of cases, %")
        handles, labels = every[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=len(GROUPS), frameon=False)
        path.parent.mkdir(exist_ok=True)
        figure.savefig(path, dpi=110)


def _stack(axes: Axes, lines: Sequence[Line]) -> None:
    sizes = sorted({forms.case(each["case"]).times_noise for each in lines})
    below = np.zeros(len(sizes))
    for label, outcomes, colour in GROUPS:
        shares = []
        for size in sizes:
            at = [each["outcome"] for each in lines if forms.case(each["case"]).times_noise == size]
            shares.append(100.0 * sum(each in outcomes for each in at) / len(at))
        axes.bar(range(len(sizes)), shares, bottom=below, color=colour, label=label, width=0.85)
        below = below + np.array(shares)
    counts = [sum(forms.case(each["case"]).times_noise == size for each in lines) for size in sizes]
    axes.set_xticks(range(len(sizes)), [f"{size:g}\nn = {count}" for size, count in zip(sizes, counts, strict=True)])
    axes.set_ylim(0.0, 100.0)


def _deviation(line: Line) -> float:
    return forms.case(line["case"]).form_deviation
