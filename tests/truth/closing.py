"""A loop closed on a machine of known truth: measured, diagnosed, discovered, compensated, measured on other circles.

The machine: errors of geometry of 50 µm and 0.2 mrad, play and a pitch error in every drive, compliant legs. The record
of the fit and those of held-out circles come from the truth simulator, which shares no code with the engine; the steps
between them are a user's commands, in the same order.
Error: the radial error of each circle as `hexdbb compare` defines it: the deviation of every sample from a perfect
circle of the commanded radius, the cup's offset in the circle's plane removed by least squares, before and after alike,
because the position of the cup of a held-out mount is unknown (ISO 230-4 removes a centre for the same reason); the
radius is not removed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from tests.truth.held_out import held_out_plans

from hexdbb.comparison.circles import compare_circles
from hexdbb.compensation import CompensatedTargets, make_compensation
from hexdbb.diagnosis import diagnose
from hexdbb.discovery import AutoStep, discover_all
from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.model import Model, new_model
from hexdbb.plan import Plan
from hexdbb.record import Record
from hexdbb.rig.mechanisms import MECHANISMS
from hexdbb.rig.truth import GaugeTruth, TruthFile, random_truth
from hexdbb.samples import Samples
from hexdbb_truth.simulate import Pace, simulate
from hexdbb_truth.timeline import Drive

Floats = NDArray[np.float64]
ReportStep = Callable[[str], None]

PACE = Pace(rate_hz=24.0, instants_per_sample=10)
"""One instant every 4 ms, the cycle of the rig."""
PLAY_UM, PITCH_UM, PITCH_TWICE_UM = (5.0, 20.0), (2.0, 6.0), (0.5, 2.0)
COMPLIANCE_UM_N = 0.4
"""Leg compliance: 10 µm under the weight of the platform."""
GAUGE = GaugeTruth(noise_um=0.5, resolution_um=0.1, range_um=2000.0)
MAX_CORRECTION_MM = 2.0
"""Limit of the correction of one slider: where a leg stands steeply on its guideway, an error of 0.1 mm needs more than
a millimetre."""


@dataclass(frozen=True)
class CircleError:
    """Radial error of one circle, both directions, µm."""

    rms_um: float
    peak_to_valley_um: float
    samples: int
    radial_um: Floats
    angle_rad: Floats


@dataclass(frozen=True)
class Found:
    """A fitted model: effects added by `discover --auto`, and whether its last verdict was that nothing is missing."""

    model: Model
    added: tuple[str, ...]
    is_complete: bool
    rms_um: float


def machine_of(seed: int) -> TruthFile:
    """Return a random machine; the same seed gives the same machine."""
    draw, truth = np.random.default_rng([seed, 5]), random_truth(seed)

    def phase_deg() -> float:
        return float(draw.uniform(0.0, 360.0))

    mechanisms = []
    for slider in range(1, 7):
        pitch = MECHANISMS["pitch_cyclic"].model_validate(
            {
                "kind": "pitch_cyclic",
                "slider": slider,
                "amplitude_um": float(draw.uniform(*PITCH_UM)),
                "phase_deg": phase_deg(),
                "second_amplitude_um": float(draw.uniform(*PITCH_TWICE_UM)),
                "second_phase_deg": phase_deg(),
            }
        )
        play = {"kind": "backlash", "slider": slider, "width_um": float(draw.uniform(*PLAY_UM))}
        mechanisms += [pitch, MECHANISMS["backlash"].model_validate(play)]
    sag = MECHANISMS["gravity_sag"].model_validate({"kind": "gravity_sag", "compliance_um_n": COMPLIANCE_UM_N})
    return truth.model_copy(update={"mechanism": (*mechanisms, sag), "gauge": GAUGE})


def silent(truth: TruthFile) -> TruthFile:
    """Return the same machine in a perfect set-up: a gauge without noise and rounding, cups in their nominal positions.

    The part of a cup's error in the circle's plane is removed in any case; a cup out of that plane by z enlarges the
    radius by z^2 / 2 R, which the readings of one circle cannot separate from the machine.
    """
    gauge = GAUGE.model_copy(update={"noise_um": 0.0, "resolution_um": 0.0})
    return truth.model_copy(update={"gauge": gauge, "setup": truth.setup.model_copy(update={"cup_error_um": ()})})


def found_in(records: Sequence[Record], model: Model, report_step: ReportStep) -> Found:
    """Return the model diagnosed and extended until nothing is missing, as `hexdbb discover --auto` does."""
    report_step("diagnosing")
    samples = Samples.of(records)
    diagnosis = diagnose(samples, model, check_held_out=False)
    added: list[str] = []
    for step in discover_all(samples, diagnosis.model, progress=report_step):
        if not isinstance(step, AutoStep):
            return Found(diagnosis.model, tuple(added), step.verdict == "none", diagnosis.rms_after_um)
        diagnosis = step.diagnosis
        if step.what == "add":
            added.append(step.choice)
        else:
            added.remove(step.choice)
    raise AssertionError("discover_all ends with a verdict")


def drive_of(model: Model, machine: MachineFile, max_correction_mm: float = MAX_CORRECTION_MM) -> Drive:
    """Return the slider targets of a controller that compensates by a model."""
    data = make_compensation(model, max_correction_mm=max_correction_mm)
    targets = CompensatedTargets(data, machine.can_setup.limits, "compensation")

    def drive(position_mm: Floats, rpy_rad: Floats, cycle_s: float) -> Floats:
        rows = targets.sliders(position_mm, rpy_rad, cycle_s)
        if rows.refused is not None:
            raise InputError(f"row {rows.refused[0] + 1}: {rows.refused[1]}")
        return rows.sliders_mm

    return drive


def circle_errors(record: Record) -> Iterator[CircleError]:
    """Yield the radial error of every circle of a record."""
    for circle in compare_circles(Samples.of([record]), np.zeros(len(record))):
        radial_mm = circle.radial_mm
        if radial_mm is None:
            raise InputError(f"circle {circle.circle.id}: not a full circle (expected one)")
        um = 1e3 * radial_mm
        angle_rad = np.concatenate([part.angle_rad for part in circle.directions])
        yield CircleError(float(np.sqrt(np.mean(um**2))), float(np.ptp(um)), len(um), um, angle_rad)


def held_out_errors(truth: TruthFile, seed: int, drive: Drive | None = None) -> tuple[CircleError, ...]:
    """Return the errors of every held-out circle measured on a machine, compensated by `drive` or not."""
    records = (simulate(truth, plan, seed + number, PACE, drive=drive) for number, plan in enumerate(held_out_plans()))
    return tuple(error for record in records for error in circle_errors(record))


@dataclass(frozen=True)
class Round:
    """One round: the model, and the held-out circles compensated by it, with the gauge and with a perfect set-up."""

    found: Found
    after: tuple[CircleError, ...]
    machine_alone: tuple[CircleError, ...]


@dataclass(frozen=True)
class Loop:
    """One machine: held-out circles before and after each round; `noise` is their error from the gauge alone.

    `refused` is the reason why the controller refused to drive them compensated; then there are no more rounds.
    """

    seed: int
    before: tuple[CircleError, ...]
    noise: tuple[CircleError, ...]
    rounds: tuple[Round, ...]
    found: Found
    refused: str | None = None


def refined(records: Sequence[Record], before: Found) -> Found:
    """Return the model of the first round fitted to all records together: the second round.

    Discovery is not repeated: while a drive crosses its play at a reversal, within some hundredths of a second, a
    record of few samples per second does not determine the direction of travel, which resembles a spike at the
    reversal. For the same reason outliers are weighted down (`diagnose --robust`).
    """
    diagnosis = diagnose(Samples.of(records), before.model, robust=True, check_held_out=False)
    return replace(before, model=diagnosis.model, rms_um=diagnosis.rms_after_um)


def close(seed: int, plan: Plan, rounds: int, report_step: ReportStep) -> Loop:
    """Return the loop closed on one machine; every round measures `plan`, compensated by the last round's model."""
    truth, machine = machine_of(seed), plan.machine_file()
    drive: Drive | None = None
    records: list[Record] = []
    done: list[Round] = []
    refused = None
    report_step("measuring held-out circles")
    before = held_out_errors(truth, 100 * seed + 50)
    for number in range(rounds):
        report_step(f"round {number + 1}: measuring")
        records.append(simulate(truth, plan, 100 * seed + number, PACE, drive=drive))
        if done:
            report_step(f"round {number + 1}: diagnosing")
            found = refined(records, done[-1].found)
        else:
            found = found_in(records, new_model(machine), lambda step: report_step(f"round 1: {step}"))
        drive = drive_of(found.model, machine)
        report_step(f"round {number + 1}: measuring held-out circles, compensated")
        try:
            after = held_out_errors(truth, 100 * seed + 60 + 10 * number, drive)
        except InputError as error:
            refused = str(error)
            break
        done.append(Round(found, after, held_out_errors(silent(truth), 0, drive)))
    return Loop(seed, before, tuple(map(noise_of, before)), tuple(done), found, refused)


def noise_of(error: CircleError) -> CircleError:
    """Return the error of a perfect circle with as many samples from the gauge noise alone."""
    draw = np.random.default_rng(error.samples)
    um = np.round(draw.normal(0.0, GAUGE.noise_um, error.samples) / GAUGE.resolution_um) * GAUGE.resolution_um
    return replace(error, rms_um=float(np.sqrt(np.mean(um**2))), peak_to_valley_um=float(np.ptp(um)), radial_um=um)
