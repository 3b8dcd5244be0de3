"""Do the stated uncertainties cover the truth? Many machines are measured, diagnosed and compared with their truth.

For every machine: the share of identifiable values whose 95 % interval contains the truth; the residual over the
noise; and the error of the ball position at held-out poses, before and after, with the rigid motion of the base
removed (a ball bar cannot measure it while the position of the cup is unknown).

    python -m tests.truth.coverage --seeds 200 -o docs/uncertainty.md
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from tests.truth.simulate import Pace, simulate

from hexdbb import _core
from hexdbb.diagnosis import Diagnosis, diagnose
from hexdbb.kinematics import inverse
from hexdbb.model import Model, new_model
from hexdbb.plan import Plan, load_plan
from hexdbb.rig.geometry import true_geometry
from hexdbb.rig.pose_solver import Hexapod, Poses, solve_poses
from hexdbb.rig.truth import TruthFile, random_truth
from hexdbb.samples import Samples

Floats = NDArray[np.float64]

PACE = Pace(rate_hz=40.0)
HELD_OUT_POSES = 200


@dataclass(frozen=True)
class Trial:
    """Result for one machine."""

    inside: Floats
    """Whether each identifiable value's 95 % interval contains the truth (1 or 0)."""
    worst_sigmas: float
    """Largest error over stated standard deviation."""
    rank: int
    residual_over_noise: float
    position_before_um: float
    position_after_um: float


def study_plan() -> Plan:
    """Return the seven circles of the standard plan at 3000 mm/min, one lap each way."""
    return load_plan("standard").model_copy(update={"feeds_mm_min": (3000.0,), "laps": 1})


def true_values(truth: TruthFile, model: Model) -> Floats:
    """Return a truth file's errors as values of a model, mm and rad."""
    by_effect = {
        name.rpartition("_")[0]: np.ravel(value) * 1e-3 if name.endswith("_um") else np.ravel(value) * 1e-6
        for name, value in truth.geometry.model_dump().items()
    }
    by_effect["cup_position"] = np.array(truth.setup.cup_error_um[0]) * 1e-3
    by_effect["ball_offset"] = np.array(truth.setup.ball_offset_error_um) * 1e-3
    by_effect["bar_length"] = np.array([truth.setup.bar_length_error_um * 1e-3])
    return np.concatenate([by_effect[term.effect] for term in model.terms])


def trial(seed: int, plan: Plan) -> Trial:
    """Return the result of measuring and diagnosing one machine."""
    truth = random_truth(seed)
    found = diagnose(
        Samples.of([simulate(truth, plan, seed, PACE)]), new_model(plan.machine_file()), check_held_out=False
    )
    model = found.model
    known = ~np.isnan(model.sigma)
    sigmas = np.abs(model.values - true_values(truth, model))[known] / model.sigma[known]
    before, after = position_errors_um(truth, plan, found)
    return Trial(
        inside=(sigmas < 1.96).astype(float),
        worst_sigmas=float(sigmas.max()),
        rank=found.rank,
        residual_over_noise=found.rms_after_um / (found.noise.sigma_mm * 1e3),
        position_before_um=before,
        position_after_um=after,
    )


def position_errors_um(truth: TruthFile, plan: Plan, found: Diagnosis) -> tuple[float, float]:
    """Return the RMS error of the ball position at held-out poses, µm, of the nominal and of the diagnosed machine."""
    machine = plan.machine_file()
    random = np.random.default_rng(truth.seed)
    position = random.uniform([-90.0, -90.0, 265.0], [90.0, 90.0, 290.0], (4 * HELD_OUT_POSES, 3))
    rpy = random.uniform(-0.15, 0.15, position.shape)
    sliders, status = inverse(machine, position, rpy)
    position, rpy, sliders = (each[status == 0][:HELD_OUT_POSES] for each in (position, rpy, sliders))
    rotation = np.array([_core.rotation_from_rpy(*each) for each in rpy])
    ball = np.array(plan.circles[0].ball_offset_mm)
    true_ball = ball + np.array(truth.setup.ball_offset_error_um) * 1e-3
    geometry = true_geometry(machine, truth.geometry.errors())
    joints = np.array([geometry.slider_joints_mm(each) for each in sliders])
    count = len(sliders)
    hexapod = Hexapod(joints, np.tile(geometry.joints_mm, (count, 1, 1)), np.tile(geometry.lengths_mm, (count, 1)))
    truly = solve_poses(hexapod, Poses(position, rotation))
    true_place = truly.position_mm + truly.rotation @ true_ball
    nominal_place = position + rotation @ ball
    values = found.model.values
    names = [each.effect for each in found.model.parameters()]
    model_ball = ball + values[[index for index, name in enumerate(names) if name == "ball_offset"]]
    model_place = _model_places(found.model, sliders, model_ball)
    return _rms_um(true_place - nominal_place, nominal_place), _rms_um(true_place - model_place, nominal_place)


def _model_places(model: Model, sliders: Floats, ball: Floats) -> Floats:
    rows = np.zeros(len(sliders), dtype=np.int32)
    bar = _core.SetUp(cup_mm=np.zeros(3), ball_offset_mm=ball, bar_length_mm=0.0)
    samples = _core.Samples(sliders_mm=sliders, set_up=rows, mount=rows, set_ups=[bar])
    pose, status = _core.forward_table(model.engine(), samples)
    assert not status.any()
    places: Floats = pose[:, :3] + pose[:, 3:].reshape(-1, 3, 3) @ ball
    return places


def _rms_um(errors: Floats, places: Floats) -> float:
    """Return the RMS length of errors after removal of the best rigid motion of the base, µm."""
    columns = [np.tile(axis, (len(places), 1)) for axis in np.eye(3)]
    columns += [np.cross(axis, places) for axis in np.eye(3)]
    design = np.stack([each.ravel() for each in columns], axis=1)
    left = errors.ravel() - design @ np.linalg.lstsq(design, errors.ravel(), rcond=None)[0]
    return float(np.sqrt(np.mean(np.sum(left.reshape(-1, 3) ** 2, axis=1)))) * 1e3


PAGE = """\
# Do the stated uncertainties cover the truth?

Random machines (errors of 50 µm and 0.2 mrad, platform sides 30 µm, cup misplaced by 0.1 mm, ball by 0.03 mm,
one standard deviation each; gauge noise 0.5 µm), measured on the seven standard circles at 3000 mm/min, one lap each
way, and diagnosed with all 33 errors, cup and ball unknown. The truth shares no code with the engine.

| | |
|---|---|
{rows}

Positions are compared after removal of a rigid motion of the base, which a ball bar cannot measure while the position
of the cup is unknown. The readings of horizontal circles depend on the cup's height to second order only, so that its
sign is often not determined; it then does not count as identifiable.

Made by `{command}`.
"""


def page(trials: list[Trial], command: str) -> str:
    """Return the page as Markdown."""
    inside = np.concatenate([each.inside for each in trials])
    before, after = np.array([(each.position_before_um, each.position_after_um) for each in trials]).T
    rows = [
        ("machines (seeds)", f"{len(trials)}"),
        ("rank", ", ".join(str(each) for each in sorted({each.rank for each in trials}))),
        ("identifiable values per machine", f"{len(inside) / len(trials):.1f}"),
        ("95 % intervals that contain the truth", f"{inside.mean():.1%}"),
        ("largest error, in stated standard deviations", f"{max(each.worst_sigmas for each in trials):.1f}"),
        ("residual over gauge noise, median", f"{np.median([each.residual_over_noise for each in trials]):.3f}"),
        ("error of the ball position at held-out poses, nominal, median", f"{np.median(before):.1f} µm"),
        ("the same, diagnosed, median", f"{np.median(after):.2f} µm"),
        ("improvement factor, median / smallest", f"{np.median(before / after):.0f} / {(before / after).min():.0f}"),
    ]
    return PAGE.format(rows="\n".join(f"| {name} | {value} |" for name, value in rows), command=command)


def main() -> None:
    """Run the study and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("-o", "--output", type=Path)
    arguments = parser.parse_args()
    plan, trials = study_plan(), []
    for seed in range(1, arguments.seeds + 1):
        trials.append(trial(seed, plan))
        print(f"\r{seed}/{arguments.seeds}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    text = page(trials, f"python -m tests.truth.coverage --seeds {arguments.seeds} -o docs/uncertainty.md")
    if arguments.output:
        arguments.output.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
