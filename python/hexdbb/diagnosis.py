"""Diagnosis: the values of a model's effects that explain measured readings best, how well they are known, what is not.

The most probable values given the readings and the expected size of every value (the engine's `diagnosis.hpp`). A value
counts as identifiable where the readings narrow it to `KNOWN_PART` of its expected size, so that its uncertainty is the
readings' and not the expectation's. A value that is known only in combination with others has no uncertainty of its
own: its sigma is nan, and `unidentifiable` says with what it is entangled.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.errors import InputError, RunError
from hexdbb.model import LedgerStep, Model, MountKey, Term
from hexdbb.noise import estimated_noise_mm, stated_noise_mm
from hexdbb.prediction import mount_keys, samples_of, unseen_mounts
from hexdbb.record import Record
from hexdbb.redundancy import sentences
from hexdbb.units import shown_factor, shown_unit

Floats = NDArray[np.float64]

KNOWN_PART = 0.2
"""A value or direction is known where its uncertainty is at most this part of its expected size: the prior's weight is
then under 4 %."""
UNKNOWN_PART = 0.5
"""Of a direction whose uncertainty is above this part of its expected size the readings tell nothing."""


@dataclass(frozen=True)
class Diagnosis:
    """What a fit found.

    `rank` and `condition` are those of the machine's own values, with all that unknowns of the set-up can explain taken
    out. `model` has the fitted values; `covariance` (engine units, shape (size, size)) is theirs, expected sizes
    included, zero where not free.
    """

    model: Model
    rms_before_um: float
    rms_after_um: float
    noise_um: float
    rank: int
    condition: float
    usable: bool
    iterations: int
    termination: str
    covariance: Floats
    residual_mm: Floats
    unidentifiable: tuple[str, ...]
    warnings: tuple[str, ...]

    def known_directions(self) -> tuple[Floats, Floats]:
        """Combinations of the values that the readings tell.

        Returns
        -------
        directions : ndarray, shape (size, k)
            Orthonormal columns, values in units of their prior sigma, best known first.
        sigma : ndarray, shape (k,)
            Standard deviation along each, in the same units; at most `KNOWN_PART`.
        """
        variances, directions = _principal(self.covariance, self.model)
        known = (variances > 0.0) & (variances < KNOWN_PART**2)
        return directions[:, known], np.sqrt(variances[known])

    def to_json(self) -> dict[str, Any]:
        """Give the object that `hexdbb diagnose --json` prints."""
        rows = []
        model = self.model
        sigmas, known = model.sigma, np.concatenate([term.identifiable for term in model.terms])
        for index, parameter in enumerate(model.parameters()):
            factor, sigma = shown_factor(parameter.unit), float(sigmas[index])
            rows.append(
                {
                    "effect": parameter.effect,
                    "element": parameter.element,
                    "name": parameter.name,
                    "value": float(model.values[index]) * factor,
                    "sigma": None if np.isnan(sigma) else sigma * factor,
                    "unit": shown_unit(parameter.unit),
                    "identifiable": bool(known[index]),
                }
            )
        return {
            "rms_before_um": self.rms_before_um,
            "rms_after_um": self.rms_after_um,
            "noise_um": self.noise_um,
            "rank": self.rank,
            "condition": self.condition,
            "usable": self.usable,
            "parameters": rows,
            "unidentifiable": list(self.unidentifiable),
            "warnings": list(self.warnings),
        }


def diagnose(records: Sequence[Record], model: Model) -> Diagnosis:
    """Fit a model's free effects to records.

    Parameters
    ----------
    records : sequence of Record
        Every mount counts as one fixing of the cup, with a position of its own.
    model : Model
        Start of the fit; its ledger gains a step.

    Raises
    ------
    InputError
        No records, records of another machine, nothing free, a sample the machine cannot reach.
    RunError
        Where the fit did not end in a usable solution.
    """
    if not records:
        raise InputError("no record to diagnose (expected at least one)")
    if not model.free.any():
        raise InputError("the model has no free effect (expected at least one to fit)")
    known = model.with_mounts(list(dict.fromkeys(mount_keys(records))))
    result, noise_mm = _fit(records, known, known.free)
    if not result.usable:
        raise RunError(f"the fit did not succeed: {result.termination}")
    fitted = _fitted_model(known, result)
    names = tuple(record.name for record in records)
    step = LedgerStep(len(model.ledger) + 1, "diagnose", result.rms_before_mm * 1e3, result.rms_after_mm * 1e3, names)
    parameters = known.parameters()
    free = [parameters[column] for column in result.free_columns]
    return Diagnosis(
        model=replace(fitted, ledger=(*model.ledger, step)),
        rms_before_um=result.rms_before_mm * 1e3,
        rms_after_um=result.rms_after_mm * 1e3,
        noise_um=noise_mm * 1e3,
        rank=result.machine.rank,
        condition=result.machine.condition,
        usable=result.usable,
        iterations=result.iterations,
        termination=result.termination,
        covariance=result.covariance,
        residual_mm=result.residual_mm,
        unidentifiable=tuple(sentences(_unknown_directions(result.covariance, known, result.free_columns), free)),
        warnings=tuple(_warnings(fitted, result, noise_mm)),
    )


def fit_mounts(record: Record, model: Model) -> tuple[Model, list[str]]:
    """Find where the cups of mounts stand that a model has not seen, holding all else: a set-up, not the machine.

    Returns
    -------
    model : Model
        Knowing the record's mounts; the same object where it knew them.
    said : list of str
        What was found, one sentence a mount.
    """
    unseen = unseen_mounts(record, model)
    if not unseen:
        return model, []
    known = _with_mount_effects(model).with_mounts(unseen)
    parameters = known.parameters()
    kinds = {term.effect: known.info(term.effect).element_kind for term in known.terms}
    places = {str(known.mounts.index(key) + 1): key for key in unseen}
    free = np.array([kinds[each.effect] == "mount" and each.element in places for each in parameters])
    result, _ = _fit([record], known, free)
    if not result.usable:
        raise RunError(f"{record.name}: the cup's position could not be fitted: {result.termination}")
    fitted = _fitted_model(known, result)
    return fitted, [_mount_sentence(record, fitted, element, key) for element, key in places.items()]


def _fit(records: Sequence[Record], model: Model, free: NDArray[np.bool_]) -> tuple[_core.FitResult, float]:
    stated = stated_noise_mm(records)
    noise_mm = stated if stated is not None else estimated_noise_mm(records)
    measured = np.concatenate([record.reading_mm for record in records])
    try:
        result = _core.fit(
            model.engine(),
            samples_of(records, model),
            measured,
            noise_mm=noise_mm,
            free=[bool(each) for each in free],
        )
    except ValueError as error:
        raise InputError(f"{', '.join(record.name for record in records)}: {error}") from None
    return result, noise_mm


def _fitted_model(model: Model, result: _core.FitResult) -> Model:
    spread = np.sqrt(np.diag(result.covariance))
    identifiable = spread <= KNOWN_PART * _sizes(model)
    sigma = np.where(identifiable, spread, np.nan)
    held = np.ones(len(sigma), bool)
    held[result.free_columns] = False
    keep = np.concatenate([np.zeros(0, bool), *(term.identifiable for term in model.terms)])
    return model.with_values(result.values, np.where(held, model.sigma, sigma), np.where(held, keep, identifiable))


def _with_mount_effects(model: Model) -> Model:
    present = {term.effect for term in model.terms}
    infos = [model.info(name) for name in _core.effect_names()]
    missing = [info for info in infos if info.element_kind == "mount" and info.name not in present]
    nothing = np.zeros(0)
    terms = tuple(Term(info.name, True, nothing, nothing, np.zeros(0, bool)) for info in missing)
    return replace(model, terms=(*model.terms, *terms))


def _mount_sentence(record: Record, model: Model, element: str, key: MountKey) -> str:
    moved = [
        f"{parameter.name} {value * shown_factor(parameter.unit):+.1f} {shown_unit(parameter.unit)}"
        for parameter, value in zip(model.parameters(), model.values, strict=True)
        if model.info(parameter.effect).element_kind == "mount" and parameter.element == element
    ]
    return f"{record.name}: mount {key.mount_id} is new to the model; its cup was fitted first: {', '.join(moved)}"


def _sizes(model: Model) -> Floats:
    return np.array([parameter.prior_sigma for parameter in model.parameters()])


def _principal(covariance: Floats, model: Model) -> tuple[Floats, Floats]:
    """Variances and directions of the values in units of their prior sigma, best known first."""
    sizes = _sizes(model)
    variances, directions = np.linalg.eigh(covariance / np.outer(sizes, sizes))
    return variances, directions


def _unknown_directions(covariance: Floats, model: Model, columns: Sequence[int]) -> Floats:
    """Directions of the free values (columns) of which the readings tell nothing."""
    variances, directions = _principal(covariance, model)
    return directions[np.ix_(np.asarray(columns, dtype=np.intp), np.flatnonzero(variances > UNKNOWN_PART**2))]


def _warnings(model: Model, result: _core.FitResult, noise_mm: float) -> list[str]:
    said = []
    for parameter, value in zip(model.parameters(), model.values, strict=True):
        if abs(value) > parameter.limit:
            factor, unit = shown_factor(parameter.unit), shown_unit(parameter.unit)
            said.append(
                f"{parameter.label} is {value * factor:.1f} {unit}, beyond +-{parameter.limit * factor:g} {unit}:"
                " this makes no physical sense"
            )
    if result.rms_after_mm > 1.5 * noise_mm:
        said.append(
            f"residual {result.rms_after_mm * 1e3:.2f} um against {noise_mm * 1e3:.2f} um of gauge noise:"
            " the model misses something, and the uncertainties are stretched to match"
        )
    return said
