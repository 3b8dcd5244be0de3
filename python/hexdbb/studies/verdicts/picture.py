"""Operating curves: shares of outcomes over the size of a fault, by deviation of form; beside them outside faults."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from hexdbb.studies.drawing import error_bars
from hexdbb.studies.rates import share
from hexdbb.studies.verdicts.outcome import NAMED
from hexdbb_truth.forms import cases as forms

Line = dict[str, Any]
GROUPS = (
    ("right", NAMED, "#004B76"),
    ("right effect or place, wrong element or variable", ("element", "variable", "port"), "#56B4E9"),
    ("ambiguous or unknown", ("ambiguous", "lead", "missed"), "#BBBBBB"),
    ("false name", ("false",), "#D55E00"),
)
"""What is drawn: label, outcomes, colour (Okabe and Ito 2008)."""


def curves_figure(lines: Sequence[Line]) -> Figure:
    """Return the figure of single faults; bars have the 95 % bounds of the share that is right."""
    panels: list[tuple[str, list[Line]]] = [
        (
            f"form {100 * deviation:.0f} % off",
            [e for e in lines if e["hidden"] and e["hidden"][0]["catalogued"] and _deviation(e) == deviation],
        )
        for deviation in forms.DEVIATIONS
    ]
    panels.append(("outside the catalogue", [e for e in lines if e["hidden"] and not e["hidden"][0]["catalogued"]]))
    figure = Figure(figsize=(12.0, 3.2), layout="constrained")
    panels = [each for each in panels if each[1]] or panels[:1]
    every = figure.subplots(1, len(panels), sharey=True, squeeze=False).ravel()
    for axes, (title, chosen) in zip(every, panels, strict=True):
        _stack(axes, chosen)
        axes.set_title(title, fontsize=9)
        axes.set_xlabel("size, × noise (cases)")
    every[0].set_ylabel("share of cases, %")
    handles = [Patch(color=colour) for _, _, colour in GROUPS]
    labels = [label for label, _, _ in GROUPS]
    figure.legend(handles, labels, loc="outside lower center", ncols=len(GROUPS), frameon=False)
    return figure


def _stack(axes: Axes, lines: Sequence[Line]) -> None:
    sizes = sorted({forms.case(each["case"]).times_noise for each in lines})
    at = [[each["outcome"] for each in lines if forms.case(each["case"]).times_noise == size] for size in sizes]
    below = np.zeros(len(sizes))
    for _, outcomes, colour in GROUPS:
        shares = [100.0 * sum(each in outcomes for each in own) / len(own) for own in at]
        axes.bar(range(len(sizes)), shares, bottom=below, color=colour, width=0.85)
        below = below + np.array(shares)
    right = [share(sum(each in NAMED for each in own), len(own)) for own in at]
    error_bars(axes, range(len(sizes)), right, 100.0, None, "black")
    axes.set_xticks(range(len(sizes)), [f"{size:g}\n({len(own)})" for size, own in zip(sizes, at, strict=True)])
    axes.set_ylim(0.0, 100.0)


def _deviation(line: Line) -> float:
    return forms.case(line["case"]).form_deviation
