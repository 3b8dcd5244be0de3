"""Templates of pages that are handed over, and the style that all of them have."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from hexdbb.charts.colours import style_sheet
from hexdbb.comparison import UM_PER_MM

PACKAGE = "hexdbb.reporting"


@cache
def environment(package: str = PACKAGE) -> Environment:
    """Return what makes pages of the templates of a package, and of those here.

    Values are escaped, unknown names are errors. Filters: `um` and `mm_as_um` for lengths, `begun` for a sentence.
    """
    made = Environment(
        loader=ChoiceLoader([PackageLoader(each) for each in dict.fromkeys((package, PACKAGE))]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters["um"] = um
    made.filters["begun"] = lambda words: words[:1].upper() + words[1:]
    made.filters["mm_as_um"] = lambda value_mm: um(None if value_mm is None else UM_PER_MM * value_mm)
    return made


@cache
def source(name: str) -> str:
    """Return the text of a file among the templates."""
    return (Path(__file__).parent / "templates" / name).read_text(encoding="utf-8")


def style() -> Markup:
    """Return the style sheet of a page: colours, charts, layout."""
    return Markup(style_sheet() + source("charts.css") + source("report.css"))


def um(value: float | None, places: int = 2) -> str:
    """Return a length for people; a dash where it cannot be evaluated, no minus before zero."""
    return "–" if value is None else f"{round(value, places) + 0.0:.{places}f}"
