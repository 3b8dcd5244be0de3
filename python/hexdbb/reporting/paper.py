"""A report on A4, as PDF.

WeasyPrint (BSD licence, kept by CourtBouillon since 2011) lays the same HTML out for paper: vector charts, page
numbers, bookmarks, without a browser. It needs Pango of the system and is an extra (`hexdbb[pdf]`), so that computers
that only measure do without both.
"""

from __future__ import annotations

import logging
from pathlib import Path
from typing import TYPE_CHECKING

from hexdbb.errors import InputError
from hexdbb.files.atomic_file import replacing
from hexdbb.reporting.page import page_html

if TYPE_CHECKING:
    from hexdbb.reporting.report import Report


def require_writer() -> None:
    """Raise `InputError` where WeasyPrint, or what it needs of the system, is not installed."""
    try:
        import weasyprint  # noqa: F401
    except ModuleNotFoundError:
        raise InputError('WeasyPrint is not installed (expected it for PDF: pip install "hexdbb[pdf]")') from None
    except OSError as error:
        reason = str(error).splitlines()[0]
        raise InputError(
            f"Pango is not installed (expected it for PDF: apt install libpangoft2-1.0-0): {reason}"
        ) from None


def write_pdf(report: Report, path: Path) -> None:
    """Write a report as PDF, whole or not at all.

    Raises
    ------
    InputError
        WeasyPrint or Pango is not installed.
    RunError
        The file cannot be written.
    """
    require_writer()
    import weasyprint

    logging.getLogger("weasyprint").setLevel(logging.ERROR)
    drawn: bytes = weasyprint.HTML(string=page_html(report, for_paper=True), url_fetcher=_nothing).write_pdf()
    with replacing(path) as temporary:
        temporary.write_bytes(drawn)


def _nothing(url: str) -> dict[str, object]:
    """Refuse to fetch anything: a report holds all that it shows."""
    raise ValueError(f"{url[:40]}: a report fetches nothing")
