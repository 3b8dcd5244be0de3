"""The page of a report: tables and charts put into the templates.

Jinja escapes every value that is put into HTML; charts are SVG that was escaped when it was made (`drawings.svg`), and
embedded numbers are numbers only. The page forbids itself to fetch anything (Content-Security-Policy).
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from markupsafe import Markup

from hexdbb import __version__
from hexdbb.charts.colours import STYLE, resolved
from hexdbb.charts.lines import NEAR_DEG, quantity_rows
from hexdbb.comparison import UM_PER_MM, CircleComparison, iso230
from hexdbb.contributions import RecordContributions
from hexdbb.files.atomic_file import write_text
from hexdbb.ledger.words import deed
from hexdbb.model.tables import sigma_shown
from hexdbb.predictors import LEAST_SHARE
from hexdbb.predictors.sentence import sentence as predictor_words
from hexdbb.reporting.conditions import condition_rows
from hexdbb.reporting.drawings import fall_svg, polar_svg, predictor_svg, scale_of, unrolled_svg
from hexdbb.reporting.numbers import samples_csv
from hexdbb.reporting.templating import environment, source, style
from hexdbb.units import readable_unit

if TYPE_CHECKING:
    from hexdbb.reporting.report import Report

MOST_PREDICTORS = 12
"""Predictors listed: those below explain a part of what the ones above explain."""
DRAWN_PREDICTORS = 4
"""Predictors drawn: as many as stand side by side."""

SMALLEST_PT = 8.1
"""Text in the charts that stand side by side on paper, points: 8 is the least that is read at arm's length."""
POLAR_MM, UNROLLED_MM = 57.0, 69.0
"""Their widths on paper, as the style sheet has them: with the table beside them as wide as A4 less its margins."""
APART_ON_PAPER_DEG = 10.0
"""Reversals nearer than this share one name there: a digit takes nine degrees."""
PT_PER_MM = 72.0 / 25.4


def write_page(report: Report, path: Path) -> None:
    """Write the page, whole or not at all; `RunError` where it cannot be written."""
    write_text(path, page_html(report))


def page_html(report: Report, *, for_paper: bool = False) -> str:
    """Return the page as HTML.

    Parameters
    ----------
    report : Report
    for_paper : bool
        Without what paper cannot do: script, controls, embedded numbers.
    """
    template = environment().get_template("report.html")
    return template.render(**_content(report, _Charts(for_paper)), for_paper=for_paper)


class _Charts:
    """Puts charts into a page; on paper each has its style inside, because WeasyPrint keeps a page's from them."""

    def __init__(self, for_paper: bool) -> None:
        self.for_paper = for_paper
        self._style = resolved(source("charts.css")) if for_paper else ""

    def put(self, svg: str, width_mm: float = 0.0) -> Markup:
        """Return a chart as HTML; its text is of `SMALLEST_PT` where it is stated how wide it stands on paper."""
        if not self.for_paper:
            return Markup(svg)
        return Markup(svg.replace("<title>", f"<style>{self._style}{_text_style(svg, width_mm)}</style><title>", 1))


def _text_style(svg: str, width_mm: float) -> str:
    """Return the rule for a chart's text on paper; WeasyPrint heeds the size of a ``font`` alone."""
    if not width_mm:
        return ""
    units = float(svg.partition('viewBox="')[2].partition('"')[0].split()[2])
    size = SMALLEST_PT * units / (width_mm * PT_PER_MM)
    return f'svg text,svg text.name{{font:{size:.2f}px "Liberation Sans","DejaVu Sans",sans-serif}}'


def _content(report: Report, charts: _Charts) -> dict[str, Any]:
    comparison, lack = report.comparison, report.sufficiency.lack_of_fit
    records = report.samples.records
    meant = () if comparison.cause is None else comparison.cause.subjects
    several = len(records) > 1
    found = [each for each in comparison.predictors if each.share > LEAST_SHARE][:MOST_PREDICTORS]
    drawn = [each for each in found if each.profiles and not each.is_bystander][:DRAWN_PREDICTORS]
    return {
        "style": style(),
        "script": Markup(source("report.js")),
        "colours": STYLE,
        "title": f"Circular test of {records[-1].machine.name}",
        "version": __version__,
        "edition": iso230.EDITION,
        "verdict": report.verdict,
        "passes": None if not report.judged else all(each.passes for each in report.judged),
        "judged": report.judged,
        "several": several,
        "conditions": [condition_rows(record) for record in records],
        "radial": comparison.radial,
        "tables": report.contributions.records,
        "bars": [_bars(table) for table in report.contributions.records],
        "changes": _changes(report.contributions.records) if several else [],
        "steps": [(step, deed(step)) for step in report.model.ledger],
        "fall": charts.put(fall_svg(report.model.ledger, lack.noise_um)) if report.model.ledger else "",
        "sufficiency": report.sufficiency.sentence,
        "circles": [_circle(circle, several, meant, charts) for circle in _ranked(comparison.circles)],
        "mounts": comparison.fitted_mounts,
        "cause": comparison.cause,
        "predictors": [(each, predictor_words(each)) for each in found],
        "predictor_charts": [(each.variable, charts.put(predictor_svg(each))) for each in drawn],
        "values": _values(report),
        "rank": report.rank,
        "value_count": report.values,
        "unidentifiable": report.unidentifiable,
        "next_steps": report.next_steps,
        "csv": [(Path(each.name).stem, Markup(samples_csv(comparison, place))) for place, each in enumerate(records)],
    }


def _ranked(circles: tuple[CircleComparison, ...]) -> list[CircleComparison]:
    """Return the circles record by record, those with the largest circular deviation first."""
    key = "bidirectional_circular_deviation"
    names = list(dict.fromkeys(each.record_name for each in circles))

    def size(circle: CircleComparison) -> float:
        found = [
            part.measured_quantities[key] or part.measured_quantities["circular_deviation"] or 0.0
            for part in circle.directions
        ]
        return max(found)

    return sorted(circles, key=lambda each: (names.index(each.record_name), -size(each)))


def _circle(circle: CircleComparison, several: bool, meant: tuple[str, ...], charts: _Charts) -> dict[str, Any]:
    record = f"{circle.record_name}, " if several else ""
    scale = scale_of(circle)
    return {
        "division_um": scale.division_um,
        "magnification": scale.magnification,
        "name": f"{record}circle {circle.circle.id} at {circle.feed_mm_min:g} mm/min",
        "rms_um": UM_PER_MM * circle.rms_mm,
        "centre_um": None if circle.set_up_centre_mm is None else UM_PER_MM * circle.set_up_centre_mm,
        "polar": charts.put(polar_svg(circle, meant), POLAR_MM),
        "unrolled": charts.put(
            unrolled_svg(circle, meant, APART_ON_PAPER_DEG if charts.for_paper else NEAR_DEG), UNROLLED_MM
        ),
        "rows": list(quantity_rows(circle)),
        "platform": "/".join(f"{each + 0.0:g}" for each in circle.circle.platform_rpy_deg),
        "plane": "/".join(f"{each + 0.0:g}" for each in circle.circle.plane_rpy_deg),
    }


def _bars(table: RecordContributions) -> list[dict[str, Any]]:
    """Return the rows of a table of contributions with the length of their bars, per cent of the longest."""
    rows = [*table.rows, *((table.not_explained,) if table.not_explained else ())]
    longest = max((each.circular_deviation_um + each.sigma_um for each in rows), default=1.0) or 1.0
    return [
        {
            "rank": rank if each.parts else "",
            "each": each,
            "length": 100.0 * each.circular_deviation_um / longest,
            "sigma": 100.0 * each.sigma_um / longest,
        }
        for rank, each in enumerate(rows, start=1)
    ]


def _changes(tables: tuple[RecordContributions, ...]) -> list[tuple[str, list[float | None]]]:
    """Return the circular deviation of every circle and feed in each record."""
    by_circle = [dict(zip(table.circles, table.measured_by_circle_um, strict=True)) for table in tables]
    circles = sorted({circle for each in by_circle for circle in each})
    return [
        (f"circle {circle} at {feed:g} mm/min", [each.get((circle, feed)) for each in by_circle])
        for circle, feed in circles
    ]


def _values(report: Report) -> list[tuple[str, str, str, str, str, str]]:
    columns, parameters = report.model.columns(), report.model.parameters()
    rows = []
    for row, parameter in zip(np.arange(len(parameters)), parameters, strict=True):
        if not columns["free"][row] and columns["value"][row] == 0.0:
            continue
        places = ".2f" if parameter.shape is None else ".4g"
        sigma = {"~": "only in combination", "held": "held"}.get(shown := sigma_shown(columns, row, places), shown)
        unit = readable_unit(str(columns["unit"][row]))
        value = f"{columns['value'][row]:{places}}"
        rows.append((parameter.effect, parameter.element, parameter.name, value, sigma, unit))
    return rows
