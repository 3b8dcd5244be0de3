"""A ball at several places of the platform within one mount: the fit warns of it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hexdbb.diagnosis import diagnose
from hexdbb.model import new_model
from hexdbb.record import Record
from hexdbb.samples import Samples, ball_places_words
from hexdbb_truth.forms.cases import case


@pytest.fixture(scope="module")
def record() -> Record:
    return case("none-calibrate-s1").record()


def moved(record: Record, count: int) -> Record:
    """Return the record with the ball of its first circles stated 10 mm apart."""
    circles = [
        each.model_copy(update={"ball_offset_mm": (10.0 * place, *each.ball_offset_mm[1:])})
        for place, each in enumerate(record.circles[:count], 1)
    ]
    return replace(record, circles=(*circles, *record.circles[count:]))


@pytest.mark.parametrize("count", [1, 2])
def test_several_places_are_counted(record: Record, count: int) -> None:
    (sentence,) = ball_places_words([moved(record, count)])
    assert f"mount 0 has its ball at {count + 1} places of the platform" in sentence
    assert "expected a mount for each place" in sentence


def test_of_one_place_nothing_is_said(record: Record) -> None:
    assert list(ball_places_words([record])) == []


def test_a_fit_warns_of_it(record: Record) -> None:
    samples = Samples.of([moved(record, 1)])
    assert any("places of the platform" in each for each in diagnose(samples, new_model(samples.machine)).warnings)
