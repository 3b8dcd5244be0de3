"""From a series of readings to the samples of a record: sweeps, directions, times, laps, slider coordinates.

A sweep ends where the file's own number of it, the circle, the direction or the feed changes; where no direction is
stated, where the angle begins to turn the other way. Times that no clock has given follow from the commanded feed along
the circle; slider coordinates that no encoder has given are those of the nominal machine on the commanded circle
(inverse kinematics, thesis 2.6-2.8). A record says both (`hexdbb.record.NotMeasured`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.importing.series import Floats, Ints, Series
from hexdbb.importing.setting import Setting
from hexdbb.kinematics import inverse, status_name
from hexdbb.record import SLIDER_COLUMNS, NotMeasured
from hexdbb.record.laps import counted_laps

LEAST_STRETCH = 8
"""Readings between two turns of the angle's sense, below which the angle does not tell directions."""
STANDING = 0.1
"""Part of the usual step below which an angle stands: a run that begins where the one before has ended, to rounding."""
SLIDERS_ORIGIN = "nominal inverse kinematics of the commanded circle"
TIME_ORIGIN = "commanded feed along the circle, runs one after another"
JOINED_ORIGIN = "times of each run, which begin anew, set one after another"

Columns = dict[str, NDArray[Any]]


def samples_of(series: Series, setting: Setting) -> tuple[Columns, NotMeasured, Ints]:
    """Return the columns of a record, what in them was computed, and the line of each sample.

    Raises
    ------
    InputError
        Circle or feed are not clear, an angle contradicts its direction, or the machine cannot reach the circle.
    """
    circle = _circles(series, setting)
    feed = _feeds(series, setting, circle)
    direction = series.direction if series.direction is not None else _sense(series, setting.origin)
    sweep = _numbered(series.others.get("sweep", np.zeros(len(series))), circle, direction, feed)
    _require_runs(series, sweep, setting.origin)
    series = Series(
        series.angle_deg,
        series.reading_um,
        direction,
        series.lines,
        {**series.others, "circle": circle, "feed_mm_min": feed},
    )
    series, sweep = _in_order_of_travel(series, sweep, setting)
    columns: Columns = {
        "circle": series.others["circle"],
        "sweep": sweep,
        "direction": series.directions,
        "angle_deg": series.angle_deg,
        "feed_mm_min": series.others["feed_mm_min"],
        "reading_um": series.reading_um,
    }
    columns["t_s"], time_origin = _times(series, sweep, setting)
    laps = series.others.get("lap", counted_laps(columns))
    assert laps is not None  # every column that laps are counted from is there
    columns["lap"] = laps
    if "temperature_c" in series.others:
        columns["temperature_c"] = series.others["temperature_c"]
    measured = SLIDER_COLUMNS[0] in series.others
    sliders = (
        np.column_stack([series.others[name] for name in SLIDER_COLUMNS]) if measured else _nominal(series, setting)
    )
    columns |= dict(zip(SLIDER_COLUMNS, sliders.T, strict=True))
    return columns, NotMeasured(sliders=None if measured else SLIDERS_ORIGIN, time=time_origin), series.lines


def _circles(series: Series, setting: Setting) -> Floats:
    if "circle" not in series.others:
        return np.full(len(series), float(setting.circle_id()))
    circles = series.others["circle"]
    for place, value in enumerate(circles):
        if place == 0 or value != circles[place - 1]:
            setting.circle(int(value) if value == int(value) else -1, f"line {series.lines[place]}: circle")
    return circles


def _feeds(series: Series, setting: Setting, circle: Floats) -> Floats:
    if "feed_mm_min" in series.others:
        return series.others["feed_mm_min"]
    by_circle = {each: setting.feed_mm_min(setting.circle(int(each), "circle")) for each in np.unique(circle)}
    return np.array([by_circle[each] for each in circle])


def _numbered(sweep: Floats, *others: NDArray[Any]) -> Ints:
    """Return the number of each reading's sweep, counted from 0 wherever something changes."""
    changes = np.zeros(len(sweep), bool)
    for values in (sweep, *others):
        changes[1:] |= values[1:] != values[:-1]
    return np.cumsum(changes).astype(np.int64)


def _require_runs(series: Series, sweep: Ints, origin: str) -> None:
    """Check that most runs have readings enough to be some; rows sorted by angle mix the runs of both directions."""
    counts = np.bincount(sweep)
    if np.median(counts) < LEAST_STRETCH:
        short = int(np.argmin(counts))
        line = series.lines[np.flatnonzero(sweep == short)[0]]
        seen = f"one of {len(counts)} runs, with {counts[short]} reading{'s' * int(counts[short] != 1)}"
        expected = f"{LEAST_STRETCH} or more in a run: rows in order of travel, one run after another"
        raise InputError(f"{origin}: line {line}: {seen} (expected {expected})")


def turns_deg(angle_deg: Floats) -> Floats:
    """Return the step to each angle from the one before, within half a turn; 0 for the first."""
    steps: Floats = (np.diff(angle_deg, prepend=angle_deg[:1]) + 180.0) % 360.0 - 180.0
    return steps


def _sense(series: Series, origin: str) -> NDArray[np.int8]:
    """Return the direction in which the angle turns."""
    steps = turns_deg(series.angle_deg)
    if "sweep" in series.others:
        steps[np.diff(series.others["sweep"], prepend=np.nan) != 0] = 0.0
    usual = float(np.median(np.abs(steps)))
    sense = np.sign(np.where(np.abs(steps) < STANDING * usual, 0.0, steps))
    moving = np.flatnonzero(sense)
    if not len(moving):
        raise InputError(f"{origin}: the angle does not turn (expected angles around a circle)")
    # A standing angle belongs to what follows: a run often begins where the one before has ended.
    following = np.minimum(np.searchsorted(moving, np.arange(len(sense))), len(moving) - 1)
    direction = sense[moving[following]]
    edges = np.concatenate([[0], np.flatnonzero(np.diff(direction)) + 1, [len(direction)]])
    short = np.flatnonzero(np.diff(edges) < LEAST_STRETCH)
    if len(short):
        line = series.lines[edges[short[0]]]
        raise InputError(
            f"{origin}: line {line}: the angle turns back and forth, so that it tells no direction"
            " (expected a column of directions, or --direction ccw or cw)"
        )
    return direction.astype(np.int8)


def _in_order_of_travel(series: Series, sweep: Ints, setting: Setting) -> tuple[Series, Ints]:
    """Return series and sweeps with angles as places and readings in order of travel.

    Raises
    ------
    InputError
        Angles rise in a clockwise run, which may mean either of two things.
    """
    counts = setting.mapping.angle_counts
    steps = turns_deg(series.angle_deg)
    order, angle_deg = [], series.angle_deg.copy()
    for each in np.unique(sweep):
        rows = np.flatnonzero(sweep == each)
        sign, turned = int(series.directions[rows[0]]), float(steps[rows[1:]].sum())
        if counts == "travel":
            angle_deg[rows] *= sign
        elif turned * sign < 0.0:
            if counts is None:
                name, verb = ("clockwise", "rise") if sign < 0 else ("counter-clockwise", "fall")
                raise InputError(
                    f"{setting.origin}: line {series.lines[rows[0]]}: angles {verb} in a {name} run (expected"
                    " --angle-counts travel where they count along every run, place where rows are sorted by place)"
                )
            rows = rows[::-1]
        order.append(rows)
    every = np.concatenate(order)
    ordered = Series(angle_deg, series.reading_um, series.direction, series.lines, series.others).rows(every)
    return ordered, sweep[every]


def _times(series: Series, sweep: Ints, setting: Setting) -> tuple[Floats, str | None]:
    """Return times, s, and their origin where no clock has given them."""
    if "t_s" in series.others:
        return _joined(series.others["t_s"], sweep)
    steps, feed_mm_s = np.abs(turns_deg(series.angle_deg)), series.others["feed_mm_min"] / 60.0
    begins = np.diff(sweep, prepend=-1) != 0
    for row in np.flatnonzero((steps == 0.0) & ~begins)[:1]:
        raise InputError(
            f"{setting.origin}: line {series.lines[row]}: angle {series.angle_deg[row]:.10g}, as in the line before"
            " (expected one that goes on, or a column of times)"
        )
    radius_mm = np.array([setting.circle(int(each), "circle").radius_mm for each in series.others["circle"]])
    steps[begins] = float(np.median(steps[~begins])) if not begins.all() else 1.0
    passed_s = np.radians(steps) * radius_mm / feed_mm_s
    time_s = np.cumsum(passed_s)
    return time_s - time_s[0], TIME_ORIGIN


def _joined(time_s: Floats, sweep: Ints) -> tuple[Floats, str | None]:
    """Return times with those of a sweep that begins anew set after the sweep before."""
    steps = np.diff(time_s, prepend=time_s[0])
    begins = np.diff(sweep, prepend=sweep[0]) != 0
    anew = begins & (steps < 0.0)
    if not anew.any():
        return time_s, None
    inside = steps[~begins & (steps > 0.0)]
    shift = np.where(anew, -steps + (float(np.median(inside)) if len(inside) else 1.0), 0.0)
    return time_s + np.cumsum(shift), JOINED_ORIGIN


def _nominal(series: Series, setting: Setting) -> Floats:
    """Return the slider coordinates of the nominal machine on the commanded circles, mm, shape (n, 6).

    Raises
    ------
    InputError
        It cannot reach a place; names line, circle and reason.
    """
    sliders_mm = np.zeros((len(series), 6))
    circles = series.others["circle"]
    for each in np.unique(circles):
        rows = np.flatnonzero(circles == each)
        circle = setting.circle(int(each), "circle")
        cup_mm = setting.plan.mount_of(circle).cup_mm
        position_mm = circle.poses(np.radians(series.angle_deg[rows]), cup_mm)
        found, status = inverse(setting.machine, position_mm, circle.platform_rpy_rad)
        failed = np.flatnonzero(status)
        if len(failed):
            row, reason = rows[failed[0]], status_name(int(status[failed[0]]))
            raise InputError(
                f"{setting.origin}: line {series.lines[row]}: {setting.machine.name} does not reach circle {circle.id}"
                f" at {series.angle_deg[row]:g}° ({reason}; expected the plan and the machine of these readings)"
            )
        sliders_mm[rows] = found
    return sliders_mm
