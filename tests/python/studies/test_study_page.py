"""The page on studies has the keys of the study file, and shows files that are valid."""

from __future__ import annotations

import re
from pathlib import Path

from hexdbb.files.validation import parse_toml
from hexdbb.studies.file import StudyFile, load_study, shipped_studies
from hexdbb.studies.file_page import PAGE, main, updated
from hexdbb.studies.kinds import KINDS

DOCS = Path(__file__).parents[3] / "docs"


def test_committed_page_has_the_keys_of_the_study_file(tmp_path: Path) -> None:
    page = (DOCS / PAGE).read_text(encoding="utf-8")
    assert page == updated(page), "run `python -m hexdbb.studies.file_page docs`"
    (tmp_path / PAGE).write_text(page.replace("| `rate_hz` |", "| `rate` |"), encoding="utf-8")
    main(tmp_path)
    assert (tmp_path / PAGE).read_text(encoding="utf-8") == page


def test_the_study_file_shown_is_valid_and_every_study_is_told_of() -> None:
    page = (DOCS / PAGE).read_text(encoding="utf-8")
    (shown,) = re.findall(r"^```toml\n(.*?)^```$", page, flags=re.MULTILINE | re.DOTALL)
    assert parse_toml(shown, StudyFile, PAGE).power.effects == ("backlash", "straightness")
    for name in KINDS:
        assert f"hexdbb study {name}" in page


def test_shipped_studies_are_valid() -> None:
    assert shipped_studies() == ["standard"]
    assert load_study("standard").cases == 200
