"""The glossary lists the columns that a table of samples has, with what the engine states of them."""

from __future__ import annotations

import re
from pathlib import Path

from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb.samples.column_page import BEGIN, OWN, column_table, main, updated

GLOSSARY = Path(__file__).parents[3] / "docs" / "glossary.md"


def test_committed_page_has_the_columns_of_the_code() -> None:
    page = GLOSSARY.read_text(encoding="utf-8")
    assert page == updated(page), "run `python -m hexdbb.samples.column_page docs/glossary.md`"


def test_every_column_of_a_table_is_listed_with_its_shape(record: Record) -> None:
    samples = Samples.of([record])
    rows = re.findall(r"^\| `(\w+)` \| \(n,(?: (\d))?\)", column_table(), flags=re.MULTILINE)
    assert {name: (int(width),) if width else () for name, width in rows} == {
        name: samples[name].shape[1:] for name in samples.column_names
    }


def test_own_columns_are_none_of_the_engine() -> None:
    assert column_table().count("`record`") == 1
    assert all(column_table().count(f"| `{name}` |") == 1 for name in OWN)


def test_main_rewrites_a_stale_table(tmp_path: Path) -> None:
    page = GLOSSARY.read_text(encoding="utf-8")
    stale = tmp_path / "glossary.md"
    stale.write_text(page.replace("| `time_s` | (n,) | s |", "| `time_s` | (n,) | h |"), encoding="utf-8")
    assert BEGIN in page
    main(stale)
    assert stale.read_text(encoding="utf-8") == page
