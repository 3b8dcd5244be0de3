"""The controller's memory does not grow with the length of a run."""

from __future__ import annotations

import tracemalloc

from tests.python.capture.scripted_bus import ScriptedBus, at_rest, axes_on

from hexdbb.capture.exchange import Feedback
from hexdbb.capture.targets_ahead import Row

CYCLES = 5000
"""Growth of 8 bytes a cycle would be 40 kB."""
GROWTH_BYTES = 10_000


class Dropped(list[tuple[int, bytes]]):
    """Sent frames of the scripted bus, which itself must not grow."""

    def append(self, frame: tuple[int, bytes]) -> None:
        """Forget the frame."""


class NoRows:
    """Rows that nobody keeps."""

    def keep(self, row: Row, feedback: Feedback) -> None:
        """Forget the row."""

    def settle(self, paired: bool, held: int) -> None:
        """Have nothing to settle."""


def test_memory_does_not_grow_with_the_cycles() -> None:
    bus = ScriptedBus()
    bus.sent = Dropped()
    axes = axes_on(bus)
    axes.read_positions()
    axes.enable()
    axes.follow(at_rest(CYCLES), NoRows(), {})
    tracemalloc.start()
    try:
        axes.follow(at_rest(CYCLES), NoRows(), {})
        before, _ = tracemalloc.get_traced_memory()
        axes.follow(at_rest(CYCLES), NoRows(), {})
        after, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert after - before < GROWTH_BYTES
