"""The smallest detectable size of every effect, and `hexdbb plan check` that lists it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from hexdbb import _core
from hexdbb.cli.plan import command
from hexdbb.identifiability import plan_sensitivity, with_every_effect
from hexdbb.machine import shipped
from hexdbb.model import new_model
from hexdbb.plan import load_plan
from hexdbb.planning import detectable_sizes

NOISE_MM = 0.5e-3
STANDARD = load_plan("standard")
MODEL = new_model(STANDARD.machine_file())
TAKEN = plan_sensitivity(STANDARD, with_every_effect(MODEL), 250.0)


def test_a_signature_of_that_size_leaves_three_times_the_noise() -> None:
    """By plain least squares of the whole plan: what no other value explains of the signature."""
    found = detectable_sizes(TAKEN, NOISE_MM)["bar_length"]
    assert found.size is not None
    own = TAKEN.whose(lambda each: each.effect == "bar_length")
    signature_mm = TAKEN.jacobian[:, own] @ np.array([found.size / 1000.0])
    others = TAKEN.jacobian[:, TAKEN.free & ~own]
    left_mm = signature_mm - others @ np.linalg.lstsq(others, signature_mm, rcond=1e-10)[0]
    assert np.sqrt(left_mm @ left_mm / TAKEN.readings) == pytest.approx(3 * NOISE_MM, rel=1e-6)
    assert found.kept == pytest.approx(np.linalg.norm(left_mm) / np.linalg.norm(signature_mm), rel=1e-6)
    assert found.kept == pytest.approx(0.10, abs=0.005)  # effects page: bar length keeps 10 %
    assert found.unit == "um"


def test_sizes_grow_with_the_noise() -> None:
    fine, coarse = (detectable_sizes(TAKEN, noise_mm) for noise_mm in (NOISE_MM, 4 * NOISE_MM))
    for effect, each in fine.items():
        if coarse[effect].size is not None and coarse[effect].unit == each.unit:
            assert coarse[effect].size == pytest.approx(4 * each.size)
    assert coarse["leg_length"].size is not None


def test_what_no_machine_has_is_not_detectable() -> None:
    """A size beyond the limit of its value is none: circles of the bar's own length show no error of its scale."""
    limits = {
        each.effect: each.limit for each in TAKEN.parameters if each.effect in ("bar_gain", "guideway_translation")
    }
    found = detectable_sizes(TAKEN, NOISE_MM)
    assert found["bar_gain"].size is None
    assert found["guideway_translation"].size is not None
    assert found["guideway_translation"].size < 1e3 * limits["guideway_translation"]
    assert detectable_sizes(TAKEN, 4 * NOISE_MM)["guideway_translation"].size is None


def test_what_others_explain_wholly_is_never_detectable() -> None:
    found = detectable_sizes(TAKEN, NOISE_MM)
    for effect in ("guideway_rotation_centre", "guideway_rotation_xy", "cup_position"):
        assert (found[effect].size, found[effect].hardest, found[effect].kept) == (None, None, 0.0)
    # Its sliders explain a guideway moved along itself, not one moved outwards.
    assert found["guideway_translation"].size is not None
    assert found["guideway_translation"].hardest is None


def test_noise_includes_the_rounding_and_is_unknown_where_not_stated() -> None:
    gauge = STANDARD.gauge
    assert gauge.stated_noise_mm == pytest.approx(np.hypot(0.5, 0.1 / np.sqrt(12)) / 1000.0)
    assert gauge.model_copy(update={"noise_um": None}).stated_noise_mm is None
    assert gauge.model_copy(update={"noise_um": 0.0, "resolution_um": 0.0}).stated_noise_mm == 1e-6


def test_check_lists_every_effect_of_the_catalogue_and_all_that_a_plan_determines() -> None:
    done = CliRunner().invoke(command, ["check", "standard", "--json"], catch_exceptions=False)
    found = json.loads(done.stdout)
    assert found["reachable"] is True
    assert (found["rank"], found["values"]) == (21, 33)
    assert found["condition"] == pytest.approx(506, rel=0.005)
    assert list(found["detectable"]) == list(_core.effect_names())
    assert {"size", "unit"} <= set(found["detectable"]["leg_length"])
    assert len(found["minimal_set"]) == 21
    assert len(found["unidentifiable"]) == 13
    assert [each["circle"] for each in found["circles"]] == list(range(7))
    sides = [each for each in found["parameters"] if each["effect"] == "platform_side"]
    assert [(each["unit"], each["identifiable"]) for each in sides] == [("um", True)] * 3
    assert all(0.1 < each["sigma"] < 2.0 for each in sides)


def test_a_noise_that_is_not_stated_is_assumed_and_reported(tmp_path: Path) -> None:
    path = tmp_path / "plan.toml"
    path.write_text(shipped("plans", "thesis.toml").read_text().replace("noise_um = 0.5\n", ""))
    done = CliRunner().invoke(command, ["check", str(path), "--json"], catch_exceptions=False)
    assert json.loads(done.stdout)["noise_um"] == 0.5
    assert "no stated noise: 0.5 µm assumed" in done.stderr
    asked = CliRunner().invoke(command, ["check", str(path), "--json", "--noise", "2"], catch_exceptions=False)
    assert json.loads(asked.stdout)["noise_um"] == 2.0
    assert asked.stderr == ""


def test_printed_table_names_what_is_not_identifiable() -> None:
    done = CliRunner().invoke(command, ["check", "standard"], catch_exceptions=False, env={"COLUMNS": "80"})
    assert "rank 21 of 33" in done.stdout
    assert "platform_side" in done.stdout
    assert "a rigid shift of base and cup along x" in done.stdout
    assert "…" not in done.stdout


def test_check_says_where_one_mount_has_its_ball_at_several_places(tmp_path: Path) -> None:
    path = tmp_path / "plan.toml"
    text = shipped("plans", "standard.toml").read_text()
    path.write_text(text.replace("ball_offset_mm = [0.0, 0.0, 60.0]", "ball_offset_mm = [5.0, 0.0, 60.0]", 1))
    done = CliRunner().invoke(command, ["check", str(path), "--json"], catch_exceptions=False)
    assert f"{path}: mount 0 has its ball at 2 places of the platform" in done.stderr
    assert "is fitted too (ball_rotation)" in done.stderr
    assert json.loads(done.stdout)["reachable"] is True
