"""A machine whose guideways, legs and travels are not alike: measured, diagnosed, compensated, as any other.

The truth simulator, which shares no code with the engine, drives it.
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from tests.truth.closing import drive_of, silent

from hexdbb.comparison.circles import compare_circles
from hexdbb.compensation import make_compensation, read_compensation, write_compensation
from hexdbb.diagnosis import diagnose
from hexdbb.errors import InputError
from hexdbb.machine import load_machine, shipped_machine
from hexdbb.model import Model, new_model
from hexdbb.plan import Mount, Plan, load_plan, save_plan
from hexdbb.rig.truth import TruthFile, random_truth
from hexdbb.samples import Samples
from hexdbb_truth.simulate import Pace, simulate
from hexdbb_truth.timeline import Drive

UNLIKE = Path(__file__).parents[2] / "data" / "machines" / "unlike.toml"
PACE = Pace(rate_hz=6.0, instants_per_sample=1, travel_s=2.0)
TILTS = ((0, 0, 0), (10, 0, 0), (-10, 0, 0), (0, 10, 0), (0, -10, 0), (0, 0, 12), (0, 0, -12))
NOISE_UM = 0.5
CUP_MM = (0.0, 0.0, 317.0)


@dataclass
class Diagnosed:
    truth: TruthFile
    plan: Plan
    model: Model
    rms_um: float


def level_circles(folder: Path) -> Plan:
    """Return seven circles of the machine, saved in a folder beside its file."""
    shutil.copy(UNLIKE, folder / "unlike.toml")
    standard = load_plan("standard")
    circles = tuple(
        standard.circles[0].model_copy(
            update={
                "id": number,
                "ball_offset_mm": (0.0, 0.0, 62.0),
                "platform_rpy_deg": tuple(map(float, tilt)),
                "plane_rpy_deg": (8.0, 0.0, 0.0)
                if number == 5
                else (0.0, 8.0, 0.0)
                if number == 6
                else (0.0, 0.0, 0.0),
            }
        )
        for number, tilt in enumerate(TILTS)
    )
    plan = standard.model_copy(
        update={
            "machine": "unlike.toml",
            "circles": circles,
            "mounts": (Mount(id=0, cup_mm=CUP_MM),),
            "feeds_mm_min": (3000.0,),
            "laps": 1,
        }
    )
    save_plan(plan, folder / "plan.toml")
    return load_plan(folder / "plan.toml")


@pytest.fixture(scope="module")
def diagnosed(tmp_path_factory: pytest.TempPathFactory) -> Diagnosed:
    plan, truth = level_circles(tmp_path_factory.mktemp("unlike")), random_truth(11)
    truth = truth.model_copy(update={"gauge": truth.gauge.model_copy(update={"range_um": 3000.0})})
    record = simulate(truth, plan, 1, PACE)
    result = diagnose(Samples.of([record]), new_model(plan.machine_file()), check_held_out=False)
    return Diagnosed(truth, plan, result.model, result.rms_after_um)


def elsewhere(plan: Plan) -> Plan:
    """Return circles that were not fitted: other cups, tilts and planes."""
    circles = tuple(
        plan.circles[0].model_copy(
            update={
                "id": number,
                "mount": number,
                "platform_rpy_deg": (5.0 - 10.0 * number, 4.0, 6.0),
                "plane_rpy_deg": (-6.0, 6.0 * number, 0.0),
            }
        )
        for number in range(2)
    )
    mounts = tuple(Mount(id=number, cup_mm=(12.0 * number, -8.0, 310.0)) for number in range(2))
    return plan.model_copy(update={"circles": circles, "mounts": mounts})


def radial_um(diagnosed: Diagnosed, drive: Drive | None = None) -> float:
    """Return the RMS of the radial error of circles elsewhere on the machine in a perfect set-up."""
    perfect = silent(diagnosed.truth)
    plan = elsewhere(diagnosed.plan)
    circles = []
    for circle, mount in zip(plan.circles, plan.mounts, strict=True):
        one = plan.model_copy(update={"circles": (circle,), "mounts": (mount,)})
        one._path = diagnosed.plan.path
        record = simulate(perfect, one, 5, PACE, drive=drive)
        circles += compare_circles(Samples.of([record]), np.zeros(len(record)))
    return 1e3 * float(np.sqrt(np.mean(np.concatenate([each.radial_mm for each in circles]) ** 2)))


def test_the_fit_explains_the_readings_to_the_noise(diagnosed: Diagnosed) -> None:
    assert diagnosed.rms_um == pytest.approx(NOISE_UM, rel=0.05)


def test_identifiable_values_are_those_of_the_truth(diagnosed: Diagnosed) -> None:
    """Legs and platform sides are determined on their own; each is found within four standard deviations."""
    truth = {
        "leg_length": diagnosed.truth.geometry.leg_length_um,
        "platform_side": diagnosed.truth.geometry.platform_side_um,
    }
    checked = 0
    for effect, expected_um in truth.items():
        term = diagnosed.model.term(effect)
        assert term is not None
        for value, sigma, expected in zip(term.values, term.sigma, np.asarray(expected_um), strict=True):
            if np.isfinite(sigma) and sigma < 0.02:
                checked += 1
                assert abs(1e3 * value - expected) < 4.0 * 1e3 * sigma
    assert checked >= 6


def test_compensation_straightens_circles_elsewhere(diagnosed: Diagnosed) -> None:
    before = radial_um(diagnosed)
    after = radial_um(diagnosed, drive_of(diagnosed.model, diagnosed.plan.machine_file()))
    assert before > 20.0
    assert after < before / 50.0


def test_the_compensation_file_names_the_machine(diagnosed: Diagnosed, tmp_path: Path) -> None:
    data = make_compensation(diagnosed.model, max_correction_mm=2.0)
    path = tmp_path / "unlike.hexcomp"
    write_compensation(data, path)
    text = path.read_text(encoding="utf-8")
    assert 'schema = "hexdbb.compensation/3"' in text
    assert "leg_length_mm = [398, 403, 407, 391, 400, 412]" in text
    read_compensation(path, load_machine(UNLIKE))
    with pytest.raises(InputError, match="of another machine: base_inradius_mm is 260"):
        read_compensation(path, shipped_machine())
    other = load_machine(UNLIKE)
    legs = other.legs.model_copy(update={"length_mm": (398.0, 403.0, 407.5, 391.0, 400.0, 412.0)})
    with pytest.raises(InputError, match=r"leg_length_mm\[2\] is 407 \(expected 407.5\)"):
        read_compensation(path, other.model_copy(update={"legs": legs}))
