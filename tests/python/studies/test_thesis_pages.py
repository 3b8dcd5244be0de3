"""The generated pages are those that the command writes, to the last digit but one; the pictures are there."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from hexdbb.studies.thesis.pages import PAGES, PICTURES

DOCS = Path(__file__).parents[3] / "docs"
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?")


def words_and_numbers(text: str) -> tuple[list[str], np.ndarray]:
    return NUMBER.split(text), np.array([float(each) for each in NUMBER.findall(text)])


@pytest.mark.parametrize("name", PAGES)
def test_page_is_what_the_command_writes(name: str) -> None:
    """Numbers may differ by rounding, which another processor's order of additions may tip."""
    committed_words, committed = words_and_numbers((DOCS / name).read_text(encoding="utf-8"))
    written_words, written = words_and_numbers(PAGES[name]())
    assert written_words == committed_words, "run `hexdbb thesis pages -o docs`"
    np.testing.assert_allclose(written, committed, rtol=2e-3, atol=0.011, err_msg="run `hexdbb thesis pages -o docs`")


@pytest.mark.parametrize("stem", PICTURES)
def test_picture_is_there_and_shown(stem: str) -> None:
    picture = DOCS / "images" / f"{stem}.png"
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert any(f"(images/{stem}.png)" in (DOCS / name).read_text(encoding="utf-8") for name in PAGES)


def test_every_field_of_the_words_is_filled() -> None:
    for page in PAGES.values():
        assert not re.search(r"\{\w*\}", page())
