"""Redundancies that follow from the machine's structure, whatever is measured: found from what the values displace.

To first order every value displaces parts of the mechanism: joint centres on the sliders (a slider's own coordinate
moves its joint along the guideway), legs, joints on the platform, ball, cup. Two kinds of combination change no reading
of any test:

- the same motion: values whose displacements cancel, as a guideway shifted along itself and its sliders' offsets;
- a rigid motion of base and cup together: displacements t + r x p at every joint on a slider and at the cup.

Both follow from the pushes that the effects themselves state, so that no effect and no dimension of the machine stands
here. A combination counts only where it also lies in the null space found in the readings.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.kinematics import engine_machine
from hexdbb.model import Model, Parameter
from hexdbb.samples import PUSH_SHAPES, Samples, effect_pushes

Floats = NDArray[np.float64]

TOLERANCE = 0.02
"""Largest part of a combination that may lie outside the null space: a machine with errors turns it by that little."""
ROUNDING = 1e-9
"""Displacements below this part of the largest are rounding of double precision."""
MAX_ROWS = 128
"""Samples whose displacements are compared: some eighteen for each circle of a plan of seven. Two combinations that
displace the same in a few poses of every circle, in both directions of travel, do so everywhere."""
AT_ONCE = 32
"""Samples whose displacements are computed at once: they fit a processor's cache, all do not."""
AXES = "xyz"


@dataclass(frozen=True, eq=False)
class Displacements:
    """What a model's values displace, to first order at the nominal machine.

    The displacements of all places in many samples are some ten thousand rows. Kept are fewer, which have the same
    inner products of columns: only these are asked for.

    Attributes
    ----------
    per_value : ndarray, shape (rows, size)
        Displacements, mm per engine unit of the value.
    shifts, turns : ndarray, shape (rows, 3)
        What rigid motions of base and cup displace, mm per mm along and mm per rad about x, y, z.
    """

    per_value: Floats
    shifts: Floats
    turns: Floats

    @classmethod
    def of(cls, samples: Samples, model: Model) -> Displacements:
        """Compute the displacements in some of the samples, evenly chosen."""
        rows = np.unique(np.linspace(0, len(samples) - 1, MAX_ROWS).astype(np.intp))
        parts = np.split(rows, range(AT_ONCE, len(rows), AT_ONCE))
        return cls._joined([cls._in_all(samples.part(part), model).compressed() for part in parts]).compressed()

    @classmethod
    def _in_all(cls, few: Samples, model: Model) -> Displacements:
        """Compute the displacements in all samples, one after another."""
        guideways = np.arange(6) // 2
        machine = engine_machine(model.machine)
        along = np.array([_core.guideway_direction(machine, each) for each in guideways])
        vertices = np.array([_core.guideway_vertex(machine, each) for each in guideways])
        pushes = effect_pushes(few, model.with_values(model.start))
        at_joints = pushes["slider_joint"] + along[None, :, :, None] * pushes["slider"][:, :, None, :]
        others = [pushes[port] for port in PUSH_SHAPES if port not in ("slider", "slider_joint", "cup")]
        elsewhere = _distinct(_by_place(others))
        places = vertices + along * few["sliders_mm"][:, :, None]
        cups = np.array([each.cup_mm for each in few.set_ups])[few["set_up"]]
        moved = np.concatenate([places, cups[:, None, :]], axis=1)  # (n, 7, 3)
        shifts = [np.broadcast_to(axis, moved.shape) for axis in np.eye(3)]
        turns = [np.cross(axis, moved) for axis in np.eye(3)]
        at_moved = _by_place([at_joints, pushes["cup"]])
        return cls(
            np.concatenate([at_moved.reshape(-1, at_moved.shape[-1]), elsewhere]),
            *(np.column_stack([_padded(each, len(elsewhere)) for each in motions]) for motions in (shifts, turns)),
        )

    @classmethod
    def _joined(cls, parts: Sequence[Displacements]) -> Displacements:
        each = ([part.per_value for part in parts], [part.shifts for part in parts], [part.turns for part in parts])
        return cls(*map(np.concatenate, each))

    def compressed(self) -> Displacements:
        """Return as few rows as there are columns that have the same inner products, to rounding of single ones."""
        upper = np.asarray(np.linalg.qr(np.hstack([self.per_value, self.shifts, self.turns]), mode="r"), np.float64)
        count = self.per_value.shape[1]
        return Displacements(upper[:, :count], upper[:, count : count + 3], upper[:, count + 3 :])

    def of_values(self, chosen: Sequence[int] | NDArray[np.bool_]) -> Displacements:
        """Return those of some of the values."""
        return Displacements(self.per_value[:, chosen], self.shifts, self.turns)


@dataclass(frozen=True, eq=False)
class Redundancy:
    """A combination of values that changes no reading: `move` in mm, angles at their lever arm, shape (values,)."""

    sentence: str
    move: Floats


def redundancies(
    null: Floats, parameters: Sequence[Parameter], levers_mm: Floats, displaced: Displacements
) -> list[Redundancy]:
    """Find the redundancies that follow from the machine's structure and lie in a null space.

    Parameters
    ----------
    null : ndarray, shape (values, k)
        Null space as columns, lengths in mm, angles in mm at their lever arm.
    parameters : sequence of Parameter
        The values.
    levers_mm : ndarray, shape (values,)
        Lever arm of an angle, 1 of a length.
    displaced : Displacements
        Of these values.

    Returns
    -------
    list of Redundancy
        Linearly independent.
    """
    per_mm = displaced.per_value / levers_mm
    basis, _ = np.linalg.qr(null)
    found = [*_same_motions(per_mm, parameters), *_rigid_motions(per_mm, displaced)]
    inside = [Redundancy(each.sentence, basis @ (basis.T @ each.move)) for each in found]
    return [
        kept
        for kept, each in zip(inside, found, strict=True)
        if np.linalg.norm(kept.move - each.move) <= TOLERANCE * np.linalg.norm(each.move)
    ]


def _same_motions(per_mm: Floats, parameters: Sequence[Parameter]) -> list[Redundancy]:
    """Return the combinations whose displacements cancel: the last value of each as a combination of earlier ones."""
    _, sizes, directions = np.linalg.svd(np.linalg.qr(per_mm, mode="r"))
    rank = int(np.sum(sizes > ROUNDING * sizes[0])) if len(sizes) else 0
    moves = _reduced_from_the_last(directions[rank:])
    found = []
    for move in moves[np.argsort([np.flatnonzero(move)[-1] for move in moves])] if len(moves) else []:
        *others, last = map(int, np.flatnonzero(move))
        if others:
            alike = _listed([parameters[each] for each in others])
            found.append(Redundancy(f"{parameters[last].label} is the same motion as {alike}", move))
    return found


def _reduced_from_the_last(directions: Floats) -> Floats:
    """Compute the reduced echelon form whose pivots are the last columns possible; rounding becomes 0."""
    rows: Floats = directions.copy()
    done = 0
    for column in range(rows.shape[1] - 1, -1, -1):
        if done == len(rows):
            break
        best = done + int(np.argmax(np.abs(rows[done:, column])))
        if abs(rows[best, column]) < ROUNDING**0.5:
            continue
        rows[[done, best]] = rows[[best, done]]
        rows[done] /= rows[done, column]
        others = np.arange(len(rows)) != done
        rows[others] -= np.outer(rows[others, column], rows[done])
        done += 1
    rows[np.abs(rows) < ROUNDING**0.5] = 0.0
    return rows


def _rigid_motions(per_mm: Floats, displaced: Displacements) -> list[Redundancy]:
    """Return the rigid motions of base and cup that the values can make; a turn may be about any point."""
    found = []
    for axis, shift in zip(AXES, displaced.shifts.T, strict=True):
        move = _made(per_mm, shift)
        if move is not None:
            found.append(Redundancy(f"a rigid shift of base and cup along {axis}", move))
    count = per_mm.shape[1]
    for axis, turn in zip(AXES, displaced.turns.T, strict=True):
        move = _made(np.column_stack([per_mm, displaced.shifts]), turn)
        if move is not None:
            found.append(Redundancy(f"a rigid turn of base and cup about {axis}", move[:count]))
    return found


def _made(per_mm: Floats, wanted: Floats) -> Floats | None:
    """Return the smallest combination that displaces as wanted; None where there is none."""
    move = np.linalg.lstsq(per_mm, wanted, rcond=ROUNDING)[0].astype(np.float64)
    missed = np.linalg.norm(per_mm @ move - wanted)
    return move if missed < ROUNDING**0.5 * np.linalg.norm(wanted) else None


def _listed(parameters: Sequence[Parameter]) -> str:
    """Name values, those of one effect together: ``slider_offset:1:2 offset``."""
    elements: dict[tuple[str, str], list[str]] = {}
    for each in parameters:
        elements.setdefault((each.effect, each.name), []).append(each.element)
    return " and ".join(f"{':'.join((effect, *own))} {name}" for (effect, name), own in elements.items())


def _by_place(pushes: Sequence[Floats]) -> Floats:
    """Return pushes of shape (n, ..., size) one behind the other, shape (n, all places, size)."""
    count, size = pushes[0].shape[0], pushes[0].shape[-1]
    return np.concatenate([each.reshape(count, -1, size) for each in pushes], axis=1)


def _distinct(pushes: Floats) -> Floats:
    """Return pushes of shape (n, places, size) as rows, one for a place where all samples have the same.

    It has the inner products of all n: legs, joints on the platform and ball are displaced alike in every pose.
    """
    count, _, size = pushes.shape
    is_same = (pushes == pushes[:1]).all(axis=(0, 2))
    return np.concatenate([np.sqrt(count) * pushes[0, is_same], pushes[:, ~is_same].reshape(-1, size)])


def _padded(moved: Floats, rest: int) -> Floats:
    """Return the displacements (n, 7, 3) of joints and cup as rows, and zeros for the rows of all other places."""
    return np.concatenate([moved.ravel(), np.zeros(rest)])
