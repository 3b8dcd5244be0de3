"""Twelve months of one machine: its geometry stays, cup and ball are set up anew each month, some faults grow.

Play and warming have forms of their own (`hexdbb_truth.forms`): the play is elastic as a worn nut's, and the leg goes
on warming while the test is driven, which the estimator, one value a record, does not have.
"""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cache

import numpy as np

from hexdbb.record import SLIDER_COLUMNS, Record
from hexdbb.rig.geometry import Array
from hexdbb.rig.truth import Setup, random_truth
from hexdbb_truth import plans
from hexdbb_truth.forms.cases import case
from hexdbb_truth.forms.history import History
from hexdbb_truth.forms.measure import Measured, Sized
from hexdbb_truth.forms.ports import Action, Scene
from hexdbb_truth.simulate import Pace

MONTHS = 12
PLAY_CASE = "backlash-d10-x3-judge-s7"
"""Whose form the play has, 10 % off the catalogue's formula; of slider 1."""
WARM_LEG = 2
"""From 1."""
PLAY_UM = (3.0, 3.0, 3.0, 3.0, 4.0, 5.5, 7.0, 8.5, 10.0, 11.5, 13.0, 14.5)
GROWTH_UM = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 8.0, 11.0, 14.0, 17.0, 20.0)
"""Growth of the warm leg at the beginning of each month's test, compared with the first month."""
WARM_S = 900.0
PACE = Pace(4.0, 16, 10.0)
"""3,500 readings on the standard plan with one lap."""


@dataclass(frozen=True)
class Year:
    """A machine's year.

    Attributes
    ----------
    seed : int
        Of geometry, set-ups and noise.
    play_um, growth_um : tuple of float
        Month by month.
    """

    seed: int
    play_um: tuple[float, ...] = PLAY_UM
    growth_um: tuple[float, ...] = GROWTH_UM

    def records(self) -> list[Record]:
        """Return the records of all months."""
        return [self.record(month) for month in range(len(self.play_um))]

    def record(self, month: int) -> Record:
        """Return the record of a month, from 0; measured on its fifth day."""
        history = _history()
        truth = random_truth(self.seed).model_copy(update={"setup": self._set_up(month)})
        measured = Measured(truth, history)
        draw = np.random.default_rng([self.seed, month, 1])
        readings_um = measured.readings_mm(self._faults(month)) * 1e3 + draw.normal(0.0, 0.5, len(history.samples))
        columns = {**_columns(), "reading_um": np.round(readings_um, 1)}
        started = datetime(2025 + month // 12, 1 + month % 12, 5, 8, tzinfo=UTC)
        metadata = {"started": started.isoformat(), "plan": "standard"}
        plan = history.plan
        return Record(columns, plan.gauge, plan.mounts, plan.circles, history.machine, metadata)

    def _faults(self, month: int) -> Sequence[Sized]:
        formed = case(PLAY_CASE)._drawn("backlash")[0]
        faults: list[Sized] = [(formed.action(), self.play_um[month])]
        if self.growth_um[month]:
            faults.append((Action("leg", (WARM_LEG - 1,), _warming), self.growth_um[month]))
        return faults

    def _set_up(self, month: int) -> Setup:
        draw = np.random.default_rng([self.seed, month, zlib.crc32(b"set-up")])
        cups, ball = draw.normal(0.0, 100.0, (1, 3)), draw.normal(0.0, 30.0, 3)
        return Setup(cup_error_um=np.round(cups, 3).tolist(), ball_offset_error_um=np.round(ball, 3).tolist())


def _warming(scene: Scene, size: float) -> Array:
    """Return the growth of one leg: `size` um from the beginning, and a tenth more while the test is driven."""
    return np.asarray(1e-3 * size * (1.0 - 0.1 * np.expm1(-scene.time_s / WARM_S)))[:, None]


@cache
def _history() -> History:
    plan = plans.discovery_plan()
    return History(plan.model_copy(update={"laps": 1}), PACE)


@cache
def _columns() -> dict[str, np.ndarray]:
    history = _history()
    rows, runs = history.samples, history.run[history.samples]
    return {
        "t_s": history.time_s[rows],
        "circle": np.array([run.circle.id for run in history.runs])[runs],
        "sweep": runs,
        "direction": history.direction(rows).astype(int),
        "lap": np.floor(np.abs(history.angle_rad[rows]) / (2.0 * np.pi) + 1e-9).astype(np.int64),
        "angle_deg": np.degrees(history.angle_rad[rows]) % 360.0 % 360.0,
        "feed_mm_min": np.array([run.feed_mm_min for run in history.runs])[runs],
        **dict(zip(SLIDER_COLUMNS, history.drive_mm[rows].T, strict=True)),
    }
