"""What a model predicts for samples, and how the readings answer to the model's values and to pushes on the machine."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError
from hexdbb.kinematics import engine_machine, status_name
from hexdbb.model import Model
from hexdbb.samples.table import Samples

Floats = NDArray[np.float64]
UM_PER_MM = 1e3

PUSH_SHAPES: dict[str, tuple[int, ...]] = {
    "slider": (6,),
    "leg": (6,),
    "slider_joint": (6, 3),
    "platform_joint": (6, 3),
    "ball": (3,),
    "cup": (3,),
    "reading": (),
}
"""Shape of one sample's push, by port, in the order in which the engine counts the ports' columns."""


PORT_COUNT = sum(count for _, count in _core.PORTS.values())
"""Columns of all ports."""


@dataclass(frozen=True, eq=False)
class Prediction:
    """Readings that a model predicts for samples, and what the measured ones leave.

    Attributes
    ----------
    reading_mm : ndarray, shape (n,)
        Ball-bar length minus nominal length.
    residual_mm : ndarray, shape (n,)
        Measured minus predicted; nan where samples are planned.
    """

    reading_mm: Floats
    residual_mm: Floats

    @property
    def rms_um(self) -> float:
        """Root mean square of the residual."""
        return float(np.sqrt(np.mean(self.residual_mm**2))) * UM_PER_MM

    @property
    def peak_to_valley_um(self) -> float:
        """Largest minus smallest residual."""
        return float(np.ptp(self.residual_mm)) * UM_PER_MM


@dataclass(frozen=True, eq=False)
class Linearised(Prediction):
    """A prediction with its derivatives.

    Attributes
    ----------
    jacobian : ndarray, shape (n, size)
        Of the readings with respect to the model's values, mm per engine unit of the value.
    """

    jacobian: Floats


def predict(samples: Samples, model: Model) -> Prediction:
    """Predict the readings of samples.

    Parameters
    ----------
    samples : Samples
    model : Model
        Where it knows any mounts, the samples' must be among them (`hexdbb.diagnosis.fit_mounts`); where it knows none,
        every cup stands where planned.

    Raises
    ------
    InputError
        Naming the first sample that the model's machine cannot reach, or a machine that differs.
    """
    reading_mm = _predicted(samples, model, False).reading_mm
    return Prediction(reading_mm, samples.reading_mm - reading_mm)


def predict_poses(samples: Samples, model: Model) -> tuple[Floats, Floats]:
    """Compute where the platform stands under a model.

    Returns
    -------
    position_mm : ndarray, shape (n, 3)
        Reference point, base frame.
    rotation : ndarray, shape (n, 3, 3)

    Raises
    ------
    InputError
        As `predict`.
    """
    pose, status = _core.forward_table(samples.engine(model), samples.block(model))
    failed = np.flatnonzero(status)
    if len(failed):
        row = int(failed[0])
        raise InputError(f"{_place(samples, row)}: the sliders' place has no pose ({status_name(int(status[row]))})")
    return pose[:, :3].copy(), pose[:, 3:].reshape(-1, 3, 3).copy()


def linearise(samples: Samples, model: Model) -> Linearised:
    """Predict the readings of samples with their derivatives with respect to the model's values.

    Raises
    ------
    InputError
        As `predict`.
    """
    found = _predicted(samples, model, True)
    return Linearised(found.reading_mm, samples.reading_mm - found.reading_mm, found.jacobian)


def port_sensitivity(samples: Samples, model: Model) -> dict[str, Floats]:
    """Return the derivatives of the readings with respect to a push at every port, mm per mm.

    Returns
    -------
    dict of str to ndarray, shape (n, *shape of the port's push)
        By port, shapes as in `PUSH_SHAPES`.
    """
    every = _core.port_sensitivity(samples.engine(model), samples.block(model))
    return {
        port: every[:, first : first + count].reshape(len(every), *PUSH_SHAPES[port])
        for port, (first, count) in _core.PORTS.items()
    }


def effect_pushes(samples: Samples, model: Model) -> dict[str, Floats]:
    """Return what a model's values push at every port, to first order about the values it has.

    Returns
    -------
    dict of str to ndarray, shape (n, *shape of the port's push, size)
        By port, shapes as in `PUSH_SHAPES`; mm per engine unit of the value.
    """
    block, machine = samples.block(model), engine_machine(model.machine)
    every = []
    for term in model.terms:
        own = model.own(term.effect)
        if own is not None:
            every.append(samples.pushes_of(own, term.values))
        else:
            mounts = max(len(model.mounts), 1)
            every.append(_core.effect_pushes(machine, mounts, term.effect, block, term.values))
    pushes = np.concatenate([np.zeros((len(samples), PORT_COUNT, 0)), *every], axis=2)
    return {
        port: pushes[:, first : first + count].reshape(len(samples), *PUSH_SHAPES[port], pushes.shape[2])
        for port, (first, count) in _core.PORTS.items()
    }


def normal_equations(samples: Samples, model: Model, reading_mm: Floats | None = None) -> _core.NormalEquations:
    """Return J'J and J'r of all values of a model, r measured minus predicted, engine units.

    `reading_mm`, shape (n,), are the readings to compare with: those of the samples where not given.
    """
    measured_mm = samples.reading_mm if reading_mm is None else reading_mm
    return _core.normal_equations(samples.engine(model), samples.block(model), measured_mm)


def _predicted(samples: Samples, model: Model, want_jacobian: bool) -> _core.Prediction:
    found = _core.predict(samples.engine(model), samples.block(model), want_jacobian)
    row = found.first_failure
    if row >= 0:
        reason = status_name(int(found.status[row]))
        raise InputError(f"{_place(samples, row)}: the sliders' place has no pose ({reason})")
    return found


def _place(samples: Samples, row: int) -> str:
    """Name a sample: its record and row there."""
    if not samples.records:
        return f"{samples.name}: sample {row + 1}"
    index = int(samples["record"][row])
    before = sum(len(record) for record in samples.records[:index])
    return f"{samples.records[index].name}: row {samples.row_numbers[row] - before + 1}"
