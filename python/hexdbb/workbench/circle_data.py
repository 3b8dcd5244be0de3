"""What the charts of one circle are drawn from: numbers, screened to the display, as the browser takes them.

What does not depend on the model (measured paths, reversals, the variable) is prepared once for a circle, `CircleView`;
`CircleView.predicted` follows a slider that is dragged, `CircleView.points` when it rests.
"""

from __future__ import annotations

import base64
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.charts import choose_scale, screened
from hexdbb.charts.colours import MEASURED_COLOURS, PREDICTED_COLOURS
from hexdbb.comparison import UM_PER_MM
from hexdbb.comparison.circles import DIRECTION_NAMES, lap_mean_path
from hexdbb.comparison.iso230 import Path, set_up_centre_mm
from hexdbb.comparison.reversals import reversals
from hexdbb.samples import Samples
from hexdbb.workbench.columns import Variable
from hexdbb.workbench.selection import Selection, described

Floats = NDArray[np.float64]
COLUMNS = 700
"""Width in pixels to which lines are screened: that of the widest chart of the page."""
POINT_COLUMNS = 250
"""Columns to which the points against a variable are screened: a point is three pixels wide."""
DECIMALS = 2
"""Decimals of degrees and micrometres: less than a pixel, and under the resolution of a gauge."""
TURN_DEG = 360.0


class CircleView:
    """One circle at one feed, in one direction or both.

    Parameters
    ----------
    samples : Samples
    selection : Selection
    against : Variable
        Against which every reading's residual is drawn.
    """

    def __init__(self, samples: Samples, selection: Selection, against: Variable) -> None:
        self._rows = np.flatnonzero(selection.rows(samples))
        self._part = samples.part(self._rows)
        self._title = described(selection, samples)
        self._against = against
        record = samples.records[selection.record]
        self._circle, self._bar_mm = record.circle(selection.circle), record.gauge.bar_length_mm
        self._of_direction = {
            direction: found
            for direction in DIRECTION_NAMES
            if len(found := np.flatnonzero(self._part["direction"] == direction))
        }

    def measured(self) -> dict[str, Any]:
        """Return what the charts show whatever the model: angles in degrees, lengths in µm.

        Of each direction the mean of its laps, as read (`measured`) and about the measured centre (`polar`).
        """
        return {
            "title": self._title,
            "directions": [
                {
                    "name": DIRECTION_NAMES[direction],
                    "measuredColour": MEASURED_COLOURS[direction],
                    "predictedColour": PREDICTED_COLOURS[direction],
                }
                for direction in self._measured
            ],
            "lines": [
                {"measured": _line(path), "measuredPolar": _line(self._centred(path), closed=True)}
                for path in self._measured.values()
            ],
            "reversals": [[each.slider, round(each.angle_deg, 1)] for each in reversals(self._part)],
            "against": {"label": self._against.label, "unit": self._against.unit},
        }

    def predicted(self, predicted_mm: Floats) -> dict[str, Any]:
        """Return the curves of a model.

        Parameters
        ----------
        predicted_mm : ndarray, shape (n,)
            Readings that it predicts for the whole table.
        """
        paths = self._paths(predicted_mm)
        centred = {each: self._centred(path) for each, path in paths.items()}
        every = (*map(self._centred, self._measured.values()), *centred.values())
        scale = choose_scale(self._circle.radius_mm, max(float(np.abs(each.deviation_mm).max()) for each in every))
        return {
            "scale": {"centre": scale.centre_um, "division": scale.division_um, "count": scale.divisions},
            "scaleLabel": scale.label,
            "lines": [
                {
                    "predicted": _line(path),
                    "polar": _line(centred[direction], closed=True),
                    "residual": _line(self._residual(direction, path)),
                }
                for direction, path in paths.items()
            ],
        }

    def fitted(self, fitted_mm: Floats) -> list[dict[str, str]]:
        """Return the residual of the model as fitted, to be drawn beside that of another one that is shown."""
        paths = self._paths(fitted_mm)
        return [{"residual": _line(self._residual(direction, path))} for direction, path in paths.items()]

    def points(self, predicted_mm: Floats) -> list[Floats]:
        """Return variable, residual and angle of every reading, by direction; of many the extremes of each column."""
        residual_mm = self._part.reading_mm - predicted_mm[self._rows]
        return [self._points(direction, residual_mm) for direction in self._of_direction]

    @cached_property
    def _measured(self) -> dict[int, Path]:
        return {each: self._path(each, self._part.reading_mm) for each in self._of_direction}

    @cached_property
    def _centre_mm(self) -> Floats | None:
        full = [path for path in self._measured.values() if path.is_full_circle]
        return set_up_centre_mm(*full) if full else None

    @cached_property
    def _ordered(self) -> dict[int, tuple[NDArray[np.intp], Floats]]:
        """Rows of each direction in the order of the variable, where it is known, and its values."""
        values, found = self._against.values(self._part), {}
        for direction, rows in self._of_direction.items():
            known = rows[np.isfinite(values[rows])]
            order = known[np.argsort(values[known], kind="stable")]
            found[direction] = (order, values[order])
        return found

    def _paths(self, readings_mm: Floats) -> dict[int, Path]:
        """Return the mean path of each direction, of readings for the whole table."""
        here_mm = readings_mm[self._rows]
        return {each: self._path(each, here_mm) for each in self._of_direction}

    def _path(self, direction: int, reading_mm: Floats) -> Path:
        rows = self._of_direction[direction]
        return lap_mean_path(self._part.part(rows), self._circle, self._bar_mm, reading_mm[rows])

    def _centred(self, path: Path) -> Path:
        """Return a path about the measured centre, whichever it is: a difference between two stays visible."""
        return path if self._centre_mm is None else path.about(self._centre_mm)

    def _residual(self, direction: int, path: Path) -> Path:
        measured = self._measured[direction]
        return Path(path.angle_rad, measured.deviation_mm - path.deviation_mm, path.nominal_radius_mm)

    def _points(self, direction: int, residual_mm: Floats) -> Floats:
        order, values = self._ordered[direction]
        kept = screened(values, residual_mm[order], POINT_COLUMNS)
        angle_deg = np.degrees(self._part["angle_rad"][order[kept]]) % TURN_DEG
        return np.column_stack(
            [values[kept], np.round(UM_PER_MM * residual_mm[order[kept]], DECIMALS), np.round(angle_deg, 1)]
        )


def _line(path: Path, closed: bool = False) -> str:
    """Return angles in degrees and deviations in µm, in turns: base64 of 32-bit floats, which browsers read quickly."""
    kept = screened(path.angle_rad, path.deviation_mm, COLUMNS)
    if closed:
        kept = np.append(kept, kept[:1])
    line = np.column_stack([np.degrees(path.angle_rad[kept]), UM_PER_MM * path.deviation_mm[kept]])
    return base64.b64encode(line.astype("<f4").tobytes()).decode("ascii")
