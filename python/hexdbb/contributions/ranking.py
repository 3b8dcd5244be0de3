"""Every error's part in the circular deviation of a record.

The curve of a contribution is the reading that the model predicts less the one it predicts with the contribution's
values taken out, everything else in place: what it does in this machine. Two numbers follow for each circle and feed,
and are averaged over them:

- alone: circular deviation of the curve by itself, both directions. It ranks, because it does not depend on the order
  in which errors are mended;
- without: circular deviation of the measured circle less the curve: what mending it would leave. It may be larger than
  before where errors cancel one another.

What the readings cannot separate is ranked as one (`knowledge`). Uncertainties are those of the values that a fit of
these readings from the model's values leaves.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb.comparison import UM_PER_MM, CircleComparison
from hexdbb.comparison.circles import compare_circles, root_mean_square
from hexdbb.contributions.curves import Paths, RecordCurves, circular_deviations_um, differences
from hexdbb.contributions.groups import Group, groups_of
from hexdbb.contributions.knowledge import Combination, Knowledge
from hexdbb.contributions.result import Contribution, Contributions, Part, RecordContributions
from hexdbb.diagnosis import evaluate_fit, fit_mounts, noise_of
from hexdbb.model import Model
from hexdbb.predictors import record_names
from hexdbb.samples import Samples, predict
from hexdbb.threads import one_thread

Floats = NDArray[np.float64]

DRAWS = 64
"""Curves drawn from what a fit leaves open: an uncertainty from 64 scatters by 9 %, so that its first digit is good."""
SEED = 20


@one_thread
def rank_contributions(
    samples: Samples,
    model: Model,
    *,
    circles: Sequence[CircleComparison] | None = None,
    covariance: Floats | None = None,
) -> Contributions:
    """Rank the contributions of all errors of a model to the circular deviation of records.

    Parameters
    ----------
    samples : Samples
        Of one or several records; the cups of mounts that the model does not know are fitted first.
    model : Model
    circles : sequence of CircleComparison, optional
        Of the same samples and model, as `Comparison.circles`; computed where not given.
    covariance : ndarray, shape (size, size), optional
        Of the model's values, engine units, as `Diagnosis.covariance`; that of a fit of these samples from the model's
        values where not given. A model without free values is taken as exact.

    Returns
    -------
    Contributions
        One table for each record.

    Raises
    ------
    InputError
        Records of another machine, or a sample that the machine cannot reach.
    """
    known, _ = fit_mounts(samples, model)
    predicted_mm = predict(samples, known).reading_mm
    compared = compare_circles(samples, predicted_mm) if circles is None else circles
    spread = _covariance(samples, known) if covariance is None else covariance
    names = record_names(samples.records)
    return Contributions(
        tuple(
            _of_record(name, RecordCurves(samples, number, known, predicted_mm, compared), spread)
            for number, name in enumerate(names)
        )
    )


def _covariance(samples: Samples, known: Model) -> Floats:
    if not known.free.any():
        return np.zeros((len(known.values),) * 2)
    covariance: Floats = evaluate_fit(samples, known, known.free, noise_of(samples))[1].covariance
    return covariance


def _of_record(name: str, curves: RecordCurves, covariance: Floats) -> RecordContributions:
    note = _why_none(curves)
    return _Ranking(curves, covariance).table(name) if not note else RecordContributions.without_rows(name, note)


def _why_none(curves: RecordCurves) -> str:
    if not curves.circles:
        return "no full circle (expected one at least, to find its circular deviation)"
    driven = curves.circles[0].compensation
    return "" if driven is None else f"driven with {driven}: its circles show what compensation left, not the errors"


class _Ranking:
    """Contributions to one record."""

    def __init__(self, curves: RecordCurves, covariance: Floats) -> None:
        self.curves, self.covariance = curves, covariance
        self.groups = groups_of(curves.model)
        self.knowledge = Knowledge.of(self.groups, curves.jacobian, covariance, curves.model.prior_sigma)
        self.measured_um = circular_deviations_um(curves.measured)

    def table(self, name: str) -> RecordContributions:
        """Return the ranked contributions."""
        set_up = [place for place, each in enumerate(self.groups) if each.is_set_up]
        machine = [place for place in range(len(self.groups)) if place not in set_up]
        rows = [self._contribution(each) for each in self.knowledge.joined(machine)]
        measured = self.curves.machine_curve([self.groups[place] for place in set_up])
        return RecordContributions(
            record_name=name,
            circles=tuple((each.circle.id, each.feed_mm_min) for each in self.curves.circles),
            measured_um=float(np.mean(self.measured_um)),
            measured_by_circle_um=tuple(self.measured_um.tolist()),
            rms_um=UM_PER_MM * root_mean_square(measured),
            rows=tuple(sorted(rows, key=lambda each: -each.circular_deviation_um)),
            set_up=tuple(self._contribution(self.knowledge.combination((place,))) for place in set_up),
            not_explained=self._not_explained(),
        )

    def _contribution(self, known: Combination) -> Contribution:
        groups = [self.groups[each] for each in known.members]
        paths, curve = self.curves.of(groups)
        left = differences(self.curves.measured, paths)
        alone_um, sigma_um = circular_deviations_um(paths), self._sigma_um(groups, curve)
        parts = [_part(groups[0], alone_um, sigma_um)] if len(groups) == 1 else map(self._part, groups)
        return self._made(tuple(parts), alone_um, sigma_um, left, curve, known)

    def _not_explained(self) -> Contribution:
        left = differences(self.curves.measured, self.curves.predicted)
        alone_um = circular_deviations_um(left)
        return self._made((), alone_um, 0.0, self.curves.predicted, self.curves.residual(), None)

    def _made(
        self,
        parts: tuple[Part, ...],
        alone_um: Floats,
        sigma_um: float,
        without: Paths,
        curve: Floats,
        known: Combination | None,
    ) -> Contribution:
        return Contribution(
            parts=parts,
            circular_deviation_um=float(np.mean(alone_um)),
            sigma_um=sigma_um,
            percent=100.0 * float(np.mean(alone_um) / np.mean(self.measured_um)),
            without_um=float(np.mean(circular_deviations_um(without))),
            rms_um=UM_PER_MM * root_mean_square(curve),
            by_circle_um=tuple(alone_um.tolist()),
            is_known=known is None or known.is_known,
            confounded_with=() if known is None else self._confounded_with(known.members),
        )

    def _part(self, group: Group) -> Part:
        paths, curve = self.curves.of([group])
        return _part(group, circular_deviations_um(paths), self._sigma_um([group], curve))

    def _confounded_with(self, members: tuple[int, ...]) -> tuple[str, ...]:
        opposed = [other for each in members for other in self.knowledge.opposed(each) if other not in members]
        return tuple(self.groups[other].label for other in dict.fromkeys(opposed))

    def _sigma_um(self, groups: Sequence[Group], curve: Floats) -> float:
        """Return the scatter of the circular deviation over what the fit leaves open of some groups' values."""
        columns = np.concatenate([group.columns for group in groups])
        variances, directions = np.linalg.eigh(self.covariance[np.ix_(columns, columns)])
        spread = directions * np.sqrt(np.maximum(variances, 0.0))
        drawn = np.random.default_rng(SEED).standard_normal((len(columns), DRAWS))
        varied = curve[:, None] + self.curves.jacobian[:, columns] @ (spread @ drawn)
        centring = self.curves.centring
        scatter = (centring.peak_to_valley(varied) - centring.peak_to_valley(curve)[:, None]).mean(axis=0)
        return UM_PER_MM * root_mean_square(scatter)


def _part(group: Group, alone_um: Floats, sigma_um: float) -> Part:
    return Part(group.effect, group.elements, group.label, group.physics, float(np.mean(alone_um)), sigma_um)
