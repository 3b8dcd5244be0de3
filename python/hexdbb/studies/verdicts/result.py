"""What the rows of a verdict study say: rates beside their goals, and the operating curves."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hexdbb.errors import InputError
from hexdbb.files.validation import read_text
from hexdbb.studies.rates import share
from hexdbb.studies.setting import Setting
from hexdbb.studies.study import Result, Row, Sheet, percent
from hexdbb.studies.verdicts.outcome import NAMED
from hexdbb.studies.verdicts.page import goals, is_single, page

Line = dict[str, Any]


def result(setting: Setting, rows: Sequence[Row]) -> Result:
    """Return the rates of right and of false verdicts."""
    return result_of([json.loads(each["line"]) for each in rows])


def result_of(lines: Sequence[Line]) -> Result:
    """Return what result lines say, as `line_of` makes them."""
    from hexdbb.studies.verdicts.picture import curves_figure

    tried = [each for each in lines if "outcome" in each]
    single = [each for each in tried if is_single(each) and not each["withheld"]]
    right = percent(share(sum(each["outcome"] in NAMED for each in tried), len(tried)), 0)
    false = percent(share(sum(each["outcome"] == "false" for each in tried), len(tried)))
    answer = (
        f"{len(tried)} cases: right {right[0]} % ({right[1]} %), a false name {false[0]} % ({false[1]} %);"
        f" {len(lines) - len(tried)} left out: no machine in use has a fault so large",
    )
    sheet = Sheet("rates, with 95 % intervals", ("what", "goal", "measured"), tuple(goals(tried)), names=3)
    return Result(answer, (sheet,), lambda: curves_figure(single))


def page_of_rows(rows: Sequence[Row], failed: int, picture: str, command: str) -> str:
    """Return the page of a study's rows, as Markdown."""
    return page([json.loads(each["line"]) for each in rows], failed, picture, command)


def read_lines(path: Path) -> list[Line]:
    """Return result lines of a file, one JSON object a line.

    Raises
    ------
    InputError
        There is no such file, or a line is no result.
    """
    found = []
    for number, text in enumerate(read_text(path).splitlines(), start=1):
        try:
            line = json.loads(text)
        except ValueError:
            line = None
        if not isinstance(line, dict) or "case" not in line:
            raise InputError(f"{path}: line {number}: not a result (expected a JSON object with a case)")
        found.append(line)
    return found
