"""Damaged input of every format is accepted or refused with one line: random inputs, and those that once failed.

`python -m tests.fuzz --count 10000 --seed 1` tries many more.
"""

from __future__ import annotations

import logging
import random
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.fuzz.formats import FORMATS, Format
from tests.fuzz.inputs import ACCEPTED, FAILED, good_folder, outcome_of, tidy

FOUND = Path(__file__).parents[2] / "data" / "fuzz"
"""Inputs that failed once, made small: FORMAT.NUMBER."""
SLOW = {"EDS, controller": 10, "EDS, rig": 6}
INPUTS = 40
"""Inputs of each format; those that are slow to read have fewer."""

MISSING = {
    "compensation-file-sealed.1": "a message of the engine about a file that is not UTF-8 cannot be read",
}
"""What still fails, by format or by file, with the reason."""


def case(value: object, name: str) -> object:
    """Return a case, expected to fail if something is still missing."""
    reason = MISSING.get(name)
    return pytest.param(value, id=name, marks=[pytest.mark.xfail(strict=True, reason=reason)] if reason else [])


@pytest.fixture(scope="module", autouse=True)
def good_files() -> Iterator[None]:
    """Write the good files once, keep parsers quiet, and remove the files."""
    logging.disable(logging.CRITICAL)
    yield
    logging.disable(logging.NOTSET)
    tidy()


@pytest.mark.parametrize("chosen", FORMATS, ids=lambda chosen: chosen.name)
def test_good_file_is_accepted(chosen: Format) -> None:
    outcome = outcome_of(chosen, (good_folder() / chosen.file).read_bytes())
    assert outcome.kind == ACCEPTED, outcome.text


@pytest.mark.parametrize("chosen", [case(each, each.name) for each in FORMATS])
def test_damaged_file_is_accepted_or_refused_with_one_line(chosen: Format) -> None:
    good = (good_folder() / chosen.file).read_bytes()
    outcomes = [
        outcome_of(chosen, chosen.input(good, random.Random(f"{chosen.name} {number}")))
        for number in range(SLOW.get(chosen.name, INPUTS))
    ]
    assert [outcome.text for outcome in outcomes if outcome.kind == FAILED] == []


@pytest.mark.parametrize("path", [case(path, path.name) for path in sorted(FOUND.iterdir())])
def test_input_that_once_failed_is_accepted_or_refused_with_one_line(path: Path) -> None:
    chosen = next(each for each in FORMATS if each.slug == path.name.partition(".")[0])
    outcome = outcome_of(chosen, path.read_bytes())
    assert outcome.kind != FAILED, outcome.text
