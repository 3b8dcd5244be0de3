"""Processor time of a whole discovery, known effects and learned functions, on machines with a known fault.

Usage: discovery_times.py
A discovery runs in one thread: its processor time is what a user waits for on a machine that does nothing else.
"""

from __future__ import annotations

import statistics
import time

from hexdbb.discovery import discover
from hexdbb.model import new_model
from hexdbb.samples import Samples
from hexdbb_truth.cases import case
from hexdbb_truth.simulate import Pace

PACE = Pace(rate_hz=11.5, instants_per_sample=15, travel_s=10.0)
"""About 20,000 samples on the standard plan."""
DENSE = Pace(rate_hz=115.0, instants_per_sample=2, travel_s=10.0)
"""Ten times as many."""
CASES = (
    ("none-s1", PACE),
    ("none-s1", DENSE),
    ("backlash-x3-s1", PACE),
    ("backlash-x3-s1", DENSE),
    ("gravity_sag-x3-s1", PACE),
    ("joint_offset-x3-s1", PACE),
    ("sample_delay-x3-s1", PACE),
    ("dent-x3-s1", PACE),
    ("backlash+servo_lag-x3-s4", PACE),
    ("backlash+servo_lag-x3-s4", DENSE),
)
REPETITIONS = 3
TARGET_S = {False: 6.0, True: 1.5}
"""Limits of one call on 20,000 readings, all hypotheses and known effects alone: a user at the machine waits for it."""

HEADER = (
    "| hidden in the machine | readings | verdict | processor time | target |",
    "|---|---|---|---|---|",
)


def discovery_rows() -> list[str]:
    """Return table rows: the fault, the number of readings, the verdict, the median processor time of one call."""
    rows = [_row(name, pace, known_only=False) for name, pace in CASES]
    return rows + [_row(name, PACE, known_only=True) for name, pace in CASES[1:] if pace is PACE]


def _row(name: str, pace: Pace, *, known_only: bool) -> str:
    record = case(name, pace).record()
    model = new_model(record.machine)
    seconds = []
    for _ in range(REPETITIONS):
        begin = time.process_time()
        found = discover(Samples.of([record]), model, known_only=known_only)
        seconds.append(time.process_time() - begin)
    called = ", ".join([found.verdict, *(each.effect or each.choice for each in found.causes)])
    hidden = name.rsplit("-s", 1)[0].replace("-x3", ", three times the noise").replace("none", "nothing")
    if known_only:
        hidden += "; known effects alone"
    target = f"≤ {TARGET_S[known_only]:g} s" if pace is PACE else "ten times the row above"
    return f"| {hidden} | {len(record):,} | {called} | {statistics.median(seconds):.2f} s | {target} |"


if __name__ == "__main__":
    print("\n".join([*HEADER, *discovery_rows()]))
