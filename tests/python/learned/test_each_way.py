"""Several functions of one state: alike both ways and times the direction's sign, or times what else there is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hexdbb.effects import draft, load_effects
from hexdbb.learned import Learned, Space
from hexdbb.model import Choice, LearnedEffect, Model, load_model, new_model, save_model
from hexdbb.plan import load_plan
from hexdbb.plots import learned_figure
from hexdbb.samples import Samples

PLAN = load_plan("thesis")
MACHINE = PLAN.machine_file()
LEAD_MM = MACHINE.sliders.screw_lead_mm
NAMES = [
    "learned:slider:4:position_each_way",
    "learned:leg:2:joint_angle_each_way",
    "learned:slider_joint:3:position_each_way",
    "learned:reading:bar_angle_each_way",
    "learned:slider_joint:6:screw_wave_position",
    "learned:leg:3:leg_in_platform",
]


@pytest.fixture(scope="module")
def planned() -> Samples:
    return Samples.planned(MACHINE, PLAN.runs(), np.arange(720) * (2.0 * np.pi / 720), 100.0)


def catches_one_way(x: np.ndarray) -> np.ndarray:
    """Return the form of a lip that catches: a ramp over a sixth of the range, and a fall."""
    part = (x - x.min()) / np.ptp(x)
    return np.clip((part - 0.5) / 0.17, 0.0, 1.0) * np.clip((0.7 - part) / 0.03, 0.0, 1.0)


def bump(x: np.ndarray) -> np.ndarray:
    """Return a form that a draft has a formula for."""
    return np.exp(-(((x - x.mean()) / (0.2 * np.ptp(x))) ** 2))


def made(planned: Samples, name: str, form: Callable[[np.ndarray], np.ndarray] = catches_one_way) -> Model:
    """Return a model with such a function, one way in each of its components, with a band."""
    space = Space.of(Learned.parse(name).finer(4), planned, LEAD_MM)
    points, effect = space.points(), LearnedEffect(space, 0.1, 0.01)
    part = space.functions(points).shape[1]
    one = np.linalg.lstsq(space.functions(points) @ effect.factor[:part, :part], form(points), rcond=None)[0]
    values = 0.005 * np.tile(one, space.hypothesis.functions)
    band = (3e-4,) * (len(points) * space.hypothesis.functions)
    effect = LearnedEffect(space, 0.1, 0.01, band, tuple(space.counts(planned)))
    model = new_model(planned.machine, []).knowing_effects([effect])
    return model.with_effect(Choice.parse(name)).with_values(values)


def pushes_of(model: Model, planned: Samples) -> np.ndarray:
    (term,) = model.terms
    assert term.learned is not None
    found: np.ndarray = term.learned.tabulated(planned).pushes(np.arange(len(planned))) @ term.values
    return found


def test_what_catches_one_way_only_is_said(planned: Samples) -> None:
    name = "learned:slider:4:position"
    way = planned["travel_direction"][:, 3]
    wanted = catches_one_way(planned["sliders_mm"][:, 3]) * (way > 0.0)
    left = []
    for each in (name, f"{name}_each_way"):
        design = Space.of(Learned.parse(each).finer(4), planned, LEAD_MM).design(planned, 3)
        rest = wanted - design @ np.linalg.lstsq(design, wanted, rcond=None)[0]
        left.append(float(np.std(rest) / np.std(wanted)))
    assert left[0] > 0.5 and left[1] < 0.1


def test_either_way_is_as_likely_whatever_the_other(planned: Samples) -> None:
    space = Space.of(Learned.parse(NAMES[0]), planned, LEAD_MM)
    factor = space.prior_factor(30.0)
    same, half = factor @ factor.T, space.size // 2
    up, down = (np.hstack([np.eye(half), sign * np.eye(half)]) for sign in (1.0, -1.0))
    assert up @ same @ up.T == pytest.approx(down @ same @ down.T)
    assert up @ same @ down.T == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_a_file_keeps_all_functions(planned: Samples, name: str, tmp_path: Path) -> None:
    model = made(planned, name)
    save_model(model, tmp_path / "model.toml")
    again = load_model(tmp_path / "model.toml")
    assert pushes_of(again, planned) == pytest.approx(pushes_of(model, planned), abs=1e-9)
    (term,) = again.terms
    assert term.learned is not None
    curves = term.learned.curves(term.values)
    assert len(curves) == term.learned.space.hypothesis.functions
    hypothesis = term.learned.space.hypothesis
    assert [each.times for each in curves] == [*hypothesis.variable.all_times] * hypothesis.components
    assert [len(each.sigma_mm) for each in curves] == [len(curves[0].at)] * len(curves)
    assert len(learned_figure(again, name).axes) == 2 * len(curves)


@pytest.mark.parametrize("name", NAMES)
def test_tables_push_what_was_learned(planned: Samples, name: str) -> None:
    model = made(planned, name)
    (term,) = model.terms
    assert term.learned is not None
    found = np.zeros_like(pushes_of(model, planned))
    for table in term.learned.tables(term.values, MACHINE):
        for element, ports in table.pushes:
            x, way = (np.asarray(planned[each], float) if each else np.ones(1) for each in (table.column, table.times))
            x, way = (each[:, element] if each.ndim == 2 else each for each in (x, way))
            value = np.interp(np.mod(x, table.period) if table.period else x, table.knots, table.values_mm)
            for port, weight in ports:
                found[:, port] += weight * way * value
    assert np.abs(found - pushes_of(model, planned)).max() < 2e-4
    assert np.abs(found).max() > 5e-3


@pytest.mark.parametrize("name", NAMES)
def test_a_draft_pushes_the_same(planned: Samples, name: str, tmp_path: Path) -> None:
    model = made(planned, name, bump)
    path = tmp_path / "draft.py"
    path.write_text(draft(model, name))
    heights = [float(line.split()[5]) for line in path.read_text().splitlines() if "As learned" in line]
    drafted = load_effects(path)
    assert len({each.name for each in drafted}) == len(heights) == Learned.parse(name).functions
    every = [each.tabulated(planned).pushes(np.arange(len(planned)))[:, :, 0] for each in drafted]
    ours = sum(height_mm * each for height_mm, each in zip(heights, every, strict=True))
    assert np.abs(ours - pushes_of(model, planned)).max() < 3e-4
