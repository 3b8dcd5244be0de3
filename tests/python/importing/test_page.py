"""The page on imports holds the tables of the code, shows a valid mapping file, and names headings that are read."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hexdbb.files.validation import parse_toml
from hexdbb.importing.file_page import HEADINGS, PAGE, main, updated
from hexdbb.importing.mapping import Mapping
from hexdbb.importing.quantities import QUANTITIES, UNITS_OF, known_unit, recognised

DOCS = Path(__file__).parents[3] / "docs"


def test_committed_page_has_the_tables_of_the_code(tmp_path: Path) -> None:
    page = (DOCS / PAGE).read_text(encoding="utf-8")
    assert page == updated(page), "run `python -m hexdbb.importing.file_page docs`"
    (tmp_path / PAGE).write_text(page.replace("| `sheet` |", "| `leaf` |"), encoding="utf-8")
    main(tmp_path)
    assert (tmp_path / PAGE).read_text(encoding="utf-8") == page


def test_the_mapping_file_shown_is_valid() -> None:
    (shown,) = re.findall(r"^```toml\n(.*?)^```$", (DOCS / PAGE).read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)
    assert parse_toml(shown, Mapping, PAGE).columns["time"] == ""


@pytest.mark.parametrize("quantity", HEADINGS)
def test_headings_of_the_page_are_recognised(quantity: str) -> None:
    heads = re.sub(r"the same with |; .*", "", HEADINGS[quantity]).split(", ")
    for head in heads:
        own = f"{head} deviation" if quantity.startswith("reading_") else head
        assert recognised(own)[0] == quantity, head
        for unit in UNITS_OF[quantity]:
            assert recognised(f"{own} [{unit}]") == (quantity, unit)


def test_every_quantity_is_on_the_page() -> None:
    assert set(HEADINGS) | {f"s{k}" for k in range(2, 7)} == set(QUANTITIES)


@pytest.mark.parametrize(
    ("heading", "expected"),
    [
        ("feed_mm_min", ("feed", "mm/min")),
        ("Winkel in Grad", ("angle", "deg")),
        ("Deviation / µm", ("reading", "um")),
        ("Radial error (Inch)", ("reading", "in")),
        ("Gegen Uhrzeigersinn [μm]", ("reading_ccw", "um")),
        ("Run direction (CW/CCW)", ("direction", None)),
        ("CCW angle, °", ("angle", "deg")),
        ("Temperature (°C)", ("temperature", "C")),
        ("s3_mm", ("s3", "mm")),
        ("Operator", (None, None)),
        ("Remark", (None, None)),
    ],
)
def test_headings_of_many_programs(heading: str, expected: tuple[str | None, str | None]) -> None:
    assert recognised(heading) == expected


def test_unit_spellings() -> None:
    assert [known_unit(each) for each in ("µm", "μm", "Microns", "°", "Grad", "mm/min", "parsec")] == [
        *("um", "um", "um", "deg", "deg", "mm/min"),
        None,
    ]
