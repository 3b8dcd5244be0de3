"""Outcome of a diagnosis: values, how well they are known, what is not identifiable, and warnings.

The values are the most probable ones given the readings and the prior standard deviation of every value (the engine's
`diagnosis.hpp`). A value counts as identifiable where the readings narrow it to `KNOWN_PART` of its prior, so that its
uncertainty is the readings' and not the prior's. A value that is known only in combination with others has no
uncertainty of its own: its sigma is nan, and `unidentifiable` says with what it is confounded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.diagnosis.heldout import HeldOut
from hexdbb.diagnosis.noise import Noise
from hexdbb.diagnosis.place_uncertainty import PlaceUncertainty, place_uncertainty
from hexdbb.diagnosis.sufficiency import Sufficiency
from hexdbb.diagnosis.text import diagnosis_text
from hexdbb.files.frames import to_frame
from hexdbb.files.plain_text import plain_text
from hexdbb.model import Model
from hexdbb.model.tables import values_html
from hexdbb.samples import Samples

Floats = NDArray[np.float64]

UNKNOWN_PART = 0.5
"""Posterior over prior standard deviation of a direction above which it is called not identifiable: the readings then
carry less than three times the prior's information."""


@dataclass(frozen=True, eq=False, repr=False)
class Diagnosis:
    """What a fit found.

    Attributes
    ----------
    samples : Samples
        What was fitted to: without readings that stand alone.
    model : Model
        With the fitted values.
    rms_before_um, rms_after_um : float
        Root mean square residual at the start and of the fit.
    noise : Noise
        Of one reading.
    noise_um : float
        What the uncertainties were computed with, larger than the noise where the model leaves a residual.
    correlation : float
        Integrated autocorrelation time of the residual: so many neighbouring readings count as one.
    rank, condition : int, float
        Of the machine's own values, with all that unknowns of the set-up can explain taken out.
    usable : bool
    iterations : int
    termination : str
    covariance : ndarray, shape (size, size)
        Of the values, engine units, prior included; zero where not free.
    residual_before_mm, residual_mm : ndarray, shape (n,)
        Measured minus predicted, with the start's and with the fitted values.
    held_out : HeldOut or None
        None with one circle, or where it was not asked for.
    unidentifiable, warnings : tuple of str
        Sentences.
    sufficiency : Sufficiency
        Whether the model is sufficient; `hexdbb.discover` answers by the same.
    """

    samples: Samples
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
    residual_before_mm: Floats
    residual_mm: Floats
    held_out: HeldOut | None
    unidentifiable: tuple[str, ...]
    warnings: tuple[str, ...]
    sufficiency: Sufficiency

    @cached_property
    def place(self) -> PlaceUncertainty:
        """How well the machine's accuracy over the workspace is known, about the first record's first circle."""
        record = self.samples.records[0]
        circle = record.circles[0]
        return place_uncertainty(self.model, self.covariance, circle, record.mount(circle.mount).cup_mm)

    @property
    def machine_values(self) -> int:
        """Number of the machine's own values that were fitted, of which `rank` combinations are determined."""
        free = zip(self.model.parameters(), self.model.free, strict=True)
        return sum(not parameter.is_set_up for parameter, is_free in free if is_free)

    def __repr__(self) -> str:
        held = self.held_out
        checked = "" if held is None else f", held-out circles {held.before_um:.2f} -> {held.after_um:.2f} µm"
        return (
            f"<Diagnosis: reading error {self.rms_before_um:.2f} -> {self.rms_after_um:.2f} µm RMS{checked}, noise"
            f" {self.noise.sigma_mm * 1e3:.2f} µm ({self.noise.source}), rank {self.rank} of {self.machine_values},"
            f" {len(self.unidentifiable)} redundant combinations, {len(self.warnings)} warnings>"
        )

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return every value of the model with name, uncertainty and unit, one array a column."""
        return self.model.columns()

    def to_frame(self) -> Any:
        """Return `columns` as a ``pandas.DataFrame``; `InputError` where pandas is not installed."""
        return to_frame(self.columns())

    def __str__(self) -> str:
        return plain_text(diagnosis_text(self))

    def _repr_html_(self) -> str:
        fall = f"reading error {self.rms_before_um:.2f} → {self.rms_after_um:.2f} µm RMS"
        noise = f"noise {self.noise.sigma_mm * 1e3:.2f} µm ({escape(self.noise.source)})"
        return f"<p>{fall}, {noise}</p>{values_html(self.columns())}"

    def to_json(self) -> dict[str, Any]:
        """Return the object that ``hexdbb diagnose --json`` prints."""
        from hexdbb.diagnosis.json_form import DiagnosisJson, PlaceSigmaJson, value_json  # only --json needs them

        return DiagnosisJson(
            rms_before_um=self.rms_before_um,
            rms_after_um=self.rms_after_um,
            noise_um=self.noise.sigma_mm * 1e3,
            noise_source=self.noise.source,
            heldout_before_um=None if self.held_out is None else self.held_out.before_um,
            heldout_after_um=None if self.held_out is None else self.held_out.after_um,
            rank=self.rank,
            condition=self.condition,
            usable=self.usable,
            parameters=value_json(self.model),
            sufficiency=self.sufficiency.to_json(),
            unidentifiable=self.unidentifiable,
            warnings=self.warnings,
            place_sigma_um=PlaceSigmaJson(self.place.median_um, self.place.worst_um),
        ).to_json()


def unknown_directions(covariance: Floats, model: Model, columns: Sequence[int]) -> Floats:
    """Return the directions of the free values that the readings do not determine.

    Parameters
    ----------
    covariance : ndarray, shape (size, size)
    model : Model
    columns : sequence of int
        Values among which directions are sought; what the others leave unknown counts as uncertainty.

    Returns
    -------
    ndarray, shape (len(columns), k)
        Orthonormal columns, values in units of their prior standard deviation.
    """
    prior = model.prior_sigma
    others = np.ones(len(prior), bool)
    others[list(columns)] = False
    scaled = covariance / np.outer(prior, prior)
    scaled[others], scaled[:, others] = 0.0, 0.0
    variances, directions = np.linalg.eigh(scaled)
    unknown: Floats = directions[
        np.ix_(np.asarray(columns, dtype=np.intp), np.flatnonzero(variances > UNKNOWN_PART**2))
    ]
    return unknown
