"""A true machine measured and diagnosed, and the diagnosis beside the truth.

Values: every fitted value less the true one. Positions: where the ball of the diagnosed model stands at poses over the
workspace, less where it truly stands, a rigid motion of the base removed, which no ball bar sees while the position of
the cup is unknown. The poses are those at which a diagnosis states how well the position is known
(`hexdbb.diagnosis.place_uncertainty`).
Units: mm, rad inside; µm in results.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.diagnosis import Diagnosis, diagnose
from hexdbb.errors import RunError
from hexdbb.kinematics import inverse, rotation_from_rpy
from hexdbb.model import Model, new_model
from hexdbb.rig.truth import TruthFile
from hexdbb.samples import Samples
from hexdbb.studies.setting import Setting
from hexdbb_truth.places import true_balls_mm
from hexdbb_truth.simulate import simulate

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Places:
    """RMS over the workspace of the ball's position, µm.

    Attributes
    ----------
    before_um, after_um : float
        Error of the nominal and of the diagnosed machine.
    stated_um : float
        What the diagnosis states for its own.
    """

    before_um: float
    after_um: float
    stated_um: float


def diagnosed(truth: TruthFile, setting: Setting) -> Diagnosis:
    """Return the diagnosis of a true machine on the study's plan."""
    record = simulate(truth, setting.plan, truth.seed, setting.pace)
    return diagnose(Samples.of([record]), new_model(setting.machine), check_held_out=False)


def true_values(truth: TruthFile, model: Model) -> Floats:
    """Return a machine's true errors in the place of a model's values, mm and rad; nan for effects it has not."""
    mounts = [key.mount_id for key in model.mounts]
    cups = truth.setup.errors().cup_mm
    by_effect = {
        name.rpartition("_")[0]: np.ravel(value) * (1e-3 if name.endswith("_um") else 1e-6)
        for name, value in truth.geometry.model_dump().items()
    }
    by_effect["cup_position"] = np.ravel([cups.get(each, (0.0, 0.0, 0.0)) for each in mounts])
    by_effect["ball_offset"] = np.array(truth.setup.errors().ball_offset_mm)
    by_effect["bar_length"] = np.array([truth.setup.errors().bar_length_mm])
    return np.concatenate([by_effect.get(term.effect, np.full(len(term.values), np.nan)) for term in model.terms])


def place_errors(truth: TruthFile, setting: Setting, found: Diagnosis) -> Places:
    """Return how far the ball stands from where the nominal machine and where the diagnosed one has it.

    Raises
    ------
    RunError
        The diagnosed machine cannot reach a pose.
    """
    place, model, ball_mm = found.place, found.model, setting.plan.circles[0].ball_offset_mm
    ball = np.array(ball_mm)
    position, rpy = place.position_mm, place.rpy_rad
    nominal = position + rotation_from_rpy(rpy) @ ball
    true = true_balls_mm(truth, setting.machine, position, rpy, ball_mm)
    effects = np.array([each.effect for each in model.parameters()])
    moved = model.values[effects == "ball_offset"]
    sliders, _ = inverse(setting.machine, position, rpy)
    modelled = _balls_mm(model, sliders, ball + (moved if len(moved) else 0.0))
    stated_um = 1e3 * float(np.sqrt(np.mean(place.sigma_mm**2)))
    return Places(rms_um(true - nominal, nominal), rms_um(true - modelled, nominal), stated_um)


def rms_um(errors_mm: Floats, places_mm: Floats) -> float:
    """Return the RMS length of errors at places, both (n, 3), without the best rigid motion of the base, µm."""
    columns = [np.tile(axis, (len(places_mm), 1)) for axis in np.eye(3)]
    columns += [np.cross(axis, places_mm) for axis in np.eye(3)]
    design = np.stack([each.ravel() for each in columns], axis=1)
    left = errors_mm.ravel() - design @ np.linalg.lstsq(design, errors_mm.ravel(), rcond=None)[0]
    return float(np.sqrt(np.mean(np.sum(left.reshape(-1, 3) ** 2, axis=1)))) * 1e3


def _balls_mm(model: Model, sliders_mm: Floats, ball_mm: Floats) -> Floats:
    rows = np.zeros(len(sliders_mm), dtype=np.int32)
    bar = _core.SetUp(cup_mm=np.zeros(3), ball_offset_mm=ball_mm, bar_length_mm=0.0)
    samples = _core.Samples(sliders_mm=sliders_mm, set_up=rows, mount=rows, set_ups=[bar])
    pose, status = _core.forward_table(model.engine(), samples)
    if status.any():
        raise RunError("the diagnosed machine cannot reach a pose that the nominal one does")
    places: Floats = pose[:, :3] + pose[:, 3:].reshape(-1, 3, 3) @ ball_mm
    return places
