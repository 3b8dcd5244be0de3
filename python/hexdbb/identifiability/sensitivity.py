"""How readings answer to the values of a model: the first-order Jacobian at the nominal machine.

Assumption: errors are small (0.1 mm on legs of 400 mm), so the derivative at the nominal machine on the commanded
path says what a test can tell before it is driven. A circle is sampled `SAMPLES_PER_TURN` times, which resolves the
harmonics the machine's errors have many times over; each row counts for as many readings as the drive takes in its
place, as the square root of that number: J'J is then that of all readings.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.kinematics import engine_machine, inverse, status_name
from hexdbb.model import Model, MountKey, Parameter, new_term
from hexdbb.plan import CircleRun, Plan
from hexdbb.record import Record
from hexdbb.samples import knowing, samples_of
from hexdbb.samples.state import planned_columns

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

SAMPLES_PER_TURN = 180
PLANNED = "planned"
"""Stands where a record's hash would: the mounts of a plan that no record exists of."""


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of readings with respect to a model's values.

    `jacobian` has shape (rows, size), mm per engine unit of the value, rows weighted by the square root of the readings
    they stand for; `readings` is the number of all readings; `free` says which values a diagnosis would fit.
    """

    jacobian: Floats
    readings: float
    parameters: tuple[Parameter, ...]
    free: Bools

    @property
    def sizes(self) -> Floats:
        """Prior sigma of every value, shape (size,)."""
        return np.array([each.prior_sigma for each in self.parameters])

    @property
    def is_set_up(self) -> Bools:
        """Which values belong to the set-up and not to the machine, shape (size,)."""
        return np.array([each.is_set_up for each in self.parameters])

    def scaled(self, wanted: Bools) -> Floats:
        """Columns of the values `wanted`, each times its prior sigma: mm per expected size."""
        return np.ascontiguousarray((self.jacobian * self.sizes)[:, wanted])

    def where(self, wanted: Bools) -> list[Parameter]:
        """Give the parameters of the values `wanted`."""
        return [parameter for parameter, each in zip(self.parameters, wanted, strict=True) if each]

    def whose(self, test: Callable[[Parameter], bool]) -> Bools:
        """Which values pass a test."""
        return np.array([test(each) for each in self.parameters])


def plan_sensitivity(
    plan: Plan,
    model: Model,
    cycle_rate_hz: float,
    origin: str = "plan",
    *,
    samples_per_turn: int = SAMPLES_PER_TURN,
) -> Sensitivity:
    """Derivatives of the readings that a plan would take.

    Parameters
    ----------
    plan : Plan
    model : Model
        Every mount of the plan counts as a fixing of its own; mounts it knows already are left out.
    cycle_rate_hz : float
        Readings per second.
    origin : str
        Names the plan in errors.
    samples_per_turn : int
        Rows of each run; runs follow one another in the order of `Plan.runs`.

    Raises
    ------
    InputError
        Where the machine cannot follow a circle.
    """
    runs = plan.runs()
    places = {mount.id: place for place, mount in enumerate(plan.mounts)}
    angle_rad = np.arange(samples_per_turn) * (2.0 * np.pi / samples_per_turn)
    sliders = [_sliders_mm(run, run.direction * angle_rad, model, origin) for run in runs]
    repeat = np.repeat(np.arange(len(runs), dtype=np.int32), samples_per_turn)
    mount = np.array([places[run.mount.id] for run in runs], dtype=np.int32)
    set_ups = [set_up_of(run, plan) for run in runs]
    known = with_planned_mounts(model, [mount.id for mount in plan.mounts])
    samples = _core.Samples(
        sliders_mm=np.vstack(sliders),
        set_up=repeat,
        mount=mount[repeat],
        set_ups=set_ups,
        state=planned_columns(runs, angle_rad),
    )
    samples.derive(engine_machine(model.machine))
    counts = np.array([readings_of(run, cycle_rate_hz) for run in runs])
    weights = np.sqrt(counts / samples_per_turn)[repeat]
    return Sensitivity(
        _jacobian(known, samples, origin) * weights[:, None],
        float(counts.sum()),
        tuple(known.parameters()),
        known.free,
    )


def record_sensitivity(records: Sequence[Record], model: Model) -> Sensitivity:
    """Derivatives of the readings that records hold.

    Raises
    ------
    InputError
        Where a record is of another machine, or a sample out of the nominal machine's reach.
    """
    known = knowing(model, records)
    names = ", ".join(record.name for record in records)
    jacobian = _jacobian(known, samples_of(records, known), names)
    return Sensitivity(jacobian, float(len(jacobian)), tuple(known.parameters()), known.free)


def with_every_effect(model: Model) -> Model:
    """Give the same model with the catalogue's other effects beside its own, not free."""
    present = {term.effect for term in model.terms}
    absent = [name for name in _core.effect_names() if name not in present]
    others = [new_term(name, model.info(name).size, free=False) for name in absent]
    return replace(model, terms=(*model.terms, *others))


def with_planned_mounts(model: Model, mount_ids: Sequence[int]) -> Model:
    """Give the same model knowing the mounts of a plan in place of its own."""
    known = replace(model, mounts=tuple(MountKey(PLANNED, each) for each in mount_ids))
    sizes = {term.effect: known.info(term.effect).size for term in model.terms}
    terms = (
        term
        if len(term.values) == sizes[term.effect]
        else new_term(term.effect, sizes[term.effect], free=bool(term.free.any()))
        for term in model.terms
    )
    return replace(known, terms=tuple(terms))


def readings_of(run: CircleRun, cycle_rate_hz: float) -> float:
    """Count the readings of a run: one a cycle over its captured laps."""
    return run.laps * 2.0 * np.pi * run.circle.radius_mm / (run.feed_mm_min / 60.0) * cycle_rate_hz


def set_up_of(run: CircleRun, plan: Plan) -> _core.SetUp:
    """Give the engine's form of a run's set-up."""
    return _core.SetUp(
        cup_mm=np.array(run.mount.cup_mm),
        ball_offset_mm=np.array(run.circle.ball_offset_mm),
        bar_length_mm=plan.gauge.bar_length_mm,
    )


def _sliders_mm(run: CircleRun, angle_rad: NDArray[np.floating], model: Model, origin: str) -> Floats:
    circle = run.circle
    sliders_mm, status = inverse(model.machine, circle.poses(angle_rad, run.mount.cup_mm), circle.platform_rpy_rad)
    if status.any():
        row = int(np.flatnonzero(status)[0])
        place = f"{origin}: circle {circle.id} at {np.degrees(angle_rad[row]) % 360.0:.0f} deg"
        raise InputError(f"{place}: {status_name(int(status[row]))} (expected a circle within reach)")
    return sliders_mm


def _jacobian(model: Model, samples: _core.Samples, origin: str) -> Floats:
    size = len(model.values)
    nominal = model.with_values(np.zeros(size), np.full(size, np.nan), np.zeros(size, bool))
    predicted = _core.predict(nominal.engine(samples), samples, True)
    row = predicted.first_failure
    if row >= 0:
        reason = status_name(int(predicted.status[row]))
        raise InputError(f"{origin}: sample {row + 1}: the sliders' place has no pose ({reason})")
    jacobian: Floats = predicted.jacobian
    return jacobian
