"""The report on A4: every part, charts in their colours."""

from __future__ import annotations

import logging

import numpy as np
import pypdfium2
import pytest
from pypdfium2.raw import FS_MATRIX, FPDFText_GetFontSize, FPDFText_GetMatrix, FPDFText_GetUnicode

from hexdbb.charts.colours import MEASURED_COLOURS
from hexdbb.errors import InputError
from hexdbb.reporting import Report, require_writer, write_pdf

A4_PT = (595.3, 841.9)
SMALLEST_PT = 7.99
"""8 points, as a PDF's single precision has them."""
MARGIN_PT = 14.0 * 72.0 / 25.4 - 1.0
"""14 mm are left white on either side."""


@pytest.fixture(scope="module")
def paper(report: Report, tmp_path_factory: pytest.TempPathFactory) -> pypdfium2.PdfDocument:
    logging.getLogger("fontTools").setLevel(logging.ERROR)
    path = tmp_path_factory.mktemp("paper") / "report.pdf"
    write_pdf(report, path)
    return pypdfium2.PdfDocument(path)


def test_pages_are_a4_and_say_everything(paper: pypdfium2.PdfDocument) -> None:
    assert all(page.get_size() == pytest.approx(A4_PT, abs=1.0) for page in paper)
    text = "".join(page.get_textpage().get_text_bounded() for page in paper)
    for heading in ("Test conditions", "Pass or fail", "Contributions, ranked", "What to measure next"):
        assert heading in text
    assert "<img src=x" in text


def test_no_text_is_too_small_and_none_leaves_the_sheet(paper: pypdfium2.PdfDocument) -> None:
    for page in paper:
        text = page.get_textpage()
        for place in range(text.count_chars()):
            if chr(FPDFText_GetUnicode(text, place)).isspace():
                continue
            turned = FS_MATRIX()
            FPDFText_GetMatrix(text, place, turned)
            size_pt = FPDFText_GetFontSize(text, place) * np.hypot(turned.c, turned.d)
            assert size_pt >= SMALLEST_PT
            left, _, right, _ = text.get_charbox(place)
            assert MARGIN_PT <= left <= right <= A4_PT[0] - MARGIN_PT


def test_both_directions_are_drawn_in_their_colours(paper: pypdfium2.PdfDocument) -> None:
    pixels = np.concatenate([np.asarray(page.render(scale=1.0).to_pil()).reshape(-1, 3) for page in paper])
    for colour in MEASURED_COLOURS.values():
        wanted = np.array([int(colour[place : place + 2], 16) for place in (1, 3, 5)])
        assert (np.abs(pixels.astype(int) - wanted).max(axis=1) < 12).sum() > 40


def test_without_its_writer_paper_is_refused_in_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "weasyprint", None)
    with pytest.raises(InputError, match="WeasyPrint is not installed"):
        require_writer()
