"""Is a cycle rate safe on this computer, and what to change where it is not.

Rule: a SYNC later than half a cycle is left out, and answers later than three quarters of it are missing (`Deadlines`).
A rate is safe where neither happens to more than `LEFT_OUT` of the cycles, and no delay comes near the time after which
drives stop for lack of targets.
Source of the advice: sched(7), limits.conf(5), kernel parameters isolcpus, PREEMPT_RT, cpufreq, tc(8).
"""

from __future__ import annotations

import os
import resource
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from hexdbb.capture.clock import Deadlines
from hexdbb.capture.latency import Latency, shown_ms
from hexdbb.capture.lateness import is_virtual
from hexdbb.capture.realtime import FIFO_PRIORITY

LEFT_OUT = 0.001
"""Largest share of SYNCs that may be left out, or of answers that may be missing: a tenth of what a complete record may
lack, so that a run of another minute stays complete."""
STALL_SHARE = 0.5
"""Largest delay, as a share of the time after which drives stop for lack of targets (1400h:05): a minute does not show
the longest delay of an hour, which is usually some times longer."""
RATES_HZ = (1000, 500, 400, 250, 200, 125, 100, 50, 40, 25, 20, 10)
"""Rates that may be proposed: their periods fit object 60C2h."""
SHORT_QUEUE = 32
"""Frames below which the send queue of a CAN interface may overflow: two cycles of six targets, SYNC and heartbeat."""
SYSTEM = Path("/sys")


@dataclass(frozen=True)
class Verdict:
    """Whether a rate is safe.

    Attributes
    ----------
    safe : bool
    said : str
        The judgement with its reason, for people.
    safe_rate_hz : int or None
        Highest rate that is safe, none above the one asked for; None where no rate is.
    """

    safe: bool
    said: str
    safe_rate_hz: int | None


def judged(latency: Latency, rate_hz: float, stall_s: float) -> Verdict:
    """Judge a rate by measured latencies.

    Parameters
    ----------
    latency : Latency
        `answered` may be empty where no node was asked.
    rate_hz : float
        Asked rate.
    stall_s : float
        Time after which drives stop for lack of targets, s.
    """
    problems = list(_problems(latency, rate_hz, stall_s))
    slower = [rate for rate in RATES_HZ if rate <= rate_hz and not any(_problems(latency, rate, stall_s))]
    safe_rate_hz = max(slower, default=None)
    if not problems:
        return Verdict(True, f"{rate_hz:g} Hz is safe", safe_rate_hz)
    instead = f"{safe_rate_hz} Hz would be safe" if safe_rate_hz else "no lower rate would be safe"
    return Verdict(False, f"{rate_hz:g} Hz is not safe: {'; '.join(problems)}; {instead}", safe_rate_hz)


def _problems(latency: Latency, rate_hz: float, stall_s: float) -> Iterator[str]:
    """Yield what is wrong with a rate."""
    cycle_s, late, answered = 1.0 / rate_hz, latency.late, latency.answered
    left_out = late.share_above(Deadlines.LATEST * cycle_s)
    if left_out > LEFT_OUT:
        yield f"{_percent(left_out)} of wake-ups later than half a cycle, {shown_ms(Deadlines.LATEST * cycle_s)}"
    if late.longest_s > STALL_SHARE * stall_s:
        yield (
            f"a delay of {shown_ms(late.longest_s)}, where drives stop after {shown_ms(stall_s)} without targets"
            f" (expected at most {shown_ms(STALL_SHARE * stall_s)})"
        )
    unanswered = answered.share_above(Deadlines.ANSWER_SHARE * cycle_s)
    if unanswered > LEFT_OUT:
        yield f"{_percent(unanswered)} of answers later than {shown_ms(Deadlines.ANSWER_SHARE * cycle_s)} after SYNC"


def _percent(share: float) -> str:
    return f"{share:.1%}" if share >= LEFT_OUT else f"{share:.2%}"


def advice(refused: list[str], interface: str | None = None) -> list[str]:
    """Return what may make this computer faster to wake, what counts most first.

    Parameters
    ----------
    refused : list of str
        Requests that the system did not grant, from `real_time_process`.
    interface : str, optional
        CAN interface of SocketCAN, for example ``can0``.
    """
    found = []
    if any("SCHED_FIFO" in each for each in refused):
        found.append(
            f"permit real-time scheduling: in /etc/security/limits.conf '@realtime - rtprio {FIFO_PRIORITY}', your user"
            " in the group realtime, then log in again"
        )
    if any("mlockall" in each for each in refused):
        limit = resource.getrlimit(resource.RLIMIT_MEMLOCK)[0]
        at_present = "" if limit == resource.RLIM_INFINITY else f" (now {limit // 1024} kB)"
        found.append(f"permit locked memory: '@realtime - memlock unlimited' in the same file{at_present}")
    if _text("kernel/realtime") != "1":
        found.append("use a kernel with PREEMPT_RT (Debian: linux-image-rt-amd64); this one is without")
    governor = _text("devices/system/cpu/cpu0/cpufreq/scaling_governor")
    if governor not in ("", "performance"):
        found.append(f"set the power governor to performance (now {governor}): cpupower frequency-set -g performance")
    cores = os.cpu_count() or 1
    if cores > 1 and not _text("devices/system/cpu/isolated"):
        last = cores - 1
        found.append(
            f"keep a core free: kernel parameter isolcpus={last}, and start with: taskset -c {last} hexdbb-run"
        )
    queue = _text(f"class/net/{interface}/tx_queue_len") if interface else ""
    if queue.isdecimal() and int(queue) < SHORT_QUEUE:
        found.append(f"lengthen the send queue of {interface} (now {queue}): ip link set {interface} txqueuelen 1000")
    if is_virtual():
        found.append("use a computer of its own: this is a virtual machine, whose host may stop it at any moment")
    found.append("end other programs, browsers first; they compete for processor and disk")
    return found


def _text(path: str) -> str:
    """Return a value that the kernel states, empty where it states none."""
    try:
        return (SYSTEM / path).read_text(encoding="ascii", errors="replace").strip()
    except OSError:
        return ""


def words(latency: Latency, verdict: Verdict) -> str:
    """Return latencies and verdict for people, on one line."""
    answered = f"; answers after {latency.answered.words()}" if latency.answered.count else ""
    return f"real time: SYNC late by {latency.late.words()}{answered}: {verdict.said}"
