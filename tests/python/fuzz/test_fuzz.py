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


@pytest.mark.parametrize("chosen", FORMATS, ids=lambda chosen: chosen.name)
def test_damaged_file_is_accepted_or_refused_with_one_line(chosen: Format) -> None:
    good = (good_folder() / chosen.file).read_bytes()
    outcomes = [
        outcome_of(chosen, chosen.input(good, random.Random(f"{chosen.name} {number}")))
        for number in range(SLOW.get(chosen.name, INPUTS))
    ]
    assert [outcome.text for outcome in outcomes if outcome.kind == FAILED] == []


@pytest.mark.parametrize("path", sorted(FOUND.iterdir()), ids=lambda path: path.name)
def test_input_that_once_failed_is_accepted_or_refused_with_one_line(path: Path) -> None:
    chosen = next(each for each in FORMATS if each.slug == path.name.partition(".")[0])
    outcome = outcome_of(chosen, path.read_bytes())
    assert outcome.kind != FAILED, outcome.text
