"""Whose fault a fault is: this computer's, which was late, or the node's, which was silent.

Rule: what a late computer can cause is put down to it where it was late enough meanwhile and the fault is not that of a
single node among others that answered: a late computer reads what has arrived, of every node. Every other fault keeps
its name, and the message states how late the computer was, so that the reader can judge.
"""

from __future__ import annotations

import math
from dataclasses import replace

from hexdbb.capture.clock import Deadlines
from hexdbb.capture.latency import shown_ms
from hexdbb.capture.lateness import NOTED_S, WakeUp
from hexdbb.capture.watch import Fault, Watch

OWN_SHARE = 0.5
"""Share of a delay that this program must have computed to be the cause of it itself."""
LOCKSTEP_LATE_S = 0.1
"""Lateness that is named in lockstep, s: a tenth of a second of the quarter that answers have."""
CONTROLLER_MISSED = {0x8130, 0x8250}
"""EMCY codes of nodes that miss the controller: heartbeat, RPDO (CiA 301)."""
NODES_HERE = "the nodes are simulated on this computer, which may be too busy for them (in lockstep nothing is late)"
BEFORE_S = 0.1
"""Time looked back beyond the SYNCs of the fault, s: the time after which drives stop for lack of targets."""


def never(watch: Watch) -> float:
    """Return infinity: no lateness explains the fault."""
    return math.inf


def half_a_cycle(watch: Watch) -> float:
    """Return the lateness (s) from which a SYNC is left out; in lockstep one that answers do not outlast."""
    return Deadlines.LATEST * watch.cycle_s if watch.real_time else LOCKSTEP_LATE_S


def drives_time_out(watch: Watch) -> float:
    """Return the lateness (s) from which drives stop on their own for lack of targets."""
    return watch.max_stall * watch.cycle_s


def controller_missed(watch: Watch) -> float:
    """Return that lateness where nodes have reported nothing but that they missed the controller, else infinity."""
    codes = {emergency.code for emergency in watch.supervision.emergencies.values()}
    return drives_time_out(watch) if codes and codes <= CONTROLLER_MISSED else math.inf


def blamed(fault: Fault, watch: Watch, explained_s: float) -> Fault:
    """Return a fault with its cause, this computer where it was late, and how late that was.

    Parameters
    ----------
    fault : Fault
        What a check has found.
    watch : Watch
    explained_s : float
        Lateness of this computer from which it explains such a fault, s.
    """
    explained, tail = _judged(watch, explained_s)
    if explained:
        return replace(fault, where="this computer", what=f"{explained} ({fault})")
    return replace(fault, what=f"{fault.what}; {tail}") if tail else fault


def blamed_before_motion(message: str, watch: Watch) -> str:
    """Return the message about drives that did not reach a state, with its cause and how late this computer was."""
    silent = half_a_cycle(watch) if watch.supervision.silent() else math.inf
    explained, tail = _judged(watch, silent)
    if explained:
        return f"this computer: {explained} ({message})"
    return f"{message}; {tail}" if tail else message


def _judged(watch: Watch, explained_s: float) -> tuple[str, str]:
    """Return how late this computer was where that explains a fault, else what to add to its message."""
    seconds = BEFORE_S + watch.cycle_s * (watch.supervision.silent_after + watch.stalled + 1)
    worst, noticed_s = watch.computer.worst_within(seconds), half_a_cycle(watch)
    if worst.late_s >= explained_s and not is_own(worst) and not _one_of_many(watch):
        return f"was {shown_ms(worst.late_s)} late", ""
    late, is_of_time = worst.late_s >= noticed_s, watch.real_time and explained_s <= noticed_s
    tails = [said(worst, late)] if late or is_of_time else []
    tails += [NODES_HERE] if watch.nodes_here and is_of_time else []
    return "", "; ".join(tails)


def is_own(worst: WakeUp) -> bool:
    """Return whether this program itself computed during most of a delay."""
    return worst.own_s > OWN_SHARE * worst.late_s


def said(worst: WakeUp, late: bool = True) -> str:
    """Return how late this computer was, as the tail of a message."""
    if late and is_own(worst):
        return f"this program computed for {shown_ms(worst.own_s)} meanwhile"
    if late:
        return f"this computer was {shown_ms(worst.late_s)} late meanwhile"
    # What is below is not kept.
    return f"this computer was at most {shown_ms(max(worst.late_s, NOTED_S))} late meanwhile"


def _one_of_many(watch: Watch) -> bool:
    """Return whether one node alone does not answer."""
    missing = [count > 0 for count in watch.supervision.missing_in_a_row]
    return sum(missing) == 1 and not watch.stalled
