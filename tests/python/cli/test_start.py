"""What commands load before they work: nothing that only others need."""

from __future__ import annotations

import subprocess
import sys

import pytest

LATER = ("scipy", "matplotlib", "pandas", "pyarrow.compute", "pyarrow.dataset", "pyarrow.csv")
"""Each takes a tenth of a second or more to import."""
NOT_DRAWN = (
    "scipy",
    "pandas",
    "fontTools.subset",
    "matplotlib.pyplot",
    "matplotlib.backends.backend_pdf",
    "hexdbb.trend",
)
"""What the first page of a comparison, a PNG, needs none of."""
ONLY_JSON = tuple(f"hexdbb.{each}.json_form" for each in ("diagnosis", "ledger", "comparison", "discovery"))
"""Declarations of what --json prints."""


def loaded_of(names: tuple[str, ...], statement: str) -> str:
    """Return which of some modules are loaded after a statement in a new interpreter, as it prints their list."""
    lines = f"{statement}; import sys; print([each for each in {names!r} if each in sys.modules])"
    return subprocess.run([sys.executable, "-c", lines], check=True, capture_output=True, text=True).stdout.strip()


@pytest.mark.parametrize("command", ["diagnose", "compare", "report", "discover"])
def test_a_command_starts_without(command: str) -> None:
    assert loaded_of(LATER, f"import hexdbb.cli.{command}") == "[]"


def test_a_comparison_loads_the_search_for_causes_only_to_search() -> None:
    assert loaded_of(("hexdbb.evidence",), "import hexdbb.cli.compare") == "[]"


@pytest.mark.parametrize("command", ["diagnose", "compare"])
def test_effects_of_ones_own_are_loaded_where_a_file_is_named(command: str) -> None:
    assert loaded_of(("hexdbb.effects.loading",), f"import hexdbb.cli.{command}") == "[]"


@pytest.mark.parametrize("command", ["diagnose", "compare"])
def test_what_json_holds_is_declared_where_it_is_printed(command: str) -> None:
    assert loaded_of(ONLY_JSON, f"import hexdbb.cli.{command}") == "[]"


def test_the_search_for_causes_declares_no_json() -> None:
    assert loaded_of(ONLY_JSON, "from hexdbb.discovery import likely_cause") == "[]"


def test_the_first_page_is_drawn_without() -> None:
    drawn = "from hexdbb.plots import comparison_pages, save_figure, save_pdf"
    assert loaded_of(NOT_DRAWN, drawn) == "[]"


def test_what_no_file_is_read_with_is_not_compiled_for_reading() -> None:
    lines = (
        "from hexdbb.importing import Mapping; from hexdbb.machine import Limits;"
        " print(Mapping.__pydantic_complete__, Limits.__pydantic_complete__)"
    )
    shown = subprocess.run([sys.executable, "-c", lines], check=True, capture_output=True, text=True).stdout
    assert shown.strip() == "False False"
