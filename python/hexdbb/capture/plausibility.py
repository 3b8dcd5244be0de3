"""Are the answers to successive SYNCs such as a machine can give? History of positions and readings, and their limits.

An answer may be well-formed and wrong: a gauge that repeats its last reading, an encoder that jumps and comes back, a
reading disturbed once. Each would be recorded as an error of the machine.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from operator import mul, sub

from hexdbb.capture.exchange import Feedback
from hexdbb.capture.lag import LagWatch
from hexdbb.record.plausibility import NOISE_SIGMAS, SPIKE_UM

SLOWEST_LOOP_S = 0.1
"""Largest time constant of a position loop, s: twice that of a gain of 1 m/min per mm (17 /s, 60 ms), the lowest in use
on machine tools. By it a change of the commanded velocity becomes a change of the following error."""
DISTURBANCE_MM = 0.1
"""Change of the following error between two SYNCs that friction and load may cause beside, mm: twenty times that of a
reversal with stiction (some micrometres), far below what a lost or doubled encoder word makes."""
AFTER_REVERSAL = 5
"""SYNCs after a reversal of any slider in which the reading may step: play is taken up, stiction ends."""
SPIKE_SHARE = 0.3
"""Share of a possible change of the following error that no loop makes within one SYNC and takes back within the next:
a loop so fast has a time constant of a cycle at most, at 50 Hz a fifth of the slowest."""
COMMANDED_SYNCS = 50
"""SYNCs over which a change of the commanded velocity acts on: 0.2 s at 250 Hz, two of the slowest time constants."""


@dataclass
class Plausibility:
    """History of the answers, as far as the checks need it.

    Attributes
    ----------
    counts_per_mm : float
        Encoder scale.
    cycle_s : float
        SYNC period, s.
    velocity_mm_s : float
        Largest velocity of a slider.
    ball_mm_s : float
        Largest velocity of the ball: no reading changes faster.
    noise_um : float
        Standard deviation of one reading; 0 where it is not stated.
    repeats : int
        Unchanged readings from which the gauge is frozen.
    reading_step_um : float
        Largest change of the reading that is no smooth motion's, away from reversals.
    same : int
        Unchanged readings so far.
    same_cycles : int
        Cycles since the reading last changed, those missed counted.
    lag : LagWatch
        Lag of each axis.
    """

    counts_per_mm: float
    cycle_s: float
    velocity_mm_s: float
    ball_mm_s: float
    noise_um: float
    repeats: int
    reading_step_um: float = SPIKE_UM
    same: int = 0
    same_cycles: int = 0
    lag: LagWatch = field(init=False)
    _before: tuple[list[int], list[int]] | None = None
    _position_steps: list[int] = field(default_factory=list)
    _error_steps: list[int] = field(default_factory=list)
    _recent: deque[list[int]] = field(default_factory=lambda: deque(maxlen=3))
    _errors: deque[tuple[int, list[int]]] = field(default_factory=lambda: deque(maxlen=3))
    _cycle: int = 0
    _targets: list[int] | None = None
    _target_steps: list[int] | None = None
    _accelerations: deque[float] = field(default_factory=lambda: deque(maxlen=COMMANDED_SYNCS))
    _readings: deque[float] = field(default_factory=lambda: deque(maxlen=3))
    _last_um: float | None = None
    _since_reversal: int = 0

    def __post_init__(self) -> None:
        self.lag = LagWatch(self.counts_per_mm)

    def update(self, feedback: Feedback, expected: list[int], missed: int, gauge_watched: bool) -> None:
        """Take in the answers to a SYNC.

        Parameters
        ----------
        feedback : Feedback
        expected : list of int
            Targets that the positions belong to, counts, shape (6,).
        missed : int
            Cycles missed before the SYNC.
        gauge_watched : bool
            Whether the bar is mounted and the ball on its circle.
        """
        self._command(expected, missed)
        self._position_steps, self._error_steps = [], []
        self._cycle += 1 + missed
        if not feedback.settled or missed:
            self._before = None
            self._readings.clear()
        errors = list(map(sub, expected, feedback.position))
        if feedback.settled:
            if self._before is not None:
                positions, before = self._before
                self._position_steps = list(map(sub, feedback.position, positions))
                self._error_steps = list(map(sub, errors, before))
                self._recent.append(self._error_steps)
            self._before = (list(feedback.position), errors)
            self._errors.append((self._cycle, errors))
            if not gauge_watched:
                self.lag.pause()
            elif self._target_steps is not None:
                self.lag.update(self._target_steps, errors)
            self._read(feedback.reading_um, 1 + missed, gauge_watched)

    def _command(self, expected: list[int], missed: int) -> None:
        if self._targets is not None:
            steps = list(map(sub, expected, self._targets))
            if missed:
                # The target stood still for the cycles missed: the drives stopped and started again.
                self._accelerations.append(max(map(abs, steps)) / self.cycle_s)
            if self._target_steps is not None:
                before = self._target_steps
                self._accelerations.append(max(map(abs, map(sub, steps, before))) / self.cycle_s)
                # Most often no axis turns or rests, which the signs of six products tell.
                turned = min(map(mul, steps, before)) <= 0 and any(
                    a * b <= 0 and a != b for a, b in zip(steps, before, strict=True)
                )
                self._since_reversal = 0 if turned else self._since_reversal + 1
            self._target_steps = steps
        self._targets = list(expected)

    def _read(self, reading_um: float, cycles: int, gauge_watched: bool) -> None:
        if not gauge_watched:
            self._readings.clear()
            self._last_um = None
        # A gauge that is stuck stays so while cycles are missed.
        repeats = self._last_um == reading_um
        self.same = self.same + 1 if repeats else 0
        self.same_cycles = self.same_cycles + cycles if repeats else 0
        if gauge_watched:
            self._last_um = reading_um
            self._readings.append(reading_um)

    def jump(self) -> tuple[int, float, float] | None:
        """Return the slot of a position that jumped, its step and the limit (mm), or None."""
        scale = abs(self.counts_per_mm)
        limit = 1.1 * self.velocity_mm_s * self.cycle_s * scale + 2.0
        if max(map(abs, self._position_steps), default=0) > limit:
            slot, step = next((slot, step) for slot, step in enumerate(self._position_steps) if abs(step) > limit)
            return slot, step / self.counts_per_mm, limit / scale
        largest, disturbed = max(map(abs, self._error_steps), default=0), DISTURBANCE_MM * scale + 2.0
        # What a disturbance may cause is within the limit in any motion.
        if largest <= disturbed or largest <= (follows := self._follows() + disturbed):
            return None
        for slot, (step, moved) in enumerate(zip(self._error_steps, self._position_steps, strict=True)):
            # A slider that jams lags behind more and more; one that jumps moves.
            if abs(step) > follows and abs(moved) > follows:
                return slot, -step / self.counts_per_mm, follows / scale
        return None

    def position_spike(self) -> tuple[int, float, float, int] | None:
        """Return a position that jumped and came back, or None: slot, size and limit (mm), cycles since.

        The following error of the last SYNC but one against its neighbours. Cycles missed or without an answer between
        them hide no such jump: targets stand still for them, and the error stays what it is or falls.
        """
        if len(self._errors) < 3:
            return None
        (_, first), (at, middle), (now, last) = self._errors
        scale = abs(self.counts_per_mm)
        disturbed, largest = DISTURBANCE_MM * scale + 2.0, max(map(abs, map(sub, last, middle)))
        # What came back by so much has moved by three quarters of it in the last SYNC at least.
        if largest <= 0.75 * disturbed or largest <= 0.75 * (limit := SPIKE_SHARE * self._follows() + disturbed):
            return None
        for slot in range(len(middle)):
            off = middle[slot] - 0.5 * (first[slot] + last[slot])
            if abs(off) > limit and abs(last[slot] - first[slot]) < 0.5 * abs(off):
                return slot, -off / self.counts_per_mm, limit / scale, now - at
        return None

    def _follows(self) -> float:
        """Return the largest change of a following error by commanded motion, counts.

        The commanded acceleration acts on for a while; its sum bounds what any loop makes of it.
        """
        return SLOWEST_LOOP_S * max(self._accelerations, default=0.0)

    def left_behind(self) -> tuple[int, float] | None:
        """Return the slot of the axis that fell behind its target most of late, and by how much, mm; or None."""
        scale = abs(self.counts_per_mm)
        worst = max(((abs(step), slot) for steps in self._recent for slot, step in enumerate(steps)), default=(0, 0))
        return (worst[1], worst[0] / scale) if worst[0] > DISTURBANCE_MM * scale else None

    def spike(self) -> tuple[float, float] | None:
        """Return the size of a reading's jump that no motion makes and its limit, µm, or None.

        The last reading but one against its neighbours, or the last against what the ball can have moved, and, away
        from reversals, against the course of the two before.
        """
        if len(self._readings) < 2:
            return None
        step = self._readings[-1] - self._readings[-2]
        fastest = 1.1e3 * self.ball_mm_s * self.cycle_s + NOISE_SIGMAS * self.noise_um
        if abs(step) > fastest:
            return step, fastest
        if len(self._readings) < 3:
            return None
        first, middle, last = self._readings
        limit = max(self.reading_step_um, NOISE_SIGMAS * self.noise_um)
        off = middle - 0.5 * (first + last)
        if abs(off) > limit and abs(last - first) < 0.5 * abs(off):
            return off, limit
        bend = last - 2.0 * middle + first
        if abs(bend) > limit and self._since_reversal > AFTER_REVERSAL:
            return bend, limit
        return None

    def is_frozen(self) -> bool:
        """Return whether the reading has not changed for longer than noise allows."""
        return self.same >= self.repeats
