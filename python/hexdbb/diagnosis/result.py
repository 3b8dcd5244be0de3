"""What a diagnosis found: values, how well they are known, what cannot be known, and what to beware of.

The most probable values given the readings and the expected size of every value (the engine's `diagnosis.hpp`). A
value counts as identifiable where the readings narrow it to `KNOWN_PART` of its expected size, so that its
uncertainty is the readings' and not the expectation's. A value that is known only in combination with others has no
uncertainty of its own: its sigma is nan, and `unidentifiable` says with what it is entangled.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis.heldout import HeldOut
from hexdbb.diagnosis.noise import Noise
from hexdbb.diagnosis.tables import value_columns, values_html
from hexdbb.files.frames import to_frame
from hexdbb.identifiability.redundancy import KNOWN_PART
from hexdbb.model import Model
from hexdbb.units import shown_factor, shown_unit

Floats = NDArray[np.float64]

UNKNOWN_PART = 0.5
"""Of a direction whose uncertainty is above this part of its expected size the readings tell nothing."""


@dataclass(frozen=True)
class Diagnosis:
    """What a fit found.

    `rank` and `condition` are those of the machine's own values, with all that unknowns of the set-up can explain taken
    out. `model` has the fitted values; `covariance` (engine units, shape (size, size)) is theirs, expected sizes
    included, zero where not free. `noise` is that of one reading; `noise_um` what the uncertainties were computed with,
    larger where the model leaves a residual. `correlation` neighbouring readings tell as much as one.
    """

    model: Model
    rms_before_um: float
    rms_after_um: float
    noise: Noise
    noise_um: float
    correlation: float
    rank: int
    condition: float
    usable: bool
    iterations: int
    termination: str
    covariance: Floats
    residual_mm: Floats
    held_out: HeldOut | None
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
        variances, directions = principal(self.covariance, self.model)
        known = (variances > 0.0) & (variances < KNOWN_PART**2)
        return directions[:, known], np.sqrt(variances[known])

    def columns(self) -> dict[str, NDArray[Any]]:
        """Give every value of the model with name, uncertainty and unit, one array a column."""
        return value_columns(self.model)

    def to_frame(self) -> Any:
        """Give `columns` as a ``pandas.DataFrame``; `InputError` where pandas is not installed."""
        return to_frame(self.columns())

    def _repr_html_(self) -> str:
        fall = f"reading error {self.rms_before_um:.2f} → {self.rms_after_um:.2f} µm RMS"
        noise = f"noise {self.noise.sigma_mm * 1e3:.2f} µm ({self.noise.source})"
        return f"<p>{fall}, {noise}</p>{values_html(self.model)}"

    def to_json(self) -> dict[str, Any]:
        """Give the object that `hexdbb diagnose --json` prints."""
        return {
            "rms_before_um": self.rms_before_um,
            "rms_after_um": self.rms_after_um,
            "noise_um": self.noise.sigma_mm * 1e3,
            "noise_source": self.noise.source,
            "heldout_before_um": None if self.held_out is None else self.held_out.before_um,
            "heldout_after_um": None if self.held_out is None else self.held_out.after_um,
            "rank": self.rank,
            "condition": self.condition,
            "usable": self.usable,
            "parameters": parameter_rows(self.model),
            "unidentifiable": list(self.unidentifiable),
            "warnings": list(self.warnings),
        }


def parameter_rows(model: Model) -> list[dict[str, Any]]:
    """Give every value with name, uncertainty and unit, as JSON has them."""
    rows = []
    sigmas = model.sigma
    known = np.concatenate([np.zeros(0, bool), *(term.identifiable for term in model.terms)])
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
    return rows


def prior_sigmas(model: Model) -> Floats:
    """Expected sizes of a model's values, engine units, shape (size,)."""
    return np.array([parameter.prior_sigma for parameter in model.parameters()])


def principal(covariance: Floats, model: Model) -> tuple[Floats, Floats]:
    """Variances and directions of the values in units of their prior sigma, best known first."""
    sizes = prior_sigmas(model)
    variances, directions = np.linalg.eigh(covariance / np.outer(sizes, sizes))
    return variances, directions


def unknown_directions(covariance: Floats, model: Model, columns: Sequence[int]) -> Floats:
    """Directions of the free values (rows in the order of `columns`) of which the readings tell nothing."""
    variances, directions = principal(covariance, model)
    unknown: Floats = directions[
        np.ix_(np.asarray(columns, dtype=np.intp), np.flatnonzero(variances > UNKNOWN_PART**2))
    ]
    return unknown
