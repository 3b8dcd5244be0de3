"""How readings answer to the values of a model: the first-order Jacobian at the nominal machine.

Assumption: errors are small (0.1 mm on legs of 400 mm), so the derivative at the nominal machine on the commanded path
shows what a test determines before it is run. A circle is sampled `SAMPLES_PER_TURN` times, which resolves the
harmonics of the machine's errors many times over; each row counts for as many readings as the gauge takes in its
place, as the square root of that number: J'J is then that of all readings.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.identifiability.structure import Displacements
from hexdbb.model import Model, MountKey, Parameter, new_term
from hexdbb.plan import CircleRun, Plan
from hexdbb.samples import PLANNED, Samples, linearise
from hexdbb.samples.places import with_planned_places_free, with_set_up_of

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

SAMPLES_PER_TURN = 180
"""Rows of a planned circle, two degrees apart: what geometry puts into a contour changes over tens of degrees."""


@dataclass(frozen=True)
class Sensitivity:
    """Derivatives of readings with respect to a model's values.

    Attributes
    ----------
    jacobian : ndarray, shape (rows, size)
        mm per engine unit of the value, rows weighted by the square root of the readings they stand for.
    readings : float
        Number of all readings.
    samples : Samples
        What the rows stand for.
    model : Model
        Whose `parameters` they are; its `free` values a diagnosis would fit.
    """

    jacobian: Floats
    readings: float
    samples: Samples
    model: Model

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """Name and nature of every value."""
        return tuple(self.model.parameters())

    @property
    def free(self) -> Bools:
        """Which values a diagnosis would fit, shape (size,)."""
        return self.model.free

    @cached_property
    def displacements(self) -> Displacements:
        """What the values displace."""
        return Displacements.of(self.samples, self.model)

    @property
    def prior_sigma(self) -> Floats:
        """Prior standard deviation of every value, shape (size,)."""
        return self.model.prior_sigma

    @property
    def is_set_up(self) -> Bools:
        """Which values belong to the set-up and not to the machine, shape (size,)."""
        return np.array([each.is_set_up for each in self.parameters])

    def scaled(self, wanted: Bools) -> Floats:
        """Return the columns of the values `wanted`, each times its prior sigma: mm per prior standard deviation."""
        return np.ascontiguousarray((self.jacobian * self.prior_sigma)[:, wanted])

    def where(self, wanted: Bools) -> list[Parameter]:
        """Return the parameters of the values `wanted`."""
        return [parameter for parameter, each in zip(self.parameters, wanted, strict=True) if each]

    def whose(self, test: Callable[[Parameter], bool]) -> Bools:
        """Return which values pass a test, shape (size,)."""
        return np.array([test(each) for each in self.parameters])


def plan_sensitivity(
    plan: Plan,
    model: Model,
    cycle_rate_hz: float,
    origin: str = "plan",
    *,
    samples_per_turn: int = SAMPLES_PER_TURN,
) -> Sensitivity:
    """Compute the derivatives of the readings that a plan would take.

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
    angle_rad: Floats = np.arange(samples_per_turn, dtype=np.float64) * (2.0 * np.pi / samples_per_turn)
    samples = Samples.planned(model.machine, runs, angle_rad, plan.gauge.bar_length_mm, origin=origin)
    places = ((each.mount, each.ball_offset_mm) for each in plan.circles)
    known = with_planned_places_free(places, with_planned_mounts(model, [mount.id for mount in plan.mounts]))
    counts = np.array([_readings(run, cycle_rate_hz) for run in runs])
    weights = np.sqrt(np.repeat(counts, samples_per_turn) / samples_per_turn)
    jacobian = _nominal_jacobian(samples, known) * weights[:, None]
    return Sensitivity(jacobian, float(counts.sum()), samples, known)


def measured_sensitivity(samples: Samples, model: Model) -> Sensitivity:
    """Compute the derivatives of the readings that were taken.

    Raises
    ------
    InputError
        Where a record is of another machine, or a sample out of the nominal machine's reach.
    """
    known = with_set_up_of(samples, model)
    jacobian = _nominal_jacobian(samples, known)
    return Sensitivity(jacobian, float(len(jacobian)), samples, known)


def with_every_effect(model: Model) -> Model:
    """Return the same model with the catalogue's other effects beside its own, not free."""
    present = {term.effect for term in model.terms}
    absent = [name for name in _core.effect_names() if name not in present]
    others = [new_term(name, model.info(name).size, free=False) for name in absent]
    return replace(model, terms=(*model.terms, *others))


def with_planned_mounts(model: Model, mount_ids: Sequence[int]) -> Model:
    """Return the same model knowing the mounts of a plan in place of its own."""
    known = replace(model, mounts=tuple(MountKey(PLANNED, each) for each in mount_ids))
    sizes = {term.effect: known.info(term.effect).size for term in model.terms}
    terms = (
        term
        if len(term.values) == sizes[term.effect]
        else new_term(term.effect, sizes[term.effect], free=bool(term.free.any()))
        for term in model.terms
    )
    return replace(known, terms=tuple(terms))


def _readings(run: CircleRun, cycle_rate_hz: float) -> float:
    """Return the readings of a run: one for each cycle over its captured laps."""
    return run.laps * 2.0 * np.pi * run.circle.radius_mm / (run.feed_mm_min / 60.0) * cycle_rate_hz


def _nominal_jacobian(samples: Samples, model: Model) -> Floats:
    return linearise(samples, model.with_values(model.start)).jacobian
