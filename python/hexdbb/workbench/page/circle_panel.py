"""Which circle is shown, and its charts."""

from __future__ import annotations

import numpy as np
from nicegui import ui

from hexdbb.comparison.circles import DIRECTION_NAMES, root_mean_square
from hexdbb.predictors import record_names
from hexdbb.samples import Prediction
from hexdbb.workbench.circle_data import CircleView
from hexdbb.workbench.columns import variables
from hexdbb.workbench.page.circle_charts import CircleCharts
from hexdbb.workbench.page.circle_picker import CirclePicker
from hexdbb.workbench.page.machine_scene import MachineScene
from hexdbb.workbench.page.running import refused
from hexdbb.workbench.selection import Selection
from hexdbb.workbench.session import Session

UM_PER_MM = 1e3
BOTH = {0: "both", **DIRECTION_NAMES}
FIRST_AGAINST = "time_s"
"""The unrolled chart has the angle already; against time warmth and settling show."""
NOTHING = "nothing"
"""Stands for no curve of the model as fitted, where that is the one shown."""


class CirclePanel:
    """A button for each circle and feed with the error there, the direction, and the charts."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._variables = variables(session.samples)
        self._against = FIRST_AGAINST if FIRST_AGAINST in self._variables else next(iter(self._variables))
        self._shown: tuple[Selection, str] | None = None
        self._rows = [each.rows(session.samples) for each in session.selections]
        self._fitted: object = None
        with ui.element("section").classes("wb-card").props('aria-label="Circle"'):
            self._build_picker()
            self._charts = CircleCharts(self._start, self._moved)
            self._scene = MachineScene(session)

    def follow(self) -> None:
        """Draw what follows a value that is dragged: the curves, the error of every circle."""
        session = self._session
        if self._charts.is_ready:
            key, measured = (session.selection, self._against), None
            if key != self._shown:
                self._view = CircleView(session.samples, session.selection, self._variables[self._against])
                self._shown, measured, self._fitted = key, self._view.measured(), None
            self._charts.show(measured, self._view.predicted(session.prediction.reading_mm), self._fitted_lines())
        self._draw_picker()

    def settle(self) -> None:
        """Draw what follows when it rests: every reading's residual, the machine."""
        if self._charts.is_ready and self._shown is not None:
            self._charts.settle(self._view.points(self._session.prediction.reading_mm))
        self._scene.draw()
        self._direction.value = self._session.selection.direction

    def _fitted_lines(self) -> list[dict[str, str]] | None:
        """Return the residual as fitted beside that of another model; None where the browser has it already."""
        session = self._session
        wanted = NOTHING if session.tried.is_nothing else session.fitted
        if wanted is self._fitted:
            return None
        self._fitted = wanted
        return self._view.fitted(wanted.reading_mm) if isinstance(wanted, Prediction) else []

    def _build_picker(self) -> None:
        session = self._session
        names = record_names(session.samples.records)
        several = len(names) > 1
        self._picker = CirclePicker(
            [
                (f"{names[each.record]} " * several + f"circle {each.circle}", f"{each.feed_mm_min:g} mm/min")
                for each in session.selections
            ],
            lambda place: self._select(session.selections[place]),
        )
        with ui.row().classes("wb-choices"):
            present = {0, *(int(each) for each in np.unique(session.samples["direction"]))}
            self._direction = ui.select(
                {key: name for key, name in BOTH.items() if key in present},
                label="Direction",
                value=session.selection.direction,
                on_change=lambda event: self._turn(event.value),
            ).props("dense outlined options-dense")
            ui.select(
                {key: each.label for key, each in self._variables.items()},
                label="Residual against",
                value=self._against,
                with_input=True,
                on_change=lambda event: self._choose(event.value),
            ).props("dense outlined options-dense").classes("wb-wide")

    def _draw_picker(self) -> None:
        sizes_um = self._sizes_um(self._session.prediction)
        largest_um = max(sizes_um + self._sizes_um(self._session.fitted))
        places = [(each.record, each.circle, each.feed_mm_min) for each in self._session.selections]
        self._picker.show(sizes_um, largest_um, places.index(_place(self._session.selection)))

    def _sizes_um(self, prediction: Prediction) -> list[float]:
        """Return the RMS residual of each circle."""
        return [UM_PER_MM * root_mean_square(prediction.residual_mm[rows]) for rows in self._rows]

    def _select(self, each: Selection) -> None:
        direction = self._session.selection.direction
        self._go(Selection(each.record, each.circle, each.feed_mm_min, direction))

    def _turn(self, direction: int) -> None:
        now = self._session.selection
        if direction != now.direction:
            self._go(Selection(now.record, now.circle, now.feed_mm_min, direction))

    def _go(self, selection: Selection) -> None:
        refused(lambda: self._session.select(selection))

    def _choose(self, against: str | None) -> None:
        if against in self._variables:
            self._against = against
            self._draw()

    def _draw(self) -> None:
        self.follow()
        self.settle()

    def _start(self) -> None:
        self._charts.is_ready, self._shown = True, None
        self._draw()

    def _moved(self, angle_deg: float) -> None:
        self._scene.move(angle_deg)


def _place(selection: Selection) -> tuple[int, int, float]:
    return selection.record, selection.circle, selection.feed_mm_min
