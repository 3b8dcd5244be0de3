"""The report of a circular test: one file to hand over, readable without hexdbb.

::

    found = make_report(Samples.of([record]), model)
    write_page(found, Path("report.html"))
    write_pdf(found, Path("report.pdf"))

The analysis is that of the packages below; here it is put in order, drawn and written. The page is one HTML file
without anything to be fetched. Charts are SVG made here: they print sharply, work without JavaScript, have titles for a
screen reader, and cost some 60 kB a circle, where a chart library in each file would cost a megabyte and print as
pixels. A little JavaScript adds magnification, a cursor, tables to copy and CSV to save.
"""

from hexdbb.reporting.judgement import Judged, judge, parse_tolerance
from hexdbb.reporting.page import page_html, write_page
from hexdbb.reporting.paper import require_writer, write_pdf
from hexdbb.reporting.report import Report, make_report

__all__ = [
    "Judged",
    "Report",
    "judge",
    "make_report",
    "page_html",
    "parse_tolerance",
    "require_writer",
    "write_page",
    "write_pdf",
]
