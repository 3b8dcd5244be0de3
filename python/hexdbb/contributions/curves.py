"""Radial curves of a record's circles: what single groups of values do to them.

The circular deviation G of ISO 230-4 does not depend on where the centre is nor on the size of the circle: the zone's
two circles may lie anywhere. Of a curve f over the commanded angle a, least squares over both directions of one circle
at one feed therefore remove

    f(a) - (r + x cos a + y sin a),

which is also all that a shifted cup does to first order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hexdbb.charts import screened
from hexdbb.comparison import UM_PER_MM, CircleComparison
from hexdbb.comparison.circle_fit import minimum_zone
from hexdbb.comparison.circles import lap_mean_path
from hexdbb.comparison.iso230 import Path
from hexdbb.contributions.groups import Group
from hexdbb.model import Model
from hexdbb.samples import Samples, linearise, predict
from hexdbb.samples.distinct import distinct_rows

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]
Paths = list[list[Path]]
"""Path of each direction of each circle."""

MAX_ROWS = 6000
"""Samples of a record whose curves are varied to find uncertainties: a hundred for each direction of thirty circles and
feeds, three degrees apart."""
ZONE_COLUMNS = 60
"""Arcs of a circle whose extremes enter its minimum zone, six degrees wide: the contacts of the zone are among them."""


@dataclass(frozen=True, eq=False)
class Centring:
    """Removes centre and radius of each circle at one feed from curves over some samples.

    Attributes
    ----------
    circles : tuple of (m,) arrays of int
        Rows of each circle at one feed, both directions.
    bases : tuple of (m, 3) arrays
        Orthonormal columns that span radius and centre, for each of them.
    """

    circles: tuple[Rows, ...]
    bases: tuple[Floats, ...]

    @classmethod
    def of(cls, samples: Samples) -> Centring:
        """Prepare for the circles of samples of one record."""
        first, member = distinct_rows(samples["circle"], samples["feed_mm_s"])
        rows = [np.flatnonzero(member == number) for number in range(len(first))]
        angle_rad = samples["angle_rad"]
        bases = [
            np.linalg.qr(np.column_stack([np.ones(len(own)), np.cos(angle_rad[own]), np.sin(angle_rad[own])]))[0]
            for own in rows
        ]
        return cls(tuple(rows), tuple(bases))

    def centred(self, curves: Floats) -> Floats:
        """Return curves, shape (n,) or (n, k), without centre and radius of each circle."""
        left: Floats = np.array(curves, dtype=np.float64)
        for rows, basis in zip(self.circles, self.bases, strict=True):
            left[rows] -= basis @ (basis.T @ left[rows])
        return left

    def peak_to_valley(self, centred: Floats) -> Floats:
        """Return largest minus smallest value of each circle, shape (circles,) or (circles, k)."""
        return np.array([np.ptp(centred[rows], axis=0) for rows in self.circles])


class RecordCurves:
    """Curves of one record under a model.

    Parameters
    ----------
    samples : Samples
        Of one or several records.
    number : int
        Which record of them.
    model : Model
        That knows its mounts.
    predicted_mm : ndarray, shape (n,)
        What the model predicts for all samples.
    circles : sequence of CircleComparison
        Of all records; rows refer to `samples`.
    """

    def __init__(
        self, samples: Samples, number: int, model: Model, predicted_mm: Floats, circles: Sequence[CircleComparison]
    ) -> None:
        self.here = np.flatnonzero(samples["record"] == number)
        self.record, self.model = samples.part(self.here), model
        self.bar_mm = samples.records[number].gauge.bar_length_mm
        self.predicted_mm = predicted_mm[self.here]
        rows = set(self.here.tolist())
        own = [each for each in circles if int(each.directions[0].rows[0]) in rows]
        self.circles = [each for each in own if all(part.measured.is_full_circle for part in each.directions)]
        self.few = np.arange(0, len(self.here), -(-len(self.here) // MAX_ROWS))
        self.few_samples = self.record.part(self.few)

    @cached_property
    def centring(self) -> Centring:
        """Centring of the few samples that curves are varied over."""
        return Centring.of(self.few_samples)

    @cached_property
    def jacobian(self) -> Floats:
        """Centred derivatives by all values of the model at the few samples, shape (m, size)."""
        return self.centring.centred(linearise(self.few_samples, self.model).jacobian)

    @property
    def measured(self) -> Paths:
        """Measured paths."""
        return [[part.measured for part in each.directions] for each in self.circles]

    @property
    def predicted(self) -> Paths:
        """Predicted paths."""
        return [[part.predicted for part in each.directions] for each in self.circles]

    def of(self, groups: Sequence[Group]) -> tuple[Paths, Floats]:
        """Return what some groups do in this machine: as paths, and centred over the few samples, shape (m,), mm.

        The prediction less that of the model with the groups' values taken out.
        """
        values = self.model.values
        for group in groups:
            values[group.columns] = self.model.start[group.columns]
        without_mm = predict(self.record, self.model.with_values(values)).reading_mm
        curve = self.centring.centred((self.predicted_mm - without_mm)[self.few])
        return differences(self.predicted, self._paths(without_mm)), curve

    def machine_curve(self, set_up: Sequence[Group]) -> Floats:
        """Return what is measured less what the set-up does on a nominal machine, centred over the few samples."""
        alone = self.model.start.copy()
        for group in set_up:
            alone[group.columns] = self.model.values[group.columns]
        by_set_up_mm = predict(self.few_samples, self.model.with_values(alone)).reading_mm
        return self.centring.centred(self.few_samples.reading_mm - by_set_up_mm)

    def residual(self) -> Floats:
        """Return measured less predicted reading, centred over the few samples."""
        return self.centring.centred(self.few_samples.reading_mm - self.predicted_mm[self.few])

    def _paths(self, reading_mm: Floats) -> Paths:
        found = []
        for each in self.circles:
            rows = [np.searchsorted(self.here, part.rows) for part in each.directions]
            found.append(
                [lap_mean_path(self.record.part(own), each.circle, self.bar_mm, reading_mm[own]) for own in rows]
            )
        return found


def differences(ones: Paths, others: Paths) -> Paths:
    """Return paths less other paths of the same samples."""
    return [
        [
            Path(one.angle_rad, one.deviation_mm - other.deviation_mm, one.nominal_radius_mm)
            for one, other in zip(own, minus, strict=True)
        ]
        for own, minus in zip(ones, others, strict=True)
    ]


def circular_deviations_um(circles: Paths) -> Floats:
    """Return the circular deviation of each circle, its directions together, µm."""
    return np.array([UM_PER_MM * _zone_mm(paths) for paths in circles])


def _zone_mm(paths: Sequence[Path]) -> float:
    points = [path.points_mm[screened(path.angle_rad, path.deviation_mm, ZONE_COLUMNS)] for path in paths]
    return minimum_zone(np.vstack(points)).width_mm
