"""The report on A4: every part, charts in their colours."""

from __future__ import annotations

import logging

import numpy as np
import pypdfium2
import pytest

from hexdbb.charts.colours import MEASURED_COLOURS
from hexdbb.errors import InputError
from hexdbb.reporting import Report, require_writer, write_pdf

A4_PT = (595.3, 841.9)


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


def test_both_directions_are_drawn_in_their_colours(paper: pypdfium2.PdfDocument) -> None:
    pixels = np.concatenate([np.asarray(page.render(scale=1.0).to_pil()).reshape(-1, 3) for page in paper])
    for colour in MEASURED_COLOURS.values():
        wanted = np.array([int(colour[place : place + 2], 16) for place in (1, 3, 5)])
        assert (np.abs(pixels.astype(int) - wanted).max(axis=1) < 12).sum() > 40


def test_without_its_writer_paper_is_refused_in_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "weasyprint", None)
    with pytest.raises(InputError, match="WeasyPrint is not installed"):
        require_writer()
