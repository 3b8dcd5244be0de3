"""What each candidate circle would tell: its information matrix J'J / noise^2, values in units of their expected sizes.

Values that all circles share (the machine's, the ball offset) stand in `shared`; those of the cup mount, which only
circles of one mount share, in `own`, with `cross` between. Of circles about one mount the three add; then the mount's
unknowns are taken out by the Schur complement, with the prior as the diagnosis has it:
    told = shared - cross (own + I)^-1 cross'.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.identifiability import plan_sensitivity, with_every_effect
from hexdbb.model import Model, Parameter
from hexdbb.plan import Mount, Plan
from hexdbb.planning.candidates import Candidate

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

SAMPLES_PER_TURN = 48
"""Enough to tell candidates apart: harmonics above the eighth are below a millionth of the first."""


@dataclass(frozen=True)
class Information:
    """Information of circles about one mount.

    Arrays over circles, of shapes (circles, m, m), (circles, m, k) and (circles, k, k).
    """

    shared: Floats
    cross: Floats
    own: Floats

    def __len__(self) -> int:
        return len(self.shared)

    def total(self, chosen: Sequence[int]) -> Information:
        """Sum over some circles, as one."""
        rows = list(chosen)
        return Information(
            self.shared[rows].sum(axis=0, keepdims=True),
            self.cross[rows].sum(axis=0, keepdims=True),
            self.own[rows].sum(axis=0, keepdims=True),
        )

    def plus(self, other: Information) -> Information:
        """Add circle by circle; an information of one circle adds to all."""
        return Information(self.shared + other.shared, self.cross + other.cross, self.own + other.own)

    def told(self) -> Floats:
        """What remains once the mount's unknowns are taken out, shape (circles, m, m)."""
        own = self.own + np.eye(self.own.shape[-1])
        left: Floats = self.shared - self.cross @ np.linalg.solve(own, np.swapaxes(self.cross, 1, 2))
        return left


@dataclass(frozen=True)
class Unknowns:
    """The model whose values a plan is to tell, and which of them are wanted.

    `columns` of the model with one mount are shared by all circles, `own` belong to the mount; `wanted` says which of
    `columns` the plan is chosen for.
    """

    model: Model
    columns: NDArray[np.intp]
    own: NDArray[np.intp]
    wanted: Bools
    noise_mm: float
    cycle_rate_hz: float


def unknowns_of(model: Model, aim: str | None, noise_mm: float, cycle_rate_hz: float) -> Unknowns:
    """Say what a plan is to tell: all errors of the machine that are free in a model, or one effect of the catalogue.

    Raises
    ------
    InputError
        Where no effect is called `aim`, or the model has no free error of the machine.
    """
    whole = with_every_effect(model)
    if aim is not None:
        whole.info(aim)
    parameters = whole.parameters()
    mine = np.array([each.effect == aim for each in parameters])
    used = whole.free | mine
    per_mount = np.array([whole.info(each.effect).element_kind == "mount" for each in parameters])
    if aim is not None and (mine & per_mount).any():
        raise InputError(f"{aim}: belongs to each mount of the cup (expected an effect that all circles share)")
    columns = np.flatnonzero(used & ~per_mount)
    wanted = np.array([_is_wanted(parameters[column], aim) for column in columns], dtype=bool)
    if not wanted.any():
        raise InputError("the model has no free error of the machine (expected at least one to plan for)")
    return Unknowns(whole, columns, np.flatnonzero(used & per_mount), wanted, noise_mm, cycle_rate_hz)


def information_of(candidates: Sequence[Candidate], like: Plan, unknowns: Unknowns) -> Information:
    """Information of candidates about one cup, each with the feeds, directions and laps of a plan."""
    mount = Mount(id=0, cup_mm=candidates[0].cup_mm)
    circles = tuple(each.circle(like, identity) for identity, each in enumerate(candidates))
    plan = like.model_copy(update={"mounts": (mount,), "circles": circles})
    taken = plan_sensitivity(plan, unknowns.model, unknowns.cycle_rate_hz, samples_per_turn=SAMPLES_PER_TURN)
    scaled = taken.jacobian * (taken.prior_sigma / unknowns.noise_mm)
    rows = scaled.reshape(len(candidates), -1, scaled.shape[1])
    shared, own = rows[:, :, unknowns.columns], rows[:, :, unknowns.own]
    turned = np.swapaxes(shared, 1, 2)
    return Information(turned @ shared, turned @ own, np.swapaxes(own, 1, 2) @ own)


def _is_wanted(parameter: Parameter, aim: str | None) -> bool:
    return not parameter.is_set_up if aim is None else parameter.effect == aim
