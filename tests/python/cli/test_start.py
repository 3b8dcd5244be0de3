"""What commands load before they work: nothing that only others need."""

from __future__ import annotations

import subprocess
import sys

import pytest

LATER = ("scipy", "matplotlib", "pandas", "pyarrow.compute", "pyarrow.dataset")
"""Each takes a tenth of a second or more to import."""


@pytest.mark.parametrize("command", ["diagnose", "compare", "report", "discover"])
def test_a_command_starts_without(command: str) -> None:
    lines = f"import sys, hexdbb.cli.{command}; print([each for each in {LATER!r} if each in sys.modules])"
    shown = subprocess.run([sys.executable, "-c", lines], check=True, capture_output=True, text=True).stdout
    assert shown.strip() == "[]"


def test_a_comparison_loads_the_search_for_causes_only_to_search() -> None:
    lines = "import sys, hexdbb.cli.compare; print('hexdbb.evidence' in sys.modules)"
    shown = subprocess.run([sys.executable, "-c", lines], check=True, capture_output=True, text=True).stdout
    assert shown.strip() == "False"
