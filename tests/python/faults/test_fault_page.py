"""The page of faults is the one that the command makes of today's catalogue."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.faults.catalogue import FAULTS
from tests.faults.page import HEAD, RULE

PAGE = Path(__file__).parents[3] / "docs" / "fault-table.md"


def rows(title: str) -> list[list[str]]:
    """Return the cells of the table below a title; none if the page has no such table."""
    section = PAGE.read_text(encoding="utf-8").partition(f"\n## {title}\n")[2].partition("\n## ")[0]
    lines = [line for line in section.splitlines() if line.startswith("|")]
    assert lines[:2] in ([HEAD, RULE], [])
    return [line.strip("| ").split(" | ") for line in lines[2:]]


def test_every_fault_of_the_catalogue_is_on_the_page() -> None:
    names = [fault.name for fault in FAULTS]
    assert [cells[0] for cells in rows("Lockstep")] == names
    assert [cells[0] for cells in rows("Real time")] in (names, [])


@pytest.mark.parametrize("title", ["Lockstep", "Real time", "Two faults at once"])
def test_no_wrong_sample_is_kept(title: str) -> None:
    column = HEAD.strip("| ").split(" | ").index("**wrong**")
    assert [cells[0] for cells in rows(title) if cells[column] != "**0**"] == []
