"""A ball at several places of the platform within one mount: how its holder is turned is fitted."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from hexdbb.cli.diagnose import command
from hexdbb.diagnosis import Diagnosis, diagnose
from hexdbb.discovery import discover
from hexdbb.identifiability import plan_sensitivity
from hexdbb.model import Model, Parameter, load_model, new_model
from hexdbb.plan import Plan, ball_places_sentences
from hexdbb.record import Record, write_record
from hexdbb.rig.truth import random_truth
from hexdbb.samples import Samples
from hexdbb.samples.places import with_places_free
from hexdbb_truth.plans import discovery_plan
from hexdbb_truth.simulate import Pace, simulate

TURN = "ball_rotation"
TURN_RAD = 4e-3
PACE = Pace(rate_hz=2.0, instants_per_sample=8, travel_s=1.0)
APART_MM = ((0.0, 0.0), (6.0, 0.0), (0.0, -6.0))


def several_places() -> Plan:
    """Return the standard circles, one lap each, the ball at three places of the platform by turns."""
    plan = discovery_plan().model_copy(update={"laps": 1})
    circles = []
    for number, circle in enumerate(plan.circles):
        apart, (x, y, z) = APART_MM[number % len(APART_MM)], circle.ball_offset_mm
        circles.append(circle.model_copy(update={"ball_offset_mm": (x + apart[0], y + apart[1], z)}))
    return plan.model_copy(update={"circles": tuple(circles)})


def turned(ball_mm: tuple[float, float, float], angle_rad: float) -> tuple[float, float, float]:
    """Return a place of the ball turned about the platform's z."""
    (x, y, z), c, s = ball_mm, np.cos(angle_rad), np.sin(angle_rad)
    return float(c * x - s * y), float(s * x + c * y), z


@pytest.fixture(scope="module")
def record() -> Record:
    """Return a record whose ball truly sat at turned places, and which states those that were planned."""
    plan = several_places()
    true = [each.model_copy(update={"ball_offset_mm": turned(each.ball_offset_mm, TURN_RAD)}) for each in plan.circles]
    driven = simulate(random_truth(11), plan.model_copy(update={"circles": tuple(true)}), pace=PACE)
    return replace(driven, circles=plan.circles)


@pytest.fixture(scope="module")
def diagnosis(record: Record) -> Diagnosis:
    return diagnose(Samples.of([record]), new_model(record.machine), check_held_out=False)


def value(model: Model, name: str) -> tuple[float, float]:
    (place,) = [k for k, each in enumerate(model.parameters()) if (each.effect, each.name) == (TURN, name)]
    return float(model.values[place]), float(model.sigma[place])


def test_the_turn_is_found(diagnosis: Diagnosis) -> None:
    found, sigma = value(diagnosis.model, "about_z")
    assert abs(found - TURN_RAD) < 4.0 * sigma < TURN_RAD
    assert not diagnosis.sufficiency.matters


def test_nothing_else_is_missing(record: Record) -> None:
    found = discover(Samples.of([record]), new_model(record.machine), known_only=True)
    assert found.verdict == "none"
    assert found.base.term(TURN) is not None


def test_a_ball_at_one_place_has_no_turn(record: Record) -> None:
    one = replace(record, circles=tuple(discovery_plan().circles))
    model = new_model(record.machine)
    assert with_places_free([one], model) is model


def test_mounts_are_counted_apart(record: Record) -> None:
    """The ball elsewhere in each of two fixings is two offsets, no turn."""
    model = new_model(record.machine)
    first, other = (
        replace(record, circles=tuple(each.model_copy(update={"ball_offset_mm": place}) for each in record.circles))
        for place in ((0.0, 0.0, 60.0), (35.0, 0.0, 60.0))
    )
    assert with_places_free([first, other], model) is model


def test_what_is_held_stays_held(record: Record, diagnosis: Diagnosis) -> None:
    geometry = new_model(record.machine, ["leg_length", "slider_offset"])
    assert with_places_free([record], geometry).term(TURN) is None
    held = diagnosis.model.with_free(
        np.array([each.effect != TURN and is_free for each, is_free in _free(diagnosis.model)])
    )
    assert with_places_free([record], held) is held


@pytest.mark.parametrize("options", [(), ("--minimal",), ("--fix", "ball_offset")])
def test_the_command_writes_a_model_with_the_turn(record: Record, tmp_path: Path, options: tuple[str, ...]) -> None:
    write_record(record, tmp_path / "record.parquet")
    line = [str(tmp_path / "record.parquet"), "-m", str(tmp_path / "model.toml"), *options]
    # The second time the model has the turn already, and what was held by an option is free again.
    for _ in range(2):
        assert CliRunner().invoke(command, line, catch_exceptions=False).exit_code == 0
        model = load_model(tmp_path / "model.toml")
        assert abs(value(model, "about_z")[0] - TURN_RAD) < 0.1 * TURN_RAD
        assert model.free[[each.effect in (TURN, "ball_offset") for each in model.parameters()]].all()


def _free(model: Model) -> list[tuple[Parameter, bool]]:
    return list(zip(model.parameters(), model.free, strict=True))


def test_a_plan_is_judged_with_the_turn(record: Record) -> None:
    plan = several_places()
    assert plan_sensitivity(plan, new_model(record.machine), 2.0).model.term(TURN) is not None
    (sentence,) = ball_places_sentences("plan.toml", plan.mounts, plan.circles)
    assert sentence.startswith("plan.toml: mount 0 has its ball at 3 places of the platform (ball_offset_mm): ")
    level = discovery_plan()
    assert plan_sensitivity(level, new_model(record.machine), 2.0).model.term(TURN) is None
    assert list(ball_places_sentences("plan.toml", level.mounts, level.circles)) == []
