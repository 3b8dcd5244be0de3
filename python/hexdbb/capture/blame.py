"""Whose fault a fault is: this computer's, which was late, or the node's, which was silent.

Rule: what a late computer can cause is put down to it where it was late enough meanwhile and the fault is not that of a
single node among others that answered: a late computer reads what has arrived, of every node. Every other fault keeps
its name, and the message states how late the computer was, so that the reader can judge.
"""

from __future__ import annotations

from dataclasses import replace

from hexdbb.capture.clock import Deadlines
from hexdbb.capture.latency import shown_ms
from hexdbb.capture.lateness import WakeUp
from hexdbb.capture.watch import Fault, Watch

OWN_SHARE = 0.5
"""Share of a delay that this program must have computed to be the cause of it itself."""
LOCKSTEP_LATE_S = 0.1
"""Lateness that is named in lockstep, s: a tenth of a second of the quarter that answers have."""
BEFORE_S = 0.1
"""Time looked back beyond the SYNCs of the fault, s: the time after which drives stop for lack of targets."""


def blamed(fault: Fault, watch: Watch, by_lateness: bool) -> Fault:
    """Return a fault with its cause, this computer where it was late, and how late that was.

    Parameters
    ----------
    fault : Fault
        What a check has found.
    watch : Watch
    by_lateness : bool
        Whether a late computer can cause such a fault.
    """
    seconds = BEFORE_S + watch.cycle_s * (watch.supervision.silent_after + watch.stalled + 1)
    worst = watch.computer.worst_within(seconds)
    enough_s = Deadlines.LATEST * watch.cycle_s if watch.real_time else LOCKSTEP_LATE_S
    late = worst.late_s >= enough_s
    if by_lateness and late and not is_own(worst) and not _one_of_many(watch):
        return replace(fault, where="this computer", what=f"was {shown_ms(worst.late_s)} late ({fault})")
    if late or (by_lateness and watch.real_time):
        return replace(fault, what=f"{fault.what}; {said(worst, late)}")
    return fault


def is_own(worst: WakeUp) -> bool:
    """Return whether this program itself computed during most of a delay."""
    return worst.own_s > OWN_SHARE * worst.late_s


def said(worst: WakeUp, late: bool = True) -> str:
    """Return how late this computer was, as the tail of a message."""
    if late and is_own(worst):
        return f"this program computed for {shown_ms(worst.own_s)} meanwhile"
    return f"this computer was {'' if late else 'at most '}{shown_ms(worst.late_s)} late meanwhile"


def _one_of_many(watch: Watch) -> bool:
    """Return whether one node alone does not answer."""
    missing = [count > 0 for count in watch.supervision.missing_in_a_row]
    return sum(missing) == 1 and not watch.stalled
