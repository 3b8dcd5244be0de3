"""The calibration's page holds the constants with which verdicts are reached."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

from hexdbb.evidence.criteria import DEFAULT

PAGE = Path(__file__).parents[3] / "docs" / "discovery-calibration.md"


def test_the_page_was_made_with_these_constants() -> None:
    """A constant that is changed asks for a new calibration: `make calibration`."""
    rows = re.findall(r"^\| `(\w+)` \| (.*?) \| (.+) \|$", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert {name: value for name, value, _ in rows} == {
        each.name: str(getattr(DEFAULT, each.name)) for each in fields(DEFAULT)
    }
    assert all(words for _, _, words in rows)
