"""Marks of where sliders reverse, with their names, in pictures against the commanded polar angle."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes

from hexdbb.charts.lines import near
from hexdbb.comparison.reversals import Reversal

ROOM = 0.35
"""Part of a panel's height left free above its lines for the names."""


def mark_reversals(axes: Axes, reversals: Sequence[Reversal], meant: Sequence[str] = (), fontsize: float = 6.0) -> None:
    """Mark reversals by lines with the sliders' names, those of the sliders meant (``slider 4``) in bold.

    Call it last: it makes room above what is drawn.
    """
    if not reversals:
        return
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + ROOM * (high - low))
    for group in near(reversals):
        angle_deg = sum(each.angle_deg for each in group) / len(group)
        is_meant = any(f"slider {each.slider}" in meant for each in group)
        colour = "0.15" if is_meant else "0.6"
        axes.axvline(angle_deg, color=colour, linewidth=1.0 if is_meant else 0.5, linestyle=":", zorder=1.5)
        name = axes.annotate(
            f"slider {', '.join(str(each.slider) for each in group)}",
            (angle_deg, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(0.0, -2.0),
            textcoords="offset points",
            rotation=90.0,
            ha="center",
            va="top",
            fontsize=fontsize,
            color=colour,
            fontweight="bold" if is_meant else "normal",
            zorder=6,
        )
        name.set_in_layout(False)  # it stands inside the panel: the layout need not measure it, which is slow
