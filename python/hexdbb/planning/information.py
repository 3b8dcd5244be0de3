"""Information matrix of each candidate circle: J'J / noise^2, values in units of their prior standard deviation.

Values that all circles share (the machine's, the ball offset) stand in `shared`; those of the cup mount, which only
circles about one mount share, in `own`, with `cross` between. For circles about one mount the three add; then the
mount's unknowns are eliminated by the Schur complement, with the prior of the diagnosis:
    marginal = shared - cross (own + I)^-1 cross'.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.identifiability import plan_sensitivity
from hexdbb.model import Model, Parameter, new_term
from hexdbb.plan import Mount, Plan
from hexdbb.planning.candidates import CandidateCircle
from hexdbb.planning.schur import schur_complement

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

SAMPLES_PER_TURN = 48
"""Samples of a candidate circle: enough to compare candidates, because harmonics of the readings above the eighth are
below a millionth of the first."""


@dataclass(frozen=True)
class Information:
    """Information of circles about one mount, circle by circle."""

    shared: Floats
    """Shape (circles, m, m)."""
    cross: Floats
    """Shape (circles, m, k)."""
    own: Floats
    """Shape (circles, k, k)."""

    def __len__(self) -> int:
        return len(self.shared)

    def total(self, chosen: Sequence[int]) -> Information:
        """Return the sum over some circles, as the information of one."""
        rows = list(chosen)
        return Information(
            self.shared[rows].sum(axis=0, keepdims=True),
            self.cross[rows].sum(axis=0, keepdims=True),
            self.own[rows].sum(axis=0, keepdims=True),
        )

    def plus(self, other: Information) -> Information:
        """Return the sum circle by circle; the information of one circle is added to all."""
        return Information(self.shared + other.shared, self.cross + other.cross, self.own + other.own)

    def marginal(self) -> Floats:
        """Return the information on the shared values, the mount's unknowns eliminated, shape (circles, m, m)."""
        return schur_complement(self.shared, self.cross, self.own + np.eye(self.own.shape[-1]))


@dataclass(frozen=True)
class PlannedUnknowns:
    """The values that a plan is to determine, and the nuisance values fitted with them."""

    model: Model
    """With the effect that is aimed at: what others need of the state is not derived for thousands of circles."""
    columns: NDArray[np.intp]
    """Values of the model (with one mount) that all circles share, shape (m,)."""
    own: NDArray[np.intp]
    """Values of the mount, shape (k,)."""
    of_interest: Bools
    """Which of `columns` the plan is chosen for, shape (m,)."""
    noise_mm: float
    """Standard deviation of one reading, mm."""
    cycle_rate_hz: float
    """Readings per second."""


def planned_unknowns(model: Model, aim: str | None, noise_mm: float, cycle_rate_hz: float) -> PlannedUnknowns:
    """Return the values a plan is to determine: all free errors of the machine in a model, or those of one effect.

    Parameters
    ----------
    model : Model
    aim : str or None
        Effect of the catalogue to plan for; None for all free errors of the machine.
    noise_mm : float
        Standard deviation of one reading, mm.
    cycle_rate_hz : float
        Readings per second.

    Raises
    ------
    InputError
        No effect has the name `aim`, it belongs to each mount, or the model has no free error of the machine.
    """
    whole = model if aim is None else _with(model, aim)
    parameters = whole.parameters()
    mine = np.array([each.effect == aim for each in parameters])
    used = whole.free | mine
    per_mount = np.array([whole.info(each.effect).element_kind == "mount" for each in parameters])
    if aim is not None and (mine & per_mount).any():
        raise InputError(f"{aim}: belongs to each mount of the cup (expected an effect that all circles share)")
    columns = np.flatnonzero(used & ~per_mount)
    of_interest = np.array([_is_of_interest(parameters[column], aim) for column in columns], dtype=bool)
    if not of_interest.any():
        raise InputError("the model has no free error of the machine (expected at least one to plan for)")
    return PlannedUnknowns(whole, columns, np.flatnonzero(used & per_mount), of_interest, noise_mm, cycle_rate_hz)


def information_of(candidates: Sequence[CandidateCircle], template: Plan, unknowns: PlannedUnknowns) -> Information:
    """Return the information of candidates about one cup.

    Parameters
    ----------
    candidates : sequence of CandidateCircle
        All about the same cup.
    template : Plan
        Feeds, directions and laps of every circle.
    unknowns : PlannedUnknowns
    """
    mount = Mount(id=0, cup_mm=candidates[0].cup_mm)
    circles = tuple(each.circle(template, identity) for identity, each in enumerate(candidates))
    plan = template.model_copy(update={"mounts": (mount,), "circles": circles})
    sensitivity = plan_sensitivity(plan, unknowns.model, unknowns.cycle_rate_hz, samples_per_turn=SAMPLES_PER_TURN)
    scaled = sensitivity.jacobian * (sensitivity.prior_sigma / unknowns.noise_mm)
    rows = scaled.reshape(len(candidates), -1, scaled.shape[1])
    shared, own = rows[:, :, unknowns.columns], rows[:, :, unknowns.own]
    transposed = np.swapaxes(shared, 1, 2)
    return Information(transposed @ shared, transposed @ own, np.swapaxes(own, 1, 2) @ own)


def _with(model: Model, aim: str) -> Model:
    """Return a model that has an effect, with that effect's values not free where it is added."""
    size = model.info(aim).size
    has = any(term.effect == aim for term in model.terms)
    return model if has else replace(model, terms=(*model.terms, new_term(aim, size, free=False)))


def _is_of_interest(parameter: Parameter, aim: str | None) -> bool:
    return not parameter.is_set_up if aim is None else parameter.effect == aim
