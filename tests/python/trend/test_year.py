"""Twelve months in which one play grows and one leg warms: the trend names both, since when, and nothing else."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from hexdbb.cli.schemas import json_schema
from hexdbb.machine import Watch
from hexdbb.trend import STATUS_LIMIT, dated, trend
from hexdbb_truth.months import WARM_LEG, Year

PLAY, LEG = "backlash:1", f"leg_length:{WARM_LEG}"
FORM = 0.1
"""Share of the truth by which values may differ besides their intervals: a tenth of the play is not the catalogue's
form, and the leg grows by a tenth while it is measured."""


def series(found: dict[str, Any], what: str) -> dict[str, Any]:
    return next(each for each in found["series"] if each["what"] == what)


def test_both_are_named_and_nothing_else(found: dict[str, Any]) -> None:
    assert {each["what"] for each in found["changes"]} == {PLAY, LEG}
    assert all(not each["alternatives"] for each in found["changes"])
    assert {each["what"] for each in found["series"] if each["changing"]} == {PLAY, LEG}


def test_the_months_are_those_in_which_the_truth_leaves_its_limits(found: dict[str, Any], year: Year) -> None:
    since = {each["what"]: each["since"][:7] for each in found["exceeded"]}
    play = next(month for month, size in enumerate(year.play_um) if size > 9.0)
    leg = next(month for month, size in enumerate(year.growth_um) if size > 12.0)
    assert since == {PLAY: f"2025-{play + 1:02}", LEG: f"2025-{leg + 1:02}"}


def test_values_follow_the_truth(found: dict[str, Any], year: Year) -> None:
    play, leg = series(found, PLAY), series(found, LEG)
    for one, key, truth in ((play, "value", year.play_um), (leg, "change", year.growth_um)):
        sigma = np.array(one["sigma" if key == "value" else "change_sigma"], float)
        assert (np.abs(np.array(one[key]) - truth) <= FORM * np.array(truth) + 3.0 * sigma).all()
    assert max(leg["change_sigma"]) < 0.5  # µm; the leg's length itself is known to some µm only


def test_change_points_are_where_the_truth_changes(found: dict[str, Any]) -> None:
    begins = {what: [each["since"][:7] for each in series(found, what)["segments"]] for what in (PLAY, LEG)}
    assert begins[LEG] == ["2025-01", "2025-08"]
    assert begins[PLAY][0] == "2025-01"
    assert begins[PLAY][1] in ("2025-04", "2025-05")
    assert len(begins[PLAY]) == 2
    (before, after) = series(found, PLAY)["segments"]
    assert before["per_month"] == 0.0
    assert after["per_month"] == pytest.approx(1.5, rel=FORM)  # µm


def test_the_status_is_that_of_a_limit_and_pictures_are_drawn(
    done: subprocess.CompletedProcess[str], found: dict[str, Any], glider: Path
) -> None:
    assert done.returncode == found["status"] == STATUS_LIMIT
    jsonschema.validate(found, json_schema("trend"))
    for name in ("trend.png", "trend-effects.png"):
        assert (glider / name).read_bytes().startswith(b"\x89PNG")


def test_a_machine_that_stays_as_it_is_changes_nowhere() -> None:
    still = Year(8, play_um=(6.0,) * 4, growth_um=(0.0,) * 4)
    records = [dated(each) for each in still.records()]
    watch = (Watch(what="backlash", limit=9.0, unit="um"), Watch(what="leg_length", limit=5.0, unit="um", change=True))
    found = trend(records, records[0].record.machine.model_copy(update={"watch": watch}))
    assert (found.changing, found.exceeded, found.status) == ([], (), 0)
    assert found.is_watched
