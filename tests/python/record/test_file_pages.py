"""The pages on machine, plan and measurement files hold the keys of the models that validate the files."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hexdbb.files.validation import FileModel, parse_toml
from hexdbb.machine import MachineFile
from hexdbb.plan import Plan
from hexdbb.record.file_pages import PAGES, key_tables, main, updated

DOCS = Path(__file__).parents[3] / "docs"


@pytest.mark.parametrize("name", PAGES)
def test_committed_page_has_the_keys_of_the_code(name: str) -> None:
    page = (DOCS / name).read_text(encoding="utf-8")
    assert page == updated(page, PAGES[name]), "run `python -m hexdbb.record.file_pages docs`"


@pytest.mark.parametrize("name", PAGES)
def test_every_key_has_a_meaning_of_its_own(name: str) -> None:
    rows = [line for line in key_tables(PAGES[name]).splitlines() if line.startswith("| `")]
    assert len(rows) > 20
    assert [row for row in rows if len(row.strip("| ").split(" | ")[-1]) < 10] == []


@pytest.mark.parametrize("name", PAGES)
def test_the_file_shown_is_valid(name: str) -> None:
    model = PAGES[name]
    assert issubclass(model, FileModel)
    (shown,) = re.findall(r"^```toml\n(.*?)^```$", (DOCS / name).read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)
    parse_toml(shown, model, name)


def test_the_plan_shown_has_the_sweeps_its_page_counts() -> None:
    page = (DOCS / "plan-file.md").read_text(encoding="utf-8")
    (shown,) = re.findall(r"^```toml\n(.*?)^```$", page, flags=re.MULTILINE | re.DOTALL)
    assert "2 · 2 · 2 sweeps" in page
    assert len(parse_toml(shown, Plan, "plan").runs()) == 2 * 2 * 2


def test_limits_and_defaults_are_stated() -> None:
    tables = key_tables(MachineFile)
    assert "| `gauge_node` | whole number, ≥ 1, ≤ 127 | `7` |" in tables
    assert "| `inradius_mm` | number, > 0 | required |" in tables
    assert tables.index("### `[can]`") < tables.index("### `[can.limits]`")


def test_pages_are_rewritten_in_their_folder(tmp_path: Path) -> None:
    for name in PAGES:
        text = (DOCS / name).read_text(encoding="utf-8")
        (tmp_path / name).write_text(text.replace("| required |", "| old |"), encoding="utf-8")
    main(tmp_path)
    assert {(tmp_path / name).read_text("utf-8") == (DOCS / name).read_text("utf-8") for name in PAGES} == {True}
    with pytest.raises(ValueError, match="once each"):
        updated("a page without markers", Plan)
