"""What the user sees of a run: a live line where there is a terminal, plain lines where there is none.

A thread reads `Progress` a few times a second; the loop knows nothing of it.
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

from hexdbb.capture.request import Progress as RunProgress
from hexdbb.trajectory import Phase

LIVE_PERIOD_S = 0.1
PLAIN_PERIOD_S = 5.0
"""Time between two lines where stderr is no terminal; a new stage or run gets a line at once."""


class Words:
    """Puts progress into words; remembers what it has already said.

    Parameters
    ----------
    progress : the run's state
    """

    def __init__(self, progress: RunProgress) -> None:
        self._progress = progress
        self._at = (time.monotonic(), 0)
        self._cycle_ms = float("nan")

    def place(self) -> str:
        """Say which run is under way."""
        progress = self._progress
        programme, row = progress.programme, progress.row
        if programme is None or progress.stage != "moving":
            return progress.stage
        phase = Phase(int(programme.table.phase[row])).name.lower().replace("_", " ")
        index = int(programme.table.run[row])
        if index < 0:
            return phase
        run = programme.runs[index]
        sense = "counter-clockwise" if run.direction > 0 else "clockwise"
        number = f"run {index + 1}/{len(programme.runs)}"
        return f"{number}, circle {run.circle.id}, {sense}, {run.feed_mm_min:g} mm/min: {phase}"

    def numbers(self) -> str:
        """Say what the loop measures; nothing before it has."""
        progress = self._progress
        now_s, slot = time.monotonic(), progress.slot
        then_s, before = self._at
        if slot < before:
            self._at = (now_s, slot)
        elif slot > before and now_s - then_s > LIVE_PERIOD_S / 2:
            self._cycle_ms = (now_s - then_s) / (slot - before) * 1e3
            self._at = (now_s, slot)
        if not progress.row or math.isnan(self._cycle_ms):
            return ""
        return f"reading {progress.reading_um:+.1f} µm, {self._cycle_ms:.2f} ms/cycle, {progress.missed} missed"


class _Bar(Progress):
    """A progress bar with two lines of words below it, none of them cut off by the bar.

    Parameters
    ----------
    words : what the lines say
    console : where
    """

    def __init__(self, words: Words, console: Console) -> None:
        self._words = words
        super().__init__(BarColumn(bar_width=40), TaskProgressColumn(), TimeRemainingColumn(), console=console)

    def get_renderables(self) -> Iterator[RenderableType]:
        """Give the bar and the two lines."""
        yield self.make_tasks_table(self.tasks)
        yield Text(self._words.place(), no_wrap=True)
        yield Text(self._words.numbers(), no_wrap=True)


@contextmanager
def display(progress: RunProgress, console: Console) -> Iterator[None]:
    """Show progress on a console while inside; notes are printed as they come."""
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
    with _Bar(Words(progress), console) as bar:
        bar.live.transient = True
        task = bar.add_task("", total=None)
        said = 0
        while not finished.wait(LIVE_PERIOD_S):
            said = _print_notes(progress, console, said)
            bar.update(task, total=progress.rows or None, completed=progress.row)
            if progress.paused:
                bar.stop()
                while progress.paused and not finished.wait(LIVE_PERIOD_S):
                    pass
                bar.start()
    _print_notes(progress, console, said)


def _plain(progress: RunProgress, console: Console, finished: threading.Event) -> None:
    words = Words(progress)
    last, said, due_s = "", 0, 0.0
    while not finished.wait(LIVE_PERIOD_S):
        said = _print_notes(progress, console, said)
        place = words.place()
        heading = place.partition(":")[0]
        if heading != last or time.monotonic() >= due_s:
            share = f"{100 * progress.row / progress.rows:3.0f} %  " if progress.rows else ""
            numbers = words.numbers()
            console.print(f"{share}{place}" + (f"  {numbers}" if numbers else ""), highlight=False, soft_wrap=True)
            last, due_s = heading, time.monotonic() + PLAIN_PERIOD_S
    _print_notes(progress, console, said)


def _print_notes(progress: RunProgress, console: Console, said: int) -> int:
    """Print the notes not said yet; returns how many have been said."""
    for note in progress.notes[said:]:
        console.print(f"note: {note}", highlight=False, soft_wrap=True)
    return len(progress.notes)
