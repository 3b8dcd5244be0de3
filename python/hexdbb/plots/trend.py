"""Pictures of a trend: quantities and what changes over months, with limits and change points; then every effect."""

from __future__ import annotations

from typing import Any

import matplotlib.dates
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hexdbb.charts.colours import FORMULA_COLOUR, FUNCTION_COLOUR, NOMINAL_COLOUR, PAPER_COLOUR, RULE_COLOUR
from hexdbb.machine import Watch
from hexdbb.plots.style import sheet, styled
from hexdbb.trend import SURE, Series, Trend
from hexdbb.units import readable_unit

PANEL_IN = 1.75
"""Height of a panel, inches: six on a sheet of A4."""
MOST_CHANGING = 4
"""Changing values that have a panel of their own on the first sheet; all are on the second."""
LIMIT_COLOUR = "#b00020"
MARKS = ("o", "s", "^", "D", "v", "P", "X", "*", "<")
"""Marks of elements, so that they can be told apart in print."""


@styled
def trend_figure(found: Trend) -> Figure:
    """Draw G, G(b) and H, every changing value with its interval, change points and limits, and the residual."""
    quantities = [each for each in found.series if not each.effect]
    changing = found.changing[:MOST_CHANGING]
    figure = sheet(0.8 + PANEL_IN * (2 + len(changing)))
    panels = figure.subplots(2 + len(changing), 1, sharex=True, squeeze=False)[:, 0]
    _draw_quantities(panels[0], found, quantities)
    for axes, series in zip(panels[1:-1], changing, strict=True):
        _draw_changing(axes, found, series)
    _draw_residual(panels[-1], found)
    _date_axis(panels[-1])
    name = found.dated[0].record.machine.name
    figure.suptitle(f"{name}: {len(found.dated)} records, intervals ± {SURE:g} standard deviations")
    return figure


@styled
def trend_effects_figure(found: Trend) -> Figure:
    """Draw the change of every effect's values since the first record: what changes in colour, all else in grey."""
    effects = list(dict.fromkeys(each.effect for each in found.series if each.effect))
    rows = -(-len(effects) // 2)
    figure = sheet(0.8 + 1.5 * rows)
    panels = figure.subplots(rows, 2, sharex=True, squeeze=False).ravel()
    for axes, effect in zip(panels, effects, strict=False):
        _draw_effect(axes, found, [each for each in found.series if each.effect == effect])
    for axes in panels[len(effects) :]:
        axes.set_axis_off()
    for axes in panels[max(0, 2 * rows - 2) :]:
        _date_axis(axes, most=7)
    figure.suptitle(f"Change since the first record, each element alone beside those that change (± {SURE:g} s. d.)")
    return figure


def _draw_quantities(axes: Axes, found: Trend, quantities: list[Series]) -> None:
    times = _days(found)
    for series, mark, colour in zip(quantities, MARKS, (FUNCTION_COLOUR, NOMINAL_COLOUR, FORMULA_COLOUR), strict=False):
        axes.plot(times, series.value, marker=mark, markersize=3.5, color=colour, label=series.label)
        for watch in _watches(found, series):
            _limit(axes, watch, signs=(1.0,), name=series.label)
        _change_points(axes, found, series, colour)
    axes.set_ylim(0.0, 1.15 * axes.get_ylim()[1])
    axes.set_ylabel("µm")
    axes.set_title("Circular deviation G, bi-directional G(b), hysteresis H: the largest on any circle")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def _draw_changing(axes: Axes, found: Trend, series: Series) -> None:
    times = _days(found)
    watches = _watches(found, series)
    as_change = not series.is_known or any(each.change for each in watches)
    value = series.change if as_change else series.value
    sigma = series.change_sigma if as_change else series.sigma
    axes.errorbar(times, value, SURE * sigma, fmt="o", markersize=3.5, capsize=2.0, color=FUNCTION_COLOUR)
    lines = found.segments.get(series.name, [])
    shift = value[0] - series.value[0]
    for each in lines:
        begin, end = times[each.first], times[each.last]
        rise = each.slope * (end - begin)
        axes.plot([begin, end], [each.level + shift, each.level + shift + rise], color=RULE_COLOUR, zorder=1)
    _change_points(axes, found, series, NOMINAL_COLOUR)
    signs = tuple(sign for sign in (1.0, -1.0) if (sign * value - SURE * np.nan_to_num(sigma) > 0.0).any())
    for watch in watches:
        _limit(axes, watch, signs)
    for beyond in found.exceeded:
        if beyond.series is series:
            mark = beyond.first
            axes.plot(times[mark], value[mark], "o", markersize=9, markerfacecolor="none", color=LIMIT_COLOUR)
            axes.annotate(
                f"beyond {beyond.watch.limit:g} since {found.dated[mark].month}",
                (times[mark], value[mark]),
                xytext=(-8, 6),
                textcoords="offset points",
                ha="right",
                color=LIMIT_COLOUR,
                bbox={"facecolor": PAPER_COLOUR, "edgecolor": "none", "pad": 1.0},
            )
    axes.set_ylabel(readable_unit(series.unit))
    what = "change since the first record" if as_change else "value"
    axes.set_title(f"{series.name}: {what}, straight lines of time, change points dotted")


def _draw_residual(axes: Axes, found: Trend) -> None:
    times = _days(found)
    axes.plot(times, found.residual_um, "o-", markersize=3.5, color=FUNCTION_COLOUR, label="residual")
    axes.plot(times, found.noise_um, "--", color=NOMINAL_COLOUR, label="noise")
    axes.set_ylim(0.0, 1.3 * max(found.residual_um + found.noise_um))
    axes.set_ylabel("µm RMS")
    axes.set_title("What the fit of all records leaves of each, and the noise of one reading")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def _draw_effect(axes: Axes, found: Trend, every: list[Series]) -> None:
    times = _days(found)
    for number, series in enumerate(every):
        colour = FUNCTION_COLOUR if series.is_changing else NOMINAL_COLOUR
        apart = 0.02 * max(times[-1] - times[0], 1.0) * (number / len(every) - 0.5)
        axes.errorbar(
            times + apart,
            series.change,
            SURE * np.nan_to_num(series.change_sigma),
            fmt=MARKS[number % len(MARKS)],
            linestyle="-" if series.is_changing else "none",
            markersize=3.0,
            elinewidth=0.6,
            color=colour,
            alpha=1.0 if series.is_changing else 0.45,
            zorder=3 if series.is_changing else 2,
            label=_element_words(series, every),
        )
    axes.set_ylabel(readable_unit(every[0].unit))
    changing = ", ".join(series.name.removeprefix(f"{series.effect}:") for series in every if series.is_changing)
    axes.set_title(f"{every[0].effect}: {changing} changes" if changing else every[0].effect)
    if len(every) > 1:
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), borderaxespad=0.2, handlelength=0.8, labelspacing=0.2)


def _watches(found: Trend, series: Series) -> list[Watch]:
    return [
        each
        for each in found.watches
        if each.what in (series.label, series.effect) and each.parameter in (None, series.parameter)
    ]


def _limit(axes: Axes, watch: Watch, signs: tuple[float, ...], name: str = "") -> None:
    for level, style, word in ((watch.limit, "--", "limit"), (watch.alarm, "-", "alarm")):
        for sign in signs if level is not None else ():
            axes.axhline(sign * float(level or 0.0), color=LIMIT_COLOUR, linestyle=style, linewidth=0.9)
            axes.annotate(
                f"{word} {name}".strip(),
                (0.0, sign * float(level or 0.0)),
                xycoords=("axes fraction", "data"),
                xytext=(3, 2),
                textcoords="offset points",
                color=LIMIT_COLOUR,
            )


def _change_points(axes: Axes, found: Trend, series: Series, colour: str) -> None:
    """Mark where one line of time ends and the next begins, midway between two records."""
    for each in found.segments.get(series.name, [])[1:]:
        times = _days(found)
        axes.axvline(float(np.mean(times[each.first - 1 : each.first + 1])), color=colour, linestyle=":", linewidth=1.0)


def _element_words(series: Series, every: list[Series]) -> str:
    """Return what tells one value of an effect from the others: element, parameter or both."""
    element = series.label.removeprefix(series.effect).lstrip(":")
    several = len({each.parameter for each in every}) > 1
    return " ".join(filter(None, (element, series.parameter if several else "")))


def _days(found: Trend) -> NDArray[np.float64]:
    """Return the times of the records as matplotlib has them, days."""
    dates: Any = matplotlib.dates
    return np.asarray(dates.date2num([each.measured for each in found.dated]), float)


def _date_axis(axes: Axes, most: int = 13) -> None:
    dates: Any = matplotlib.dates
    locator = dates.AutoDateLocator(minticks=3, maxticks=most)
    axes.xaxis.set_major_locator(locator)
    axes.xaxis.set_major_formatter(dates.ConciseDateFormatter(locator))
    axes.tick_params(axis="x", labelbottom=True)
