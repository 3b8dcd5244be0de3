"""What is checked after every SYNC: a table of checks, each of which may find a fault.

A fault has one outcome: all six axes stop together (`stop`), what was captured is kept, the cause is named. A new
check is a new entry of `CHECKS`; they run in order, the first fault found is the cause reported, so causes stand
before consequences.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hexdbb.capture.cia402 import CYCLIC_SYNCHRONOUS_POSITION, FOLLOWING_ERROR, INTERNAL_LIMIT, State, state_of
from hexdbb.capture.exchange import GAUGE_SLOT, Feedback
from hexdbb.capture.supervision import Supervision

NMT_OPERATIONAL = 0x05
GAUGE_STATUS_BITS = {0: "not valid", 1: "positive overload", 2: "negative overload"}

ENABLED_MASK, ENABLED_VALUE = State.OPERATION_ENABLED.value


@dataclass(frozen=True)
class Fault:
    """Why all axes stop."""

    where: str
    """Node, in the user's words."""
    what: str
    """Object, value and what was expected."""

    def __str__(self) -> str:
        return f"{self.where}: {self.what}"


@dataclass
class Watch:
    """All a check may look at.

    Attributes
    ----------
    feedback : answers to the last SYNC
    supervision : what is known beside them
    labels : name of each slot's node
    expected : targets (counts) the positions of the last SYNC belong to
    window : largest following error, counts
    range_um : largest reading to either side
    gauge_watched : whether the bar is mounted and the ball on its circle
    stalled : slots missed just before the last SYNC
    missed : slots missed so far
    max_stall, max_missed : most of either
    interrupted : whether the user asked to stop
    counts_per_mm : scale of the positions
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
    gauge_watched: bool = False
    stalled: int = 0
    missed: int = 0
    interrupted: bool = False


@dataclass(frozen=True)
class Check:
    """One thing that is checked every cycle: its name and how a fault is found."""

    name: str
    find: Callable[[Watch], Fault | None]


def find_fault(watch: Watch) -> Fault | None:
    """Run every check; returns the first fault."""
    for check in CHECKS:
        fault = check.find(watch)
        if fault is not None:
            return fault
    return None


def _interrupted(watch: Watch) -> Fault | None:
    return Fault("hexdbb-run", "interrupted by the user") if watch.interrupted else None


def _stall(watch: Watch) -> Fault | None:
    if watch.stalled > watch.max_stall:
        return Fault("controller", f"held up for {watch.stalled} cycles (expected at most {watch.max_stall})")
    if watch.missed > watch.max_missed:
        return Fault("controller", f"{watch.missed} cycles missed so far (expected at most {watch.max_missed})")
    return None


def _answers(watch: Watch) -> Fault | None:
    if not watch.feedback.missing:
        return None
    gone = watch.supervision.silent()
    if not gone:
        return None
    limit = watch.supervision.silent_after
    if len(gone) == len(watch.labels):
        return Fault("bus", f"no node has answered {limit} SYNCs in a row (expected TPDO1 of every node)")
    what = f"TPDO1 has stayed out {limit} SYNCs in a row (expected one after every SYNC)"
    return Fault(watch.labels[gone[0]], what)


def _drive_states(watch: Watch) -> Fault | None:
    for slot, word in enumerate(watch.feedback.statusword):
        if word & ENABLED_MASK != ENABLED_VALUE:
            emergency = watch.supervision.emergencies.get(watch.supervision.nodes[slot])
            reason = f", EMCY {emergency.code:04X}h" if emergency else ""
            return Fault(
                watch.labels[slot],
                f"object 6041:00 is {word:04X}h, {state_of(word).label}{reason} (expected operation enabled)",
            )
    return None


def _emergencies(watch: Watch) -> Fault | None:
    for node, emergency in watch.supervision.emergencies.items():
        label = watch.labels[watch.supervision.nodes.index(node)]
        return Fault(label, f"EMCY {emergency.code:04X}h, error register {emergency.register:02X}h (expected none)")
    return None


def _nmt_states(watch: Watch) -> Fault | None:
    for node, state in watch.supervision.nmt_states.items():
        if state != NMT_OPERATIONAL:
            label = watch.labels[watch.supervision.nodes.index(node)]
            return Fault(label, f"heartbeat says NMT state {state} (expected {NMT_OPERATIONAL}, operational)")
    return None


def _modes(watch: Watch) -> Fault | None:
    for slot, mode in enumerate(watch.feedback.mode):
        if mode != CYCLIC_SYNCHRONOUS_POSITION:
            what = f"object 6061:00 is {mode} (expected {CYCLIC_SYNCHRONOUS_POSITION}, cyclic synchronous position)"
            return Fault(watch.labels[slot], what)
    return None


def _status_bits(watch: Watch) -> Fault | None:
    for slot, word in enumerate(watch.feedback.statusword):
        for bit, meaning in ((FOLLOWING_ERROR, "following error"), (INTERNAL_LIMIT, "internal limit active")):
            if word & bit:
                return Fault(watch.labels[slot], f"object 6041:00 is {word:04X}h, {meaning} (expected that bit clear)")
    return None


def _following(watch: Watch) -> Fault | None:
    if not watch.feedback.settled:
        return None
    window = watch.window
    for slot, (target, position) in enumerate(zip(watch.expected, watch.feedback.position, strict=True)):
        if not -window <= target - position <= window:
            error_mm = (target - position) / watch.counts_per_mm
            limit_mm = window / abs(watch.counts_per_mm)
            what = f"object 6064:00 is {position} counts, {error_mm:+.3f} mm from its target"
            return Fault(watch.labels[slot], f"{what} (expected within {limit_mm:g} mm)")
    return None


def _gauge(watch: Watch) -> Fault | None:
    if not watch.gauge_watched:
        return None
    status, reading_um = watch.feedback.gauge_status, watch.feedback.reading_um
    label = watch.labels[GAUGE_SLOT]
    if status:
        meanings = [GAUGE_STATUS_BITS.get(bit, f"bit {bit}") for bit in range(8) if status >> bit & 1]
        return Fault(
            label, f"object 6150:01 is {status:02X}h, {', '.join(meanings)}, at {reading_um:.1f} µm (expected 0)"
        )
    if not abs(reading_um) <= watch.range_um:
        return Fault(label, f"object 6130:01 is {reading_um:.1f} µm (expected within ±{watch.range_um:g} µm)")
    return None


def _heartbeats(watch: Watch) -> Fault | None:
    late = watch.supervision.late_heartbeat()
    if late is None:
        return None
    slot, age_s = late
    limit_ms = 1e3 * watch.supervision.heartbeat_limit_s
    return Fault(watch.labels[slot], f"no heartbeat for {1e3 * age_s:.0f} ms (expected one within {limit_ms:.0f} ms)")


CHECKS: list[Check] = [
    Check("interrupted", _interrupted),
    Check("loop stall", _stall),
    Check("answers", _answers),
    Check("drive states", _drive_states),
    Check("modes", _modes),
    Check("emergencies", _emergencies),
    Check("NMT states", _nmt_states),
    Check("heartbeats", _heartbeats),
    Check("status bits", _status_bits),
    Check("following error", _following),
    Check("gauge", _gauge),
]
"""Checks of every cycle, causes before consequences."""
