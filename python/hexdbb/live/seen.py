"""What a page was told of a run: the last state, the traces, the largest following errors.

Filled by one thread, read by others; memory does not grow beyond `KEPT` points of each sweep of one circle.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Any

AXES = 6
KEPT = 20_000
"""Points of one sweep; the earlier half is left out of the picture beyond that. Eighty seconds at 250 Hz, several
laps, and what a browser draws in a fraction of a second."""

Message = dict[str, Any]


@dataclass
class Trace:
    """Readings of one sweep: angle (degrees) and reading (µm) of each point."""

    sweep: int
    direction: int
    points: list[tuple[float, float]] = field(default_factory=list)


@dataclass(frozen=True)
class Ring:
    """What is drawn in one polar chart: the sweeps of one circle at one feed, up to the number of points told then.

    Attributes
    ----------
    epoch : int
        Another one where what was drawn before does not stand any more.
    circle, feed_mm_min, radius_mm
        What is measured.
    largest_um : float
        Largest absolute reading.
    traces : tuple of Trace
    """

    epoch: int
    circle: int
    feed_mm_min: float
    radius_mm: float
    largest_um: float
    traces: tuple[Trace, ...]


class SeenRun:
    """A run as far as it was told.

    Attributes
    ----------
    told : dict
        The message ``begin``; empty before it.
    state : dict
        The last message ``state``; empty before it.
    ended : str or None
        How the run ended, in words; None while it goes on.
    failed : bool
        Whether it ended otherwise than complete.
    following_mm, largest_following_mm : list of float
        Largest following error of each axis among the last samples, and among all, mm, shape (6,).
    ring : Ring or None
        The circle that is being measured.
    """

    def __init__(self) -> None:
        self.told: Message = {}
        self.state: Message = {}
        self.ended: str | None = None
        self.failed = False
        self.following_mm, self.largest_following_mm = [0.0] * AXES, [0.0] * AXES
        self.ring: Ring | None = None
        self._heard_s = time.monotonic()

    @property
    def silent_s(self) -> float:
        """Time since something was told, s."""
        return time.monotonic() - self._heard_s

    def take(self, message: Message) -> None:
        """Take in one message; kinds that are not known are passed over."""
        self._heard_s = time.monotonic()
        match message.get("kind"):
            case "begin":
                self.told = message
            case "state":
                self.state = message
            case "rows":
                self._take_rows(message)
            case "end":
                self.failed = message["error"] is not None
                self.ended = message["error"] or "The run is complete"

    def lose(self) -> None:
        """Take note that nothing will be told any more."""
        if self.ended is None:
            self.failed = True
            self.ended = "The run's process ended without a word; the samples on disk are kept: hexdbb recover"

    def _take_rows(self, message: Message) -> None:
        self.following_mm = message["following_mm"]
        self.largest_following_mm = [
            max(pair) for pair in zip(self.largest_following_mm, self.following_mm, strict=True)
        ]
        ring = self.ring
        place = (message["circle"], message["feed_mm_min"])
        epoch = 0 if ring is None else ring.epoch
        if ring is None or (ring.circle, ring.feed_mm_min) != place:
            radius_mm = float(self.told.get("circles", {}).get(str(message["circle"]), 100.0))
            ring = Ring(epoch + 1, *place, radius_mm, 0.0, ())
        traces = ring.traces
        if not traces or traces[-1].sweep != message["sweep"]:
            traces = (*traces, Trace(message["sweep"], message["direction"]))
        points = traces[-1].points
        points += zip(message["angle_deg"], message["reading_um"], strict=True)
        epoch = ring.epoch
        if len(points) > KEPT:
            # Another object: a tab may be reading the one before.
            traces = (*traces[:-1], Trace(message["sweep"], message["direction"], points[-KEPT // 2 :]))
            epoch += 1
        largest_um = max(ring.largest_um, *map(abs, message["reading_um"]), 0.0)
        self.ring = Ring(epoch, *place, ring.radius_mm, largest_um, traces)
