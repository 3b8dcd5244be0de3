"""A trend as text: what is beyond its limit first, then what changes, then every record."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from hexdbb.trend.limits import Exceeded, judged
from hexdbb.trend.segments import Segment
from hexdbb.trend.series import Series
from hexdbb.trend.trend import DAYS_A_MONTH, Trend
from hexdbb.units import readable_unit


def trend_text(found: Trend) -> Group:
    """Return a trend as a terminal shows it."""
    return Group(*_parts(found))


def exceeded_sentence(found: Trend, each: Exceeded) -> str:
    """Return what is beyond its limit, since when, and its value now."""
    unit, series = readable_unit(each.series.unit), each.series
    what = f"change of {series.name}" if each.watch.change else series.name
    grade = f"ALARM, beyond {each.watch.alarm:g} {unit}" if each.is_alarm else "beyond its limit"
    value, sigma = judged(series, each.watch.change)
    month = found.dated[each.first].month
    when = f"since {month}" if each.last == len(found.dated) - 1 else f"from {month} to {found.dated[each.last].month}"
    return (
        f"{what}: {grade}: beyond {each.watch.limit:g} {unit} {when} ({_shown(value[each.first], sigma[each.first])}),"
        f" last {_shown(value[each.last], sigma[each.last])} {unit}"
    )


def change_sentence(found: Trend, series: Series) -> str:
    """Describe in a sentence how a value changes: its slopes and jumps in order of time."""
    unit = readable_unit(series.unit)
    values, sigma = (series.value, series.sigma) if series.is_known else (series.change, series.change_sigma)
    whole = f"{_shown(values[0], sigma[0])} to {_shown(values[-1], sigma[-1])} {unit}"
    if not series.is_known:
        whole = f"{_shown(values[-1], sigma[-1])} {unit} since {found.dated[0].month}"
    lines = found.segments.get(series.name, [])
    return f"{series.name}: {whole}; " + "; ".join(_line(found, each, unit) for each in lines)


def _parts(found: Trend) -> Iterator[RenderableType]:
    first, last = found.dated[0], found.dated[-1]
    name = first.record.machine.name
    if len(found.dated) == 1:
        yield Text(f"{name}: 1 record, {first.measured:%Y-%m-%d}: no change can be seen (expected two records or more)")
    else:
        yield Text(f"{name}: {len(found.dated)} records, {first.measured:%Y-%m-%d} to {last.measured:%Y-%m-%d}")
    for each in found.exceeded:
        yield Text(exceeded_sentence(found, each), style="bold red")
    if not found.exceeded:
        yield Text("nothing is beyond a limit" if found.is_watched else "no limit is set")
    yield from _changes(found)
    yield _table(found)
    yield from (Text(f"note: {each}") for each in found.notes)


def _changes(found: Trend) -> Iterator[Text]:
    others = len({each.label for each in found.series if each.effect and not each.is_changing})
    if found.changing:
        yield Text("changing:")
        for each in found.changing:
            yield Text("  " + change_sentence(found, each))
    for change in found.found:
        if change.rivals:
            yield Text(f"  {change.changing.label} may as well be {', '.join(change.rivals)}")
    if len(found.dated) > 1:
        more = ("else ", "other ") if found.changing else ("", "")
        yield Text(f"nothing {more[0]}changes: {others} {more[1]}elements keep one value in all records")


def _line(found: Trend, segment: Segment, unit: str) -> str:
    begin, end = found.dated[segment.first].month, found.dated[segment.last].month
    rate = f"{segment.slope * DAYS_A_MONTH:+.2g} {unit} a month" if segment.slope else "constant"
    return f"{rate} from {begin} to {end}"


def _table(found: Trend) -> Table:
    quantities = [each for each in found.series if not each.effect]
    table = Table(box=None, header_style="", pad_edge=False)
    table.add_column("measured")
    for each in (*quantities, *found.changing):
        shown = each.name if each.is_known else f"{each.name}, change"
        table.add_column(f"{shown}\n{readable_unit(each.unit)}", justify="right")
    table.add_column("residual\nµm RMS", justify="right")
    for number, dated in enumerate(found.dated):
        cells = [_number(each.value[number]) for each in quantities]
        for each in found.changing:
            value, sigma = (each.value, each.sigma) if each.is_known else (each.change, each.change_sigma)
            cells.append(_shown(value[number], sigma[number]))
        table.add_row(f"{dated.measured:%Y-%m-%d}", *cells, f"{found.residual_um[number]:.2f}")
    return table


def _number(value: float) -> str:
    return "-" if np.isnan(value) else f"{value:.1f}"


def _shown(value: float, sigma: float) -> str:
    return _number(value) if np.isnan(sigma) else f"{value:.2f} ± {sigma:.2f}"
