"""Display of a run: a live progress bar on a terminal, plain lines elsewhere.

A thread reads `RunProgress` ten times a second; the loop does not depend on it.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console, RenderableType
from rich.progress import BarColumn, Progress, TaskProgressColumn, TimeRemainingColumn
from rich.text import Text

from hexdbb.capture.realtime import give_way
from hexdbb.capture.request import RunProgress
from hexdbb.trajectory import Phase

LIVE_PERIOD_S = 0.1
"""Time between two updates of the bar, s: faster than anyone reads, slow enough to cost the loop nothing."""
PLAIN_PERIOD_S = 5.0
"""Time between two lines if stderr is not a terminal, s, so that a log file stays short; a new stage or run is printed
immediately."""


class ProgressText:
    """Formats the progress of a run; keeps the last update to compute the cycle time.

    Parameters
    ----------
    progress : RunProgress
    """

    def __init__(self, progress: RunProgress) -> None:
        self._progress = progress
        self._last_update = (time.monotonic(), 0)
        self._cycle_ms = float("nan")

    def place(self) -> str:
        """Return the present run and phase."""
        progress = self._progress
        programme = progress.programme
        if programme is None or progress.stage != "moving":
            return progress.stage
        number, index = progress.place
        phase = Phase(number).name.lower().replace("_", " ")
        if index < 0:
            return phase
        run = programme.runs[index]
        sense = "counter-clockwise" if run.direction > 0 else "clockwise"
        motion = f"circle {run.circle.id}, {sense}, {run.feed_mm_min:g} mm/min"
        return f"run {index + 1}/{len(programme.runs)}, {motion}: {phase}"

    def numbers(self) -> str:
        """Return reading, cycle time and missed cycles; empty before the first row."""
        progress = self._progress
        now_s, cycle = time.monotonic(), progress.cycle_index
        then_s, before = self._last_update
        if cycle < before:
            self._last_update = (now_s, cycle)
        elif cycle > before and now_s - then_s > LIVE_PERIOD_S / 2:
            self._cycle_ms = (now_s - then_s) / (cycle - before) * 1e3
            self._last_update = (now_s, cycle)
        if not progress.row or math.isnan(self._cycle_ms):
            return ""
        return f"reading {progress.reading_um:+.1f} µm, {self._cycle_ms:.2f} ms/cycle, {progress.missed} missed"


class _Bar(Progress):
    """A progress bar with two lines of text below it, which the bar does not shorten.

    Parameters
    ----------
    text : ProgressText
        Contents of the lines.
    console : Console
        Where to draw.
    """

    def __init__(self, text: ProgressText, console: Console) -> None:
        self._text = text
        super().__init__(BarColumn(bar_width=40), TaskProgressColumn(), TimeRemainingColumn(), console=console)

    def get_renderables(self) -> Iterator[RenderableType]:
        """Yield the bar and the two lines."""
        yield self.make_tasks_table(self.tasks)
        yield Text(self._text.place(), no_wrap=True)
        yield Text(self._text.numbers(), no_wrap=True)


@contextmanager
def display(progress: RunProgress, console: Console) -> Iterator[None]:
    """Show progress and notes on a console, for the length of the context."""
    finished = threading.Event()
    target = _live if console.is_terminal else _plain
    thread = threading.Thread(target=target, args=(progress, console, finished), name="hexdbb-display", daemon=True)
    thread.start()
    try:
        yield
    finally:
        finished.set()
        thread.join()


def _live(progress: RunProgress, console: Console, finished: threading.Event) -> None:
    give_way()
    with _Bar(ProgressText(progress), console) as bar:
        bar.live.transient = True
        task = bar.add_task("", total=None)
        printed = 0
        while not finished.wait(LIVE_PERIOD_S):
            printed = _print_notes(progress, console, printed)
            bar.update(task, total=progress.rows or None, completed=progress.row)
            if progress.paused:
                bar.stop()
                while progress.paused and not finished.wait(LIVE_PERIOD_S):
                    pass
                bar.start()
    _print_notes(progress, console, printed)


def _plain(progress: RunProgress, console: Console, finished: threading.Event) -> None:
    give_way()
    text = ProgressText(progress)
    last, printed, due_s = "", 0, 0.0
    while not finished.wait(LIVE_PERIOD_S):
        printed = _print_notes(progress, console, printed)
        place = text.place()
        heading = place.partition(":")[0]
        if heading != last or time.monotonic() >= due_s:
            share = f"{100 * progress.row / progress.rows:3.0f} %  " if progress.rows else ""
            numbers = text.numbers()
            console.print(f"{share}{place}" + (f"  {numbers}" if numbers else ""), highlight=False, soft_wrap=True)
            last, due_s = heading, time.monotonic() + PLAIN_PERIOD_S
    _print_notes(progress, console, printed)


def _print_notes(progress: RunProgress, console: Console, printed: int) -> int:
    """Print the notes not printed yet; return the number printed so far."""
    for note in progress.notes[printed:]:
        console.print(f"note: {note}", highlight=False, soft_wrap=True)
    return len(progress.notes)
