from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from hexdbb.errors import InputError
from hexdbb.importing import mapping_of, read_measured
from hexdbb.record import Record

FOLDER = Path(__file__).parents[2] / "data" / "imports"

Read = Callable[..., Record]


def imported(name: str | Path, said: list[str] | None = None, **choices: Any) -> Record:
    """Read a file of `tests/data/imports`, on the thesis' circle where nothing else is chosen."""
    choices = {"plan": "thesis", **choices}
    return read_measured(FOLDER / name, mapping_of(**choices), (said if said is not None else []).append)


def refusal(name: str | Path, **choices: Any) -> str:
    """Return the one line with which a file is refused, its folder left out."""
    with pytest.raises(InputError) as caught:
        imported(name, **choices)
    assert "\n" not in str(caught.value)
    return str(caught.value).removeprefix(f"{FOLDER}/")


@pytest.fixture(scope="session")
def source() -> Record:
    return read_measured(FOLDER / "source.csv")
