"""Which circle is shown, and its charts."""

from __future__ import annotations

import numpy as np
from nicegui import ui

from hexdbb.comparison.circles import DIRECTION_NAMES, root_mean_square
from hexdbb.predictors import record_names
from hexdbb.samples import Prediction
from hexdbb.workbench.circle_data import CircleView
from hexdbb.workbench.columns import variables
from hexdbb.workbench.page.attributes import mark
from hexdbb.workbench.page.circle_charts import CircleCharts
from hexdbb.workbench.page.machine_scene import MachineScene
from hexdbb.workbench.page.running import refused
from hexdbb.workbench.selection import Selection
from hexdbb.workbench.session import Session

UM_PER_MM = 1e3
BOTH = {0: "both", **DIRECTION_NAMES}
FIRST_AGAINST = "time_s"
"""The unrolled chart has the angle already; against time warmth and settling show."""


class CirclePanel:
    """A button for each circle and feed with the error there, the direction, and the charts."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._variables = variables(session.samples)
        self._against = FIRST_AGAINST if FIRST_AGAINST in self._variables else next(iter(self._variables))
        self._shown: tuple[Selection, str] | None = None
        self._rows = [each.rows(session.samples) for each in session.selections]
        self._buttons: list[tuple[Selection, ui.button, ui.element, ui.label]] = []
        with ui.element("section").classes("wb-card").props('aria-label="Circle"'):
            self._build_picker()
            self._charts = CircleCharts(self._start, self._moved)
            self._scene = MachineScene(session)

    def draw(self) -> None:
        """Draw what has changed: the charts, the error of every circle."""
        session = self._session
        if self._charts.is_ready:
            key = (session.selection, self._against)
            measured = None
            if key != self._shown:
                self._view = CircleView(session.samples, session.selection, self._variables[self._against])
                self._shown, measured = key, self._view.measured()
            fitted = None if session.tried.is_nothing else session.fitted.reading_mm
            self._charts.show(measured, self._view.predicted(session.prediction.reading_mm, fitted))
        self._draw_picker()
        self._scene.draw()

    def _build_picker(self) -> None:
        session = self._session
        names = record_names(session.samples.records)
        with ui.element("div").classes("wb-picker").props('role="group" aria-label="Circle and feed"'):
            for each in session.selections:
                record = f"{names[each.record]} " if len(names) > 1 else ""
                with (
                    ui.button(on_click=lambda each=each: self._select(each))
                    .props("flat no-caps")
                    .props(mark("circle")) as button
                ):
                    with ui.element("span").classes("wb-circle-name"):
                        ui.label(f"{record}circle {each.circle}")
                        ui.label(f"{each.feed_mm_min:g} mm/min").classes("wb-small")
                    bar = ui.element("span").classes("wb-bar")
                    number = ui.label().classes("wb-circle-rms")
                self._buttons.append((each, button, bar, number))
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
        for (each, button, bar, number), size_um in zip(self._buttons, sizes_um, strict=True):
            current = (each.record, each.circle, each.feed_mm_min) == _place(self._session.selection)
            button.props(f"aria-pressed={'true' if current else 'false'}")
            button.classes(add="wb-current" if current else "", remove="" if current else "wb-current")
            bar.style(f"--part: {size_um / largest_um if largest_um else 0.0:.3f}")
            number.set_text(f"{size_um:.2f} µm")
        self._direction.value = self._session.selection.direction

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
            self.draw()

    def _start(self) -> None:
        self._charts.is_ready, self._shown = True, None
        self.draw()

    def _moved(self, angle_deg: float) -> None:
        self._scene.move(angle_deg)


def _place(selection: Selection) -> tuple[int, int, float]:
    return selection.record, selection.circle, selection.feed_mm_min
