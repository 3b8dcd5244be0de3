"""Checks made after every SYNC: a table of functions, each of which may find a fault.

A fault has one outcome: all six axes stop together (`AxisGroup.stop`), the captured samples are kept, the cause is
named. A new check is a new entry of `CHECKS`. They run in order and the first fault found is reported, so causes stand
before their consequences.
Source: CiA 402 (statusword 6041h, mode display 6061h, position 6064h), CiA 404 (process value 6130h, status 6150h), CiA
301 (EMCY, heartbeat).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import sub

from hexdbb.capture.blame import blamed, controller_missed, drives_time_out, half_a_cycle, never
from hexdbb.capture.cia402 import (
    CYCLIC_SYNCHRONOUS_POSITION,
    FOLLOWING_ERROR,
    FOLLOWS_COMMAND,
    HOMED,
    INTERNAL_LIMIT,
    DriveState,
    state_of,
)
from hexdbb.capture.exchange import GAUGE_SLOT
from hexdbb.capture.lag import EVERY, MEMORY
from hexdbb.capture.supervision import NMT_OPERATIONAL
from hexdbb.capture.watch import Fault, Watch

GAUGE_STATUS_BITS = {0: "not valid", 1: "positive overload", 2: "negative overload"}
"""Meaning of the bits of object 6150h (CiA 404)."""

MAX_REPEATED = 10
"""Answers too many in one run: CAN may repeat a frame whose last bit was disturbed, once in a long while. Each costs
the samples not yet confirmed."""

ENABLED_MASK, ENABLED_VALUE = DriveState.OPERATION_ENABLED.value


@dataclass(frozen=True)
class Check:
    """One check.

    Attributes
    ----------
    name : str
    find : callable
        Returns a fault, or None.
    late_s : callable
        Returns the lateness (s) of this computer from which it explains such a fault; infinite where it never does.
    of_status : bool
        Whether the drives' statuswords and modes alone decide whether there is a fault.
    """

    name: str
    find: Callable[[Watch], Fault | None]
    late_s: Callable[[Watch], float] = never
    of_status: bool = False


def find_fault(watch: Watch) -> Fault | None:
    """Run all checks in order and return the first fault with its cause (`hexdbb.capture.blame`), or None.

    Statuswords and modes in which the last checks of them found no fault are not examined again until one changes.
    """
    feedback = watch.feedback
    is_new = (feedback.statusword, feedback.mode) != watch.good_status
    for check in CHECKS if is_new else CHECKS_BESIDE_STATUS:
        fault = check.find(watch)
        if fault is not None:
            return fault if check.find is _interrupted else blamed(fault, watch, check.late_s(watch))
    if is_new:
        watch.good_status = (list(feedback.statusword), list(feedback.mode))
    return None


def _interrupted(watch: Watch) -> Fault | None:
    return Fault("hexdbb-run", watch.interrupts.requested) if watch.interrupts.requested else None


def _stall(watch: Watch) -> Fault | None:
    if watch.stalled > watch.max_stall:
        return Fault("controller", f"stalled for {watch.stalled} cycles (expected at most {watch.max_stall})")
    if watch.missed > watch.max_missed:
        return Fault("controller", f"{watch.missed} cycles missed so far (expected at most {watch.max_missed})")
    return None


def _flood(watch: Watch) -> Fault | None:
    if watch.feedback.flooded < watch.supervision.silent_after:
        return None
    expected = "all frames read before the next SYNC"
    return Fault("bus", f"flooded with frames for {watch.feedback.flooded} consecutive SYNCs (expected {expected})")


def _answers(watch: Watch) -> Fault | None:
    if not watch.feedback.missing:
        return None
    silent = watch.supervision.silent()
    if not silent:
        return None
    limit = watch.supervision.silent_after
    if len(silent) == len(watch.labels):
        return Fault("bus", f"no node answered {limit} consecutive SYNCs (expected TPDO1 of every node)")
    what = f"TPDO1 missing after {limit} consecutive SYNCs{watch.lateness(silent[0])} (expected one after every SYNC)"
    return Fault(watch.labels[silent[0]], what)


def _wrong_length(watch: Watch) -> Fault | None:
    wrong = watch.feedback.wrong_length
    if wrong is None:
        return None
    slot, found, expected = wrong
    return Fault(watch.labels[slot], f"TPDO1 has {found} bytes (expected {expected}, as mapped in 1A00h)")


def _foreign_sync(watch: Watch) -> Fault | None:
    count = watch.supervision.foreign_syncs
    if not count:
        return None
    number = watch.supervision.foreign_number
    numbered = "" if number is None else f", counter {number}"
    what = f"{count} SYNC of another producer{numbered} (expected SYNC 080h from this controller only)"
    return Fault("bus", what, count)


def _repeated(watch: Watch) -> Fault | None:
    if watch.repeated <= MAX_REPEATED or watch.last_repeated is None:
        return None
    what = f"{watch.repeated} answers too many so far (expected one TPDO1 after every SYNC; is a node id used twice?)"
    return Fault(watch.labels[watch.last_repeated], what)


def _drive_states(watch: Watch) -> Fault | None:
    for slot, word in enumerate(watch.feedback.statusword):
        if word & ENABLED_MASK != ENABLED_VALUE:
            what = f"object 6041:00 is {word:04X}h, {state_of(word).label}{watch.supervision.reason(slot)}"
            return Fault(watch.labels[slot], f"{what} (expected operation enabled)")
    return None


def _emergencies(watch: Watch) -> Fault | None:
    for node, emergency in watch.supervision.emergencies.items():
        label = watch.labels[watch.supervision.nodes.index(node)]
        return Fault(label, f"{emergency} (expected none)")
    return None


def _malformed(watch: Watch) -> Fault | None:
    for node, wrong in watch.supervision.malformed.items():
        where = watch.labels[watch.supervision.nodes.index(node)] if node else "bus"
        return Fault(where, wrong)
    return None


def _nmt_states(watch: Watch) -> Fault | None:
    for node, state in watch.supervision.nmt_states.items():
        if state != NMT_OPERATIONAL:
            label = watch.labels[watch.supervision.nodes.index(node)]
            return Fault(label, f"heartbeat reports NMT state {state} (expected {NMT_OPERATIONAL}, operational)")
    return None


def _modes(watch: Watch) -> Fault | None:
    for slot, mode in enumerate(watch.feedback.mode):
        if mode != CYCLIC_SYNCHRONOUS_POSITION:
            what = f"object 6061:00 is {mode} (expected {CYCLIC_SYNCHRONOUS_POSITION}, cyclic synchronous position)"
            return Fault(watch.labels[slot], what)
    return None


def _status_bits(watch: Watch) -> Fault | None:
    for slot, word in enumerate(watch.feedback.statusword):
        if word & (FOLLOWING_ERROR | INTERNAL_LIMIT):
            meaning = "following error" if word & FOLLOWING_ERROR else "internal limit active"
            return Fault(watch.labels[slot], f"object 6041:00 is {word:04X}h, {meaning} (expected that bit clear)")
    return None


def _lasting_bits(watch: Watch) -> Fault | None:
    for slot, word in enumerate(watch.feedback.statusword):
        if not (word & HOMED and word & FOLLOWS_COMMAND):
            bit, meaning = (
                (FOLLOWS_COMMAND, "does not follow its target") if word & HOMED else (HOMED, "no longer homed")
            )
            what = f"object 6041:00 is {word:04X}h, {meaning} (expected bit {bit.bit_length() - 1} set)"
            return Fault(watch.labels[slot], what)
    return None


def _jump(watch: Watch) -> Fault | None:
    # First what has come back: it is the sample before this one that was wrong.
    spike = watch.plausibility.position_spike()
    if spike is not None:
        slot, off_mm, limit_mm, cycles = spike
        what = f"object 6064:00 jumped by {off_mm:+.3f} mm and back (expected at most {limit_mm:.3f} mm)"
        return Fault(watch.labels[slot], what, cycles)
    found = watch.plausibility.jump()
    if found is None:
        return None
    slot, step_mm, limit_mm = found
    what = f"object 6064:00 jumped by {step_mm:+.3f} mm in one SYNC (expected at most {limit_mm:.3f} mm)"
    return Fault(watch.labels[slot], what)


def _shifted(watch: Watch) -> Fault | None:
    found = watch.plausibility.lag.shifted()
    if found is None:
        return None
    slot, lag, expected = found
    what = f"object 6064:00 lags {lag:.1f} cycles behind its targets (expected {expected:.1f}, as at first)"
    return Fault(watch.labels[slot], f"{what}: its answers are another SYNC's", MEMORY + EVERY)


def _lost_reading(watch: Watch) -> Fault | None:
    missing = watch.feedback.missing
    if watch.real_time or not watch.gauge_watched or GAUGE_SLOT not in missing or len(missing) == len(watch.labels):
        return None
    what = "TPDO1 missing after a SYNC in lockstep, where a later answer could be the one to it"
    return Fault(watch.labels[GAUGE_SLOT], f"{what} (expected one after every SYNC)")


def _reading_changes(watch: Watch) -> Fault | None:
    if not watch.gauge_watched:
        return None
    label, plausibility = watch.labels[GAUGE_SLOT], watch.plausibility
    spike = plausibility.spike()
    if spike is not None:
        off_um, limit_um = spike
        jumped = f"jumped by {off_um:+.1f} µm (expected at most {limit_um:.1f} µm)"
        stuck = plausibility.left_behind()
        if stuck is not None:
            slot, behind_mm = stuck
            what = f"object 6064:00 fell {behind_mm:.3f} mm behind its target in one SYNC, and the reading {jumped}"
            return Fault(watch.labels[slot], what, 1)
        return Fault(label, f"object 6130:01 {jumped}", 1)
    if plausibility.is_frozen():
        same = plausibility.same
        what = f"object 6130:01 is {watch.feedback.reading_um:.1f} µm, unchanged for {same} SYNCs"
        return Fault(
            label,
            f"{what} (expected noise; plan file gauge.noise_um = 0 for a gauge without)",
            plausibility.same_cycles,
        )
    return None


def _following(watch: Watch) -> Fault | None:
    if not watch.feedback.settled:
        return None
    window = watch.window
    if max(map(abs, map(sub, watch.expected, watch.feedback.position))) <= window:
        return None
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
    Check("loop stall", _stall, half_a_cycle),
    Check("flood", _flood),
    Check("length of answers", _wrong_length),
    Check("answers", _answers, half_a_cycle),
    Check("SYNC of others", _foreign_sync),
    Check("lost reading", _lost_reading),
    Check("drive states", _drive_states, controller_missed, of_status=True),
    Check("modes", _modes, of_status=True),
    Check("emergencies", _emergencies, controller_missed),
    Check("malformed frames", _malformed),
    Check("NMT states", _nmt_states, controller_missed),
    Check("heartbeats", _heartbeats, drives_time_out),
    Check("status bits", _status_bits, of_status=True),
    Check("lasting bits", _lasting_bits, of_status=True),
    Check("following error", _following),
    Check("jump of a position", _jump),
    Check("lag of a position", _shifted),
    Check("gauge", _gauge),
    Check("changes of the reading", _reading_changes),
    Check("answers too many", _repeated),
]
"""Checks of every cycle, causes before consequences."""
CHECKS_BESIDE_STATUS = [check for check in CHECKS if not check.of_status]
"""Those of them that depend on more than statuswords and modes."""
