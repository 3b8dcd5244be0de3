"""Two machines written apart must agree: the rig's truth and the engine that diagnoses it, under all errors at once."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest

import hexdbb.rig
from hexdbb.machine import shipped_machine
from hexdbb.model import new_model
from hexdbb.plan import load_plan
from hexdbb.record import SLIDER_COLUMNS, Record
from hexdbb.rig.geometry import true_geometry
from hexdbb.rig.plant import Mounted, Plant
from hexdbb.rig.truth import TruthFile, random_truth
from hexdbb.samples import Samples, predict

MACHINE = shipped_machine()
SAMPLES = 72
ALLOWED = ("hexdbb.rig", "hexdbb.errors", "hexdbb.machine", "hexdbb.files.validation")
PRODUCT_OF_ERRORS_MM = 1e-4
"""Errors of 0.1 mm and 1 mrad do not commute; their product is what the order of the transforms may change."""


def values_of(truth: TruthFile) -> dict[str, np.ndarray]:
    """Engine values (mm, rad) by effect."""
    errors, setup = truth.geometry.errors(), truth.setup.errors()
    return {
        "leg_length": errors.leg_length_mm,
        "slider_offset": errors.slider_offset_mm,
        "guideway_translation": errors.guideway_translation_mm.ravel(),
        "guideway_rotation_xy": errors.guideway_rotation_xy_rad,
        "guideway_rotation_yz": errors.guideway_rotation_yz_rad,
        "guideway_rotation_centre": errors.guideway_rotation_centre_rad,
        "platform_side": errors.platform_side_mm,
        "cup_position": np.array(setup.cup_mm[0]),
        "ball_offset": np.array(setup.ball_offset_mm),
        "bar_length": np.array([setup.bar_length_mm]),
    }


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_truth_and_prediction_agree_on_the_thesis_circle(columns, seed):
    plan, truth = load_plan("thesis"), random_truth(seed)
    circle, mount = plan.circles[0], plan.mounts[0]
    angle = np.linspace(0.0, 2.0 * np.pi, SAMPLES)
    centre = np.array(mount.cup_mm) - np.array(circle.ball_offset_mm)
    ring = circle.radius_mm * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(SAMPLES)])
    nominal = true_geometry(MACHINE)
    sliders = np.array([nominal.sliders_for(centre + around, np.eye(3)) for around in ring])

    plant = Plant(truth.true_machine(MACHINE), centre + ring[0], np.eye(3))
    mounted = Mounted(mount.id, mount.cup_mm, circle.ball_offset_mm, plan.gauge.bar_length_mm)
    readings = []
    for row in sliders:
        plant.step(row, 0.004)
        readings.append(plant.reading_mm(mounted))

    table = {name: np.resize(column, SAMPLES) for name, column in columns.items()}
    table |= {name: sliders[:, k] for k, name in enumerate(SLIDER_COLUMNS)}
    table |= {"t_s": np.arange(SAMPLES) * 0.004, "sweep": np.zeros(SAMPLES), "direction": np.ones(SAMPLES)}
    record = Record(table, plan.gauge, plan.mounts, plan.circles, MACHINE, {})
    model = new_model(MACHINE)
    values = np.concatenate([values_of(truth)[term.effect] for term in model.terms])
    model = model.with_values(values, np.zeros_like(values), np.ones(len(values), dtype=bool))
    np.testing.assert_allclose(predict(Samples.of([record]), model).reading_mm, readings, atol=PRODUCT_OF_ERRORS_MM)
    assert np.ptp(readings) > 0.05


def test_rig_shares_no_code_with_the_engine():
    for path in sorted(Path(hexdbb.rig.__file__).parent.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            names += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            for name in names:
                assert not name.startswith("hexdbb") or name.startswith(ALLOWED), f"{path.name} imports {name}"
