"""What the checks of a SYNC examine, and the fault that they may find."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from hexdbb.capture.exchange import Exchange, Feedback
from hexdbb.capture.interrupts import Interrupts
from hexdbb.capture.lateness import Lateness
from hexdbb.capture.plausibility import Plausibility
from hexdbb.capture.supervision import Supervision
from hexdbb.machine import MachineFile
from hexdbb.plan import Gauge
from hexdbb.record.plausibility import frozen_after

MAX_MISSED = 250
"""Largest number of cycles missed in one run: one second at 250 Hz. A computer that stalls more often is not fit for a
real-time run, and each stall leaves a gap in the samples."""


@dataclass(frozen=True)
class Fault:
    """Reason why all axes stop.

    Attributes
    ----------
    where : str
        The node, as the user knows it: ``node 3 (slider 3)``.
    what : str
        Object, value and expectation.
    doubtful : int
        Number of SYNCs before this one whose samples it makes doubtful.
    """

    where: str
    what: str
    doubtful: int = 0

    def __str__(self) -> str:
        return f"{self.where}: {self.what}"


@dataclass
class Watch:
    """The quantities that checks examine.

    Attributes
    ----------
    feedback : Feedback
        Answers to the last SYNC.
    supervision : Supervision
        EMCY messages, heartbeats and counts of missing answers.
    labels : tuple of str
        Name of the node of each slot: drives 1 to 6, gauge.
    window : int
        Largest following error, counts.
    range_um : float
        Largest absolute reading, µm.
    counts_per_mm : float
        Encoder scale.
    max_stall : int
        Largest number of cycles that may be missed in one gap.
    max_missed : int
        Largest number of cycles that may be missed in one run.
    expected : list of int
        Targets (counts) that the positions of the last SYNC belong to, shape (6,).
    plausibility : Plausibility
        History of positions and readings, and their limits.
    real_time : bool
        Whether SYNCs are sent at fixed times.
    repeated : int
        Answers too many so far.
    last_repeated : int or None
        Slot of the last one.
    gauge_watched : bool
        Whether the bar is mounted and the ball on its circle.
    stalled : int
        Cycles missed immediately before the last SYNC.
    missed : int
        Cycles missed so far.
    computer : Lateness
        How late this computer is.
    late_s : mapping of int to float
        Time from a SYNC to the last late answer of a slot, s.
    interrupts : Interrupts
        Whether a signal has asked the program to end.
    nodes_here : bool
        Whether the nodes are simulated on this computer: where it is busy, they answer late.
    good_status : tuple of two lists of int, or None
        Statuswords and modes in which the checks of them found no fault last.
    """

    feedback: Feedback
    supervision: Supervision
    labels: tuple[str, ...]
    window: int
    range_um: float
    counts_per_mm: float
    max_stall: int
    max_missed: int
    expected: list[int]
    plausibility: Plausibility
    real_time: bool = False
    repeated: int = 0
    last_repeated: int | None = None
    gauge_watched: bool = False
    stalled: int = 0
    missed: int = 0
    computer: Lateness = field(default_factory=Lateness)
    late_s: Mapping[int, float] = field(default_factory=dict)
    interrupts: Interrupts = field(default_factory=Interrupts)
    nodes_here: bool = False
    good_status: tuple[list[int], list[int]] | None = None

    @property
    def cycle_s(self) -> float:
        """Communication cycle, s."""
        return self.plausibility.cycle_s

    def lateness(self, slot: int) -> str:
        """Return how late a slot's answers come as part of a message, or an empty text."""
        late_s = self.late_s.get(slot)
        return "" if late_s is None else f", the last {1e3 * late_s:.1f} ms after its SYNC"


def watch_over(
    exchange: Exchange,
    supervision: Supervision,
    labels: tuple[str, ...],
    machine: MachineFile,
    gauge: Gauge,
    *,
    cycle_s: float,
    ball_mm_s: float,
    expected: list[int],
    real_time: bool = False,
    interrupts: Interrupts | None = None,
    computer: Lateness | None = None,
) -> Watch:
    """Return what the checks examine on a machine, with the limits of its file and of the plan's gauge.

    Parameters
    ----------
    exchange, supervision : Exchange, Supervision
        Sources of answers, EMCYs and heartbeats.
    labels : tuple of str
        Name of the node of each slot: drives 1 to 6, gauge.
    machine : MachineFile
        Limits and scale.
    gauge : Gauge
        Range, noise and resolution.
    cycle_s : float
        Communication cycle, s.
    ball_mm_s : float
        Largest feed of the ball, mm/s.
    expected : list of int
        Targets (counts) that the positions of the last SYNC belong to, shape (6,); updated by the caller.
    real_time : bool
        Whether SYNCs are sent at fixed times.
    interrupts : Interrupts, optional
        Whether a signal has asked the program to end.
    computer : Lateness, optional
        How late this computer is.
    """
    can_setup = machine.can_setup
    limits = can_setup.limits
    return Watch(
        feedback=exchange.feedback,
        supervision=supervision,
        labels=labels,
        window=round(limits.following_error_mm * abs(can_setup.counts_per_mm)),
        range_um=min(limits.gauge_range_um, gauge.range_um),
        counts_per_mm=can_setup.counts_per_mm,
        max_stall=int(can_setup.rpdo_timeout_ms / 1000.0 / cycle_s),
        max_missed=MAX_MISSED,
        expected=expected,
        plausibility=Plausibility(
            counts_per_mm=can_setup.counts_per_mm,
            cycle_s=cycle_s,
            velocity_mm_s=limits.velocity_mm_s,
            ball_mm_s=ball_mm_s,
            noise_um=gauge.noise_um or 0.0,
            repeats=frozen_after(gauge),
            reading_step_um=limits.gauge_step_um,
        ),
        real_time=real_time,
        late_s=exchange.late_s,
        interrupts=Interrupts() if interrupts is None else interrupts,
        computer=Lateness() if computer is None else computer,
    )
