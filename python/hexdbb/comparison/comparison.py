"""The comparison of samples with what a model predicts for them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from hexdbb.comparison.bystanders import marked
from hexdbb.comparison.circles import CircleComparison, compare_circles, root_mean_square
from hexdbb.comparison.iso230 import FloatArray
from hexdbb.comparison.notebook import comparison_html
from hexdbb.comparison.radial import RadialError, radial_errors
from hexdbb.comparison.tables import comparison_text
from hexdbb.comparison.worst_arcs import WorstArc, worst_arcs
from hexdbb.comparison.worst_samples import WorstSamples, worst_samples
from hexdbb.diagnosis import fit_mounts, noise_of
from hexdbb.errors import InputError
from hexdbb.files.frames import to_frame
from hexdbb.files.plain_text import plain_text
from hexdbb.model import Model
from hexdbb.predictors import Predictor, Pushes, rank_predictors, record_names
from hexdbb.samples import Samples, predict
from hexdbb.threads import computed_beside, one_thread

if TYPE_CHECKING:
    from hexdbb.discovery import LikelyCause

WORST_COUNT = 5
"""Number of worst arcs listed: as many as are read."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Measured against predicted readings over all samples.

    Attributes
    ----------
    samples : Samples
        What was compared.
    predicted_mm, residual_mm : (n,) arrays
        Predicted reading of each sample, and measured minus predicted.
    circles : tuple of CircleComparison
        In the order of the records, then circle, then feed.
    radial : tuple of RadialError
        Radial error of the commanded circles, one for each record; independent of the model.
    worst : tuple of WorstArc
        Arcs with the largest residual, largest first.
    worst_samples : WorstSamples
        The samples with the largest residuals, and what is over-represented among them.
    predictors : tuple of Predictor
        Variables of the samples that explain the residual, those of most worth first; last those that only go with the
        likely cause.
    fitted_mounts : tuple of str
        One sentence for each set-up that the model did not know, so that its cup was fitted first.
    cause : LikelyCause or None
        Of the residual; None where it is noise, or was not looked for, or the readings are too few.
    """

    samples: Samples = field(repr=False)
    predicted_mm: FloatArray = field(repr=False)
    residual_mm: FloatArray = field(repr=False)
    circles: tuple[CircleComparison, ...]
    radial: tuple[RadialError, ...]
    worst: tuple[WorstArc, ...]
    worst_samples: WorstSamples
    predictors: tuple[Predictor, ...]
    fitted_mounts: tuple[str, ...]
    cause: LikelyCause | None = None
    is_commanded: bool = False
    """Whether no model predicts: the readings are compared with those of the commanded circles."""

    @property
    def rms_mm(self) -> float:
        """Root mean square residual of all samples."""
        return root_mean_square(self.residual_mm)

    @property
    def peak_to_valley_mm(self) -> float:
        """Largest minus smallest residual of all samples."""
        return float(np.ptp(self.residual_mm))

    def to_json(self) -> dict[str, Any]:
        """Return the object `hexdbb compare --json` prints: micrometres, None where a quantity cannot be evaluated."""
        from hexdbb.comparison.json_form import ComparisonJson  # only --json needs it

        return ComparisonJson.of(self).to_json()

    def __str__(self) -> str:
        return plain_text(comparison_text(self))

    def to_frame(self) -> Any:
        """Return the samples with predicted reading and residual as a ``pandas.DataFrame``, a row for each.

        Raises
        ------
        InputError
            Where pandas is not installed.
        """
        return to_frame(self.samples.columns() | {"predicted_mm": self.predicted_mm, "residual_mm": self.residual_mm})

    def _repr_html_(self) -> str:
        return comparison_html(self)


@one_thread
def compare(samples: Samples, model: Model, *, find_cause: bool = True) -> Comparison:
    """Compare the readings of samples with those that a model predicts.

    The cups of mounts that the model does not know are fitted first, all else held; `Comparison.fitted_mounts` states
    where they are.

    Parameters
    ----------
    samples : Samples
        At least one.
    model : Model
    find_cause : bool
        Whether the likely cause of the residual is looked for, where that is more than noise: two or three seconds for
        20,000 samples.

    Raises
    ------
    InputError
        No samples in a record, a machine that differs, or a sample that the model's machine cannot reach; an effect of
        the user's own that fails, with file and line.
    """
    _require_samples(samples)
    known, fitted = fit_mounts(samples, model)
    predicted = predict(samples, known)
    pushes, noise_mm = Pushes.of(samples, known), noise_of(samples).sigma_mm
    described = partial(_described, samples, predicted.reading_mm, pushes, noise_mm)
    if not find_cause:
        return _compared(described(), pushes, noise_mm, fitted)
    from hexdbb.discovery import likely_cause  # a quarter of the start of a comparison without

    with computed_beside(described) as rest:
        cause = likely_cause(samples, known, predicted.residual_mm)
        return _compared(rest(), pushes, noise_mm, fitted, cause)


def compare_readings(
    samples: Samples,
    predicted_mm: FloatArray,
    pushes: Pushes | None = None,
    noise_mm: float = 0.0,
    fitted_mounts: Sequence[str] = (),
    cause: LikelyCause | None = None,
    is_commanded: bool = False,
) -> Comparison:
    """Compare the readings of samples with readings predicted by any means.

    Parameters
    ----------
    samples : Samples
        At least one of each record.
    predicted_mm : (n,) array
        Predicted reading of each sample.
    pushes : Pushes, optional
        Response of the readings to pushes on the machine. Without it every cause acts on the reading, and guideways
        and legs are left out of the predictors.
    noise_mm : float
        Standard deviation of one reading; 0 where it is not known.
    fitted_mounts : sequence of str
        Sentences on set-ups fitted before.
    cause : LikelyCause, optional
        Of the residual.
    is_commanded : bool
        Whether the predictions are the commanded circles' (`hexdbb.comparison.commanded`).

    Raises
    ------
    InputError
        No samples in a record, or predictions that do not belong to the samples.
    """
    described = _described(samples, predicted_mm, pushes, noise_mm)
    return _compared(described, pushes, noise_mm, fitted_mounts, cause, is_commanded)


@dataclass(frozen=True)
class _Described:
    """What a comparison has whatever the cause of its residual."""

    samples: Samples
    predicted_mm: FloatArray
    circles: list[CircleComparison]
    predictors: list[Predictor]


def _described(samples: Samples, predicted_mm: FloatArray, pushes: Pushes | None, noise_mm: float) -> _Described:
    """Compare circle by circle and rank predictors; parameters and errors are those of `compare_readings`."""
    _require_samples(samples)
    _check_prediction(samples, predicted_mm)
    predictors = rank_predictors(samples, samples.reading_mm - predicted_mm, pushes, noise_mm)
    return _Described(samples, predicted_mm, compare_circles(samples, predicted_mm), predictors)


def _compared(
    described: _Described,
    pushes: Pushes | None,
    noise_mm: float,
    fitted_mounts: Sequence[str],
    cause: LikelyCause | None = None,
    is_commanded: bool = False,
) -> Comparison:
    """Complete a comparison by what depends on the cause."""
    samples, circles, predictors = described.samples, described.circles, described.predictors
    residual_mm = samples.reading_mm - described.predicted_mm
    if cause is not None:
        predictors = marked(predictors, samples, residual_mm, pushes, noise_mm, cause)
    return Comparison(
        samples=samples,
        predicted_mm=described.predicted_mm,
        residual_mm=residual_mm,
        circles=tuple(circles),
        radial=radial_errors(circles),
        worst=tuple(worst_arcs(circles, WORST_COUNT)),
        worst_samples=worst_samples(samples, residual_mm, cause, noise_mm),
        predictors=tuple(predictors),
        fitted_mounts=tuple(fitted_mounts),
        cause=cause,
        is_commanded=is_commanded,
    )


def _require_samples(samples: Samples) -> None:
    there = set(np.unique(samples["record"]).tolist())
    for number, name in enumerate(record_names(samples.records)):
        if number not in there:
            raise InputError(f"{name}: no samples (expected at least one to compare)")


def _check_prediction(samples: Samples, predicted_mm: FloatArray) -> None:
    if predicted_mm.shape != (len(samples),):
        raise InputError(
            f"{samples.name}: prediction of shape {predicted_mm.shape} (expected one per sample, ({len(samples)},))"
        )
    if not np.isfinite(predicted_mm).all():
        row = int(np.flatnonzero(~np.isfinite(predicted_mm))[0])
        raise InputError(
            f"{samples.name}: predicted reading of sample {row} is {predicted_mm[row]} (expected a finite length)"
        )
