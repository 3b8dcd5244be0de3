"""In lockstep the samples do not depend on time: nodes that are held up for a while cost none of them."""

from __future__ import annotations

from collections import deque

import can
import pytest
from tests.python.capture.scripted_bus import ScriptedBus, axes_on

from hexdbb.capture.exchange import Feedback
from hexdbb.capture.loop import STALL_PATIENCE
from hexdbb.capture.targets_ahead import Row
from hexdbb.trajectory import Phase

ROWS = 20
HELD_UP = 5
"""SYNC of the capture at which nodes are held up."""


class HeldUpBus(ScriptedBus):
    """Answers to some SYNCs are late: the first by a number of waits that end with none, others come with a later SYNC.

    Parameters
    ----------
    looks : int
        Reads without waiting that find nothing, before the first answers come. Every wait for answers ends with one.
    arrive : str
        ``send``: these come when the controller sends next; ``recv``: when it receives next.
    """

    def __init__(self, looks: int, arrive: str) -> None:
        super().__init__()
        self.late_syncs: set[int] = set()
        self._held: deque[deque[can.Message]] = deque()
        self._looks, self._arrive = looks, arrive

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        if self._arrive == "send":
            self._come_late()
        super().send(msg, timeout)

    def recv(self, timeout: float | None = None) -> can.Message | None:
        if self._arrive == "recv":
            self._come_late()
        found = super().recv(timeout)
        if found is None and not timeout and self._held:
            self._looks -= 1
        return found

    def _answer(self) -> None:
        if self._looks < 0 and self._held:
            self.waiting += self._held.popleft()
        before, self.waiting = self.waiting, deque()
        super()._answer()
        if self.syncs - 1 in self.late_syncs:
            self._held.append(self.waiting)
            self.waiting = before
        else:
            self.waiting = before + self.waiting

    def _come_late(self) -> None:
        if self._looks == 0:
            self._looks = -1
            self.waiting += self._held.popleft()


class Kept:
    """Position of the first axis in the answers of each row."""

    def __init__(self) -> None:
        self.positions: dict[int, int] = {}
        self._uncertain: dict[int, int] = {}

    def keep(self, row: Row, feedback: Feedback) -> None:
        self._uncertain[row.index] = feedback.position[0]

    def settle(self, paired: bool, held: int) -> None:
        if paired:
            self.positions |= self._uncertain
        self._uncertain.clear()

    def pause(self) -> None:
        pass


def followed(bus: HeldUpBus, late: int) -> dict[int, int]:
    """Follow targets that go on by one count a row while answers to `late` SYNCs are late; return what is kept."""
    axes, kept = axes_on(bus), Kept()
    axes.read_positions()
    axes.enable()
    bus.late_syncs = {bus.syncs + HELD_UP + each for each in range(late)}
    axes.follow([Row(row, [row] * 6, Phase.APPROACH, -1, False, [0.0] * 9) for row in range(ROWS)], kept, {})
    return kept.positions


EXPECTED = {row: min(row + 1, ROWS - 1) for row in range(ROWS)}
"""The scripted drives obey before they answer: a row's answers are those to the SYNC after it, with the next target."""


@pytest.mark.parametrize("arrive", ["send", "recv"])
@pytest.mark.parametrize("looks", [1, 2, STALL_PATIENCE])
def test_nodes_held_up_cost_no_sample(looks: int, arrive: str) -> None:
    assert followed(HeldUpBus(looks, arrive), late=1) == EXPECTED


def test_late_answers_after_a_sync_given_up_are_not_kept() -> None:
    # All waits for the first SYNC, the look before the next one, and the first wait for that end with none.
    kept = followed(HeldUpBus(looks=STALL_PATIENCE + 3, arrive="send"), late=2)
    assert kept.items() <= EXPECTED.items()
    assert {*range(HELD_UP - 1), ROWS - 1} <= kept.keys()
