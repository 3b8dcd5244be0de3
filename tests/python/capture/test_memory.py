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

    def pause(self) -> None:
        """Have nothing to write."""


def held_bytes() -> int:
    """Return the memory that the controller and python-can hold; threads of other tests allocate too."""
    own = [tracemalloc.Filter(True, f"*/{package}/*") for package in ("hexdbb", "can")]
    return sum(int(each.size) for each in tracemalloc.take_snapshot().filter_traces(own).traces)


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
        before = held_bytes()
        axes.follow(at_rest(CYCLES), NoRows(), {})
        after = held_bytes()
    finally:
        tracemalloc.stop()
    assert after - before < GROWTH_BYTES
