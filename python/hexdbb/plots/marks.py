"""Marks of where sliders reverse, with their numbers, in pictures against the commanded polar angle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from hexdbb.charts.colours import NOMINAL_COLOUR, TEXT_COLOUR
from hexdbb.charts.lines import near
from hexdbb.comparison.iso230 import FloatArray
from hexdbb.comparison.reversals import Reversal
from hexdbb.plots.dial import Dial
from hexdbb.plots.labels import Labels
from hexdbb.plots.style import inside

ROOM_PT = 24.0
"""Height left free above the lines of a panel for two numbers on end, points."""
LINE_PT = 10.0
"""Distance of two numbers on end that do not cover one another, points."""
POINTS_PER_IN = 72.0
SPOKE_BEGINS, NUMBER_AT = 0.38, 0.29
"""Parts of a polar plot's radius; its paths stay outside 0.4 (`magnification.LARGEST_SHARE_OF_RADIUS`)."""
AROUND_DEG = 14.0
"""Arc that a number takes at `NUMBER_AT` in a large polar plot."""
KEY = "dotted: the slider of that number reverses; in bold what the likely cause acts at"
"""What the marks are, for a picture's legend."""


def mark_reversals(
    axes: Axes, reversals: Sequence[Reversal], size_in: tuple[float, float], meant: Sequence[str] = ()
) -> None:
    """Mark reversals by lines with the sliders' numbers; those of the sliders meant (``slider 4``) in bold.

    Call it last: it makes room above what is drawn.

    Parameters
    ----------
    axes : Axes
        Against degrees, 0 to 360.
    reversals : sequence of Reversal
    size_in : tuple of float
        Width and height of the panel, about, inches: numbers nearer than a line of text share one place.
    meant : sequence of str
    """
    if not reversals:
        return
    low, high = axes.get_ylim()
    share = ROOM_PT / (POINTS_PER_IN * size_in[1])
    axes.set_ylim(low, high + share / (1.0 - share) * (high - low))
    across, apart_deg = axes.get_xaxis_transform(), 360.0 * LINE_PT / (POINTS_PER_IN * size_in[0])
    for is_meant, angles_deg in _by_meaning(reversals, meant):
        ends = np.column_stack([np.repeat(angles_deg, 2), np.tile([0.0, 1.0], len(angles_deg))])
        lines = LineCollection(list(ends.reshape(-1, 2, 2)), transform=across, zorder=1.5, **_line_style(is_meant))
        axes.add_collection(lines, autolim=False)
        inside(lines)
    for is_meant, names in _grouped(reversals, apart_deg, meant):
        places = [(angle_deg, 1.0) for angle_deg, _ in names]
        said = [numbers for _, numbers in names]
        Labels(axes, places, said, transform=across, va="top", upright=True, **_text_style(is_meant))


def mark_reversals_around(dial: Dial, reversals: Sequence[Reversal], meant: Sequence[str], named: bool) -> None:
    """Mark reversals by spokes; in the middle the numbers, of all sliders where `named`, else of those meant."""
    centre, rim = dial.centre, dial.rim
    along = [centre + part * (rim - centre) for part in (SPOKE_BEGINS, 1.0)]
    for is_meant, angles_deg in _by_meaning(reversals, meant):
        spokes = [np.column_stack([np.full(2, angle_rad), along]) for angle_rad in np.radians(angles_deg)]
        dial.lines(spokes, zorder=1.5, **_line_style(is_meant))
    for is_meant, names in _grouped(reversals, AROUND_DEG, meant):
        if named or is_meant:
            angles_rad = np.radians([angle_deg for angle_deg, _ in names])
            said = [numbers if named else numbers.partition(" ")[0] for _, numbers in names]
            dial.labels(angles_rad, centre + NUMBER_AT * (rim - centre), said, **_text_style(is_meant))


def _by_meaning(reversals: Sequence[Reversal], meant: Sequence[str]) -> Iterator[tuple[bool, FloatArray]]:
    """Yield the angles (deg) of the reversals of sliders that are not meant, and of those that are."""
    for is_meant in (False, True):
        angles_deg = [each.angle_deg for each in reversals if _is_meant(each, meant) == is_meant]
        if angles_deg:
            yield is_meant, np.array(angles_deg)


def _grouped(
    reversals: Sequence[Reversal], apart_deg: float, meant: Sequence[str]
) -> Iterator[tuple[bool, list[tuple[float, str]]]]:
    """Yield the names of reversals, angle (deg) and numbers, in which no slider is meant, and in which one is."""
    names = list(_names(reversals, apart_deg, meant))
    for is_meant in (False, True):
        some = [(angle_deg, numbers) for angle_deg, numbers, each in names if each == is_meant]
        if some:
            yield is_meant, some


def _names(reversals: Sequence[Reversal], apart_deg: float, meant: Sequence[str]) -> Iterator[tuple[float, str, bool]]:
    """Yield angle (deg), sliders' numbers, and whether one of them is meant; near a meant one others in brackets."""
    for group in near(reversals, apart_deg):
        first = [each for each in group if _is_meant(each, meant)]
        chosen = first or group
        numbers = ", ".join(str(each.slider) for each in chosen)
        others = ", ".join(str(each.slider) for each in group if each not in chosen)
        angle_deg = sum(each.angle_deg for each in chosen) / len(chosen)
        yield angle_deg, f"{numbers} ({others})" if others else numbers, bool(first)


def _is_meant(reversal: Reversal, meant: Sequence[str]) -> bool:
    return f"slider {reversal.slider}" in meant


def _line_style(is_meant: bool) -> dict[str, Any]:
    return {
        "color": TEXT_COLOUR if is_meant else NOMINAL_COLOUR,
        "linewidth": 1.1 if is_meant else 0.6,
        "linestyle": ":",
    }


def _text_style(is_meant: bool) -> dict[str, Any]:
    return {
        "color": TEXT_COLOUR if is_meant else NOMINAL_COLOUR,
        "fontweight": "bold" if is_meant else "normal",
        "backing": 1.0,
    }
