"""The comparison of shown and printed text notices what it should."""

from __future__ import annotations

import pytest
from tests.documents.printed import first_difference


@pytest.mark.parametrize(
    ("shown", "printed"),
    [
        (["rms 0.50 µm"], ["rms  0.51 µm"]),
        (["first", "...", "last"], ["first", "a", "b", "last"]),
        (["one", "..."], ["one"]),
        (["pictures: a.png, ..."], ["pictures: a.png, b.png"]),
        (["run 1/2  0.17 ms/cycle, 0 missed"], ["run 1/2  0.42 ms/cycle, 0 missed"]),
        (["gain 345,578"], ["gain 345,912"]),
    ],
)
def test_same(shown: list[str], printed: list[str]) -> None:
    assert first_difference(shown, printed) is None


@pytest.mark.parametrize(
    ("shown", "printed"),
    [
        (["rms 0.50 µm"], ["rms 0.55 µm"]),
        (["rms 0.50 um"], ["rms 0.50 µm"]),
        (["first", "...", "last"], ["first", "a", "b"]),
        (["one"], ["one", "two"]),
        (["rank 9 of 33"], ["rank 8 of 33"]),
        (["backlash:4"], ["backlash:5"]),
    ],
)
def test_different(shown: list[str], printed: list[str]) -> None:
    assert first_difference(shown, printed) is not None
