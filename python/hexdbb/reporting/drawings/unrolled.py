"""The residual of one circle at one feed against the commanded polar angle, both directions, reversals marked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from hexdbb.charts import screened
from hexdbb.charts.lines import NEAR_DEG, curve, near, residual_path, smoothed
from hexdbb.comparison import CircleComparison
from hexdbb.comparison.circles import SHORT_DIRECTION_NAMES
from hexdbb.comparison.reversals import Reversal
from hexdbb.reporting.drawings.axes import TOP, Frame, padded, round_ticks
from hexdbb.reporting.drawings.svg import chart, element, label, path

WIDTH, HEIGHT = 368.0, 206.0
COLUMNS = 240
"""Columns of which each keeps its extremes; the chart is 320 units wide inside."""


def unrolled_svg(circle: CircleComparison, meant: Sequence[str] = (), apart_deg: float = NEAR_DEG) -> str:
    """Draw measured minus predicted reading: every angle in light, means of three degrees in dark.

    Reversals of the sliders meant (``slider 4``) are bold; those no further apart than `apart_deg` share one name.
    """
    lines = [(SHORT_DIRECTION_NAMES[part.direction], residual_path(part)) for part in circle.directions]
    frame = Frame(WIDTH, HEIGHT, (0.0, 360.0), padded(np.concatenate([curve(each)[1] for _, each in lines])))
    inside = list(
        frame.grid(np.arange(0.0, 361.0, 90.0), round_ticks(*frame.y_range, 5), "polar angle, °", "residual, µm")
    )
    inside += _marks(circle, frame, meant, apart_deg)
    for side, each in lines:
        angle_rad, value_um = curve(each)
        angle_deg = np.degrees(angle_rad)
        kept = screened(angle_deg, value_um, COLUMNS)
        inside.append(path(frame.x(angle_deg[kept]), frame.y(value_um[kept]), class_=f"measured fine {side}"))
    for side, each in lines:
        middle_deg, mean_um = smoothed(each)
        inside.append(path(frame.x(middle_deg), frame.y(mean_um), class_=f"mean {side}"))
    title = f"Residual of circle {circle.circle.id} at {circle.feed_mm_min:g} mm/min against polar angle, µm"
    low, high = frame.y_range
    return chart(title, frame.box, inside, class_="unrolled", data_low=low, data_high=high)


def _marks(circle: CircleComparison, frame: Frame, meant: Sequence[str], apart_deg: float) -> Iterator[str]:
    def kind_of(reversals: Sequence[Reversal]) -> str:
        return "reversal meant" if any(f"slider {each.slider}" in meant for each in reversals) else "reversal"

    for each in circle.reversals:
        at = float(frame.x(each.angle_deg))
        yield element("line", x1=at, x2=at, y1=TOP, y2=HEIGHT - 30.0, class_=f"{kind_of([each])} dotted")
    for group in near(circle.reversals, apart_deg):
        at = float(frame.x(sum(each.angle_deg for each in group) / len(group)))
        name = ",".join(str(each) for each in dict.fromkeys(each.slider for each in group))
        yield label(name, at, TOP - 2.0, text_anchor="middle", class_=f"{kind_of(group)} name")
