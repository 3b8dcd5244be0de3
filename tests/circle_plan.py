"""The plan of tests that run `hexdbb-run`: one circle in four seconds, fast, so that it takes few cycles."""

from __future__ import annotations


def circle_plan(gauge: str = "") -> str:
    """Return the text of a plan; `gauge` adds keys to its gauge, such as ``noise_um = 0.1``."""
    keys = ", ".join(filter(None, ("bar_length_mm = 100", gauge)))
    return f"""
schema = "hexdbb.plan/1"
machine = "sp120"
feeds_mm_min = [9000]
directions = [1]
laps = 1
overshoot_deg = 10
gauge = {{{keys}}}
mount = [{{id = 0, cup_mm = [0, 0, 340]}}]
circle = [{{id = 0, mount = 0, radius_mm = 100, ball_offset_mm = [0, 0, 60]}}]
"""
