"""What the browser shows of a run: where it is, the growing trace, cycle times, following errors, nodes, a button."""

from __future__ import annotations

from typing import Any

from nicegui import ui
from nicegui.element import Element

from hexdbb.charts import choose_scale
from hexdbb.charts.colours import MEASURED_COLOURS
from hexdbb.errors import HexdbbError
from hexdbb.live.histogram import bars, in_words
from hexdbb.live.seen import Ring, SeenRun
from hexdbb.live.stop import Stop
from hexdbb.pages.serving import dress

PERIOD_S = 0.25
"""Time between two drawings, s: a state is told five times a second."""
SILENT_S = 3.0
"""Time without a word after which the page says that it is out of date, s: fifteen states."""
UM_PER_MM = 1e3
DIRECTION_NAMES = {1: "counter-clockwise", -1: "clockwise"}


class LiveCharts(Element, component="live_charts.js"):
    """Polar trace, histograms, following errors and the table of nodes, drawn by `live_charts.js`."""

    def __init__(self) -> None:
        super().__init__()
        self.is_ready = False
        self.on("ready", self._begin)

    def _begin(self) -> None:
        self.is_ready = True


class LivePage:
    """One tab.

    Parameters
    ----------
    run : SeenRun
        Shared by all tabs.
    stop : Stop
        Called by the button.
    """

    def __init__(self, run: SeenRun, stop: Stop) -> None:
        self._run, self._stop = run, stop
        self._epoch = 0
        self._drawn: dict[int, int] = {}
        dress()
        with ui.element("div").classes("wb-page wb-live"):
            self._build_head()
            with ui.element("div").classes("wb-live-main"):
                self._charts = LiveCharts()
        ui.timer(PERIOD_S, self._draw)

    def _build_head(self) -> None:
        with ui.element("header").classes("wb-head"):
            with ui.element("div").classes("wb-verdict"):
                self._about = ui.label().classes("wb-about").props('data-mark="about"')
                self._heading = ui.element("h1").props('data-mark="place"')
                with self._heading:
                    self._place = ui.label("waiting for the run")
                self._warning = ui.label().classes("wb-warning").props('data-mark="warning" role="status"')
            with ui.element("div").classes("wb-numbers"):
                self._share = _number("of the run", "share")
                self._reading = _number("reading, µm", "reading")
                self._samples = _number("samples", "samples")
                self._missed = _number("missed SYNCs", "missed")
            self._button = (
                ui.button("Stop all axes", icon="stop_circle", on_click=self._ask_to_stop)
                .props('color="negative" no-caps size="lg" data-mark="stop"')
                .classes("wb-stop")
            )

    def _ask_to_stop(self) -> None:
        try:
            self._stop()
        except (HexdbbError, OSError) as error:
            ui.notify(str(error), type="negative", position="top")
            return
        self._button.set_text("Asked to stop")

    def _draw(self) -> None:
        run = self._run
        self._draw_head(run)
        if self._charts.is_ready:
            self._charts.run_method("show", _shown(run))
            if run.ring is not None:
                self._draw_ring(run.ring)

    def _draw_head(self, run: SeenRun) -> None:
        told, state = run.told, run.state
        self._about.set_text(
            "  ·  ".join(str(told[key]) for key in ("plan", "record", "machine", "pace") if key in told)
        )
        place = state.get("place", "waiting for the run")
        if state.get("asked"):
            place = "The operator is asked to mount the bar, in the terminal"
        self._place.set_text(run.ended or place[:1].upper() + place[1:])
        kind = "open" if run.ended is None else "bad" if run.failed else "good"
        self._heading.classes(replace=f"wb-{kind}")
        rows, reading_um = state.get("rows"), state.get("reading_um")
        self._share.set_text(f"{100 * state['row'] / rows:.0f} %" if rows else "–")
        self._reading.set_text("–" if reading_um is None else f"{reading_um:+.1f}")
        self._samples.set_text(f"{state.get('samples', 0):,}")
        self._missed.set_text(str(state.get("missed", 0)))
        self._warning.set_text(_warned(run))
        self._button.set_enabled(run.ended is None)

    def _draw_ring(self, ring: Ring) -> None:
        """Send the points that this tab has not, or all of them where another circle has begun."""
        anew = ring.epoch != self._epoch
        if anew:
            self._epoch, self._drawn = ring.epoch, {}
        lines = []
        for trace in ring.traces:
            begin, end = self._drawn.get(trace.sweep, 0), len(trace.points)
            self._drawn[trace.sweep] = end
            if end > begin:
                points = [[reading, angle] for angle, reading in trace.points[begin:end]]
                colour = MEASURED_COLOURS[trace.direction]
                name = DIRECTION_NAMES[trace.direction]
                lines.append({"id": trace.sweep, "name": name, "colour": colour, "points": points})
        if not lines and not anew:
            return
        scale = choose_scale(ring.radius_mm, ring.largest_um / UM_PER_MM)
        self._charts.run_method(
            "grow",
            {
                "anew": anew,
                "title": f"Circle {ring.circle}, {ring.feed_mm_min:g} mm/min",
                "scaleLabel": scale.label,
                "scale": {"centre": scale.centre_um, "division": scale.division_um, "count": scale.divisions},
                "lines": lines,
            },
        )


def _shown(run: SeenRun) -> dict[str, Any]:
    """Return what the charts show of a state."""
    bin_ms, times, gaps = run.told.get("bin_ms", 1.0), run.state.get("times", ()), run.state.get("gaps", ())
    return {
        "times": bars(times, bin_ms),
        "cycle": run.told.get("cycle_ms"),
        "timesLabel": in_words(times, bin_ms, run.state.get("longest_ms", 0.0)),
        "gaps": [list(each) for each in gaps],
        "gapsLabel": f"{run.state.get('missed', 0)} missed, by the number in a row",
        "following": run.following_mm,
        "largest": run.largest_following_mm,
        "limit": run.told.get("limit_mm", 0.0),
        "nodes": run.state.get("nodes", []),
        "notes": run.state.get("notes", []),
    }


def _warned(run: SeenRun) -> str:
    if run.ended is None and run.silent_s > SILENT_S:
        return f"Nothing heard from the run for {run.silent_s:.0f} s: what is shown is out of date"
    return ""


def _number(label: str, name: str) -> ui.label:
    with ui.element("div").classes("wb-number"):
        number = ui.label().classes("wb-figure").props(f'data-mark="{name}"')
        ui.label(label).classes("wb-small")
    return number
