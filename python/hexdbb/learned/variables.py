"""Variables on which an unknown cause may depend: a column of the samples and a space of functions of it.

A closed list: a file or a command names a variable, it never defines one. Each stands for splines of a column, possibly
times a second column, possibly with a step where the column changes sign. Two kinds carry numbers in their names, which
the readings chose: steps at instants (`step@12.5/340.2`) and what repeats with a period (`time_period@0.25`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

ELAPSED = "elapsed"
"""Time, centred and divided by its span: no column of the samples, since a function's own limits scale it."""


@dataclass(frozen=True)
class Variable:
    """A space of functions of the samples.

    Attributes
    ----------
    name : str
        As in `learned:leg:5:turning_rate`.
    column : str
        Of `hexdbb.samples.Samples`; empty where only `times` counts.
    unit : str
    words : str
        What people call it.
    count : int
        Number of splines; 1: linear in the column, or constant without one.
    times : str
        A second column that multiplies; empty where none does.
    period : float
        Of the column, in its unit; 0 where it is not periodic, `SCREW_LEAD` where the machine's screws set it.
    signed : bool
        Whether a step with the column's sign belongs to it, and its splines are dense about zero.
    is_even : bool
        Whether its splines lie evenly all the same: what grows with a velocity or with its square bends nowhere.
    from_start : bool
        Whether functions are zero at the column's smallest value: they say what changes, not an offset that stays.
    of_neighbour : bool
        Whether the column is that of the other slider on the same guideway.
    is_log : bool
        Whether the splines are those of the column's logarithm.
    axis : int
        Component of a column of three.
    least : float
        Range up to which it counts as constant.
    of_forms : bool
        Whether it only describes how the form of a cause differs, and no cause is sought in it.
    instants : tuple of float
        Values of the column from which a step each holds; then there are no splines.
    """

    name: str
    column: str
    unit: str
    words: str
    count: int = 1
    times: str = ""
    period: float = 0.0
    signed: bool = False
    is_even: bool = False
    from_start: bool = False
    of_neighbour: bool = False
    is_log: bool = False
    axis: int = 0
    least: float = 0.0
    of_forms: bool = False
    instants: tuple[float, ...] = ()

    @property
    def columns(self) -> int:
        """Number of functions."""
        return self.count + int(self.signed)

    @property
    def needs(self) -> frozenset[str]:
        """Columns of the samples that its functions depend on."""
        return frozenset({"time_s" if self.times == ELAPSED else self.times, self.column} - {""})

    @property
    def is_constant(self) -> bool:
        """Whether it is an offset that nothing changes."""
        return not self.needs

    @property
    def has_chosen_period(self) -> bool:
        """Whether it repeats with a period that readings chose."""
        return "_period@" in self.name

    @property
    def is_smooth(self) -> bool:
        """Whether it has splines enough for their smoothness to be chosen."""
        return self.count > SPLINES_MIN and not self.instants


SPLINES_MIN = 3
"""A cubic spline has one more function at least."""
PERIOD_SPLINES = 8
"""Splines of a period that the readings chose: a sine with two harmonics."""
INSTANT_S = 1e-4
"""Resolution of instants in names: far below the time between two samples."""
LEAST_TILT = 1e-3
"""rad: drives that follow a command of constant orientation leave a hundredth of it; a commanded change is more."""
SCREW_LEAD = -1.0
"""Period of a variable that repeats with every turn of the machine's screws."""
TURN = 2.0 * np.pi

POSITION = Variable("position", "sliders_mm", "mm", "position of the slider", 14)
FINE_POSITION = Variable("fine_position", "sliders_mm", "mm", "position of the slider", 64)
DIRECTION = Variable("direction", "", "", "direction of travel", times="travel_direction")
DIRECTION_POSITION = Variable(
    "direction_position", "sliders_mm", "mm", "position, by direction of travel", 6, times="travel_direction"
)
SINCE_REVERSAL = Variable(
    "since_reversal_time", "since_reversal_s", "s", "time since the reversal", 10, times="travel_direction", is_log=True
)
TRAVEL = Variable(
    "since_reversal_travel",
    "since_reversal_mm",
    "mm",
    "travel since the reversal",
    10,
    times="travel_direction",
    is_log=True,
)
SINCE_REVERSAL_ALIKE, TRAVEL_ALIKE = (
    replace(each, name=f"{each.name}_alike", words=f"{each.words}, alike both ways", times="", of_forms=True)
    for each in (SINCE_REVERSAL, TRAVEL)
)
"""Beside functions times the direction of travel: what is not the same at one end of the travel and at the other."""
VELOCITY = Variable("velocity", "velocity_mm_s", "mm/s", "velocity of the slider", 12, signed=True)
NEIGHBOUR_VELOCITY = Variable(
    "neighbour_velocity",
    "velocity_mm_s",
    "mm/s",
    "velocity of the other slider on the guideway",
    12,
    signed=True,
    of_neighbour=True,
)
ACCELERATION = Variable("acceleration", "acceleration_mm_s2", "mm/s²", "acceleration of the slider", 12, signed=True)
FORCE = Variable("leg_force", "leg_force", "", "axial force of the leg per load", 12)
TIME = Variable("time", "time_s", "s", "time", 10)
FINE_TIME = Variable("fine_time", "time_s", "s", "time", 40)
TIME_IN_SWEEP = Variable("time_in_sweep", "time_in_sweep_s", "s", "time since the capture began", 10, is_log=True)
LAG_BY_POSITION, GIVING_BY_POSITION = (
    Variable(name, "sliders_mm", "mm", f"position of the slider, times the {words}", 6, times=times, of_forms=True)
    for name, times, words in (
        ("velocity_position", "velocity_mm_s", "velocity"),
        ("leg_force_position", "leg_force", "force of the leg"),
    )
)
"""A lag, or a compliance, that is not the same along the guideway."""
ROLL, PITCH, YAW = (
    Variable(name, "platform_rpy_rad", "rad", f"{name} of the platform", 8, axis=axis, least=LEAST_TILT)
    for axis, name in enumerate(("roll", "pitch", "yaw"))
)
TIME_POSITION = Variable("time_position", "sliders_mm", "mm", "position of the slider, growing", 6, times=ELAPSED)
WARMING = Variable("warming", "warming_k", "K", "warming", 6)
SCREW_PHASE = Variable("screw_phase", "sliders_mm", "mm", "turn of the screw", 12, period=SCREW_LEAD)
TURNING = Variable(
    "turning_rate", "slider_joint_rate_rad_s", "rad/s", "turning rate of the slider's joint", 12, signed=True
)
JOINT_ANGLE = Variable("joint_angle", "slider_joint_angle_rad", "rad", "angle of the slider's joint", 12)
JOINT_ANGLE_DIRECTION = Variable(
    "joint_angle_direction",
    "slider_joint_angle_rad",
    "rad",
    "angle of the slider's joint, by the sense of its turning",
    12,
    times="slider_joint_direction",
)
TURNING_BY_ANGLE = Variable(
    "turning_rate_angle",
    "slider_joint_angle_rad",
    "rad",
    "angle of the slider's joint, times its turning rate",
    12,
    times="slider_joint_rate_rad_s",
    of_forms=True,
)
JOINT_SINCE_REVERSAL = Variable(
    "joint_since_reversal",
    "slider_joint_since_reversal_rad",
    "rad",
    "angle turned since the slider's joint reversed",
    10,
    times="slider_joint_direction",
    is_log=True,
    of_forms=True,
)
PLATFORM_TURNING = Variable(
    "platform_turning_rate",
    "platform_joint_rate_rad_s",
    "rad/s",
    "turning rate of the platform's joint",
    12,
    signed=True,
)
PLATFORM_ANGLE = Variable(
    "platform_joint_angle", "platform_joint_angle_rad", "rad", "angle of the platform's joint", 12
)
SWING = Variable("swing_rate", "swing_rate_rad_s", "rad/s", "swing rate of the leg about its guideway", 12, signed=True)
SWING_ANGLE = Variable("swing_angle", "swing_angle_rad", "rad", "swing angle of the leg about its guideway", 12)
INCLINATION = Variable(
    "inclination", "leg_inclination_rad", "rad", "inclination of the leg to the vertical", 12, least=LEAST_TILT
)
ANGLE = Variable("angle", "angle_rad", "rad", "polar angle", 24, period=TURN)
ANGLE_DIRECTION = Variable(
    "angle_direction", "angle_rad", "rad", "polar angle, by direction of the circle", 24, times="direction", period=TURN
)
BAR_ANGLE = Variable("bar_angle", "bar_angle_rad", "rad", "angle of the bar in the platform", 24, period=TURN)
READ = Variable("reading", "nominal_reading_mm", "mm", "nominal reading", 8, of_forms=True)
DEFLECTION = Variable("deflection", "deflection_mm", "mm", "predicted deflection of the gauge", 12)
CIRCLE_DIRECTION = Variable("circle_direction", "", "", "direction of the circle", times="direction")
SPEED = Variable("speed", "speed_mm_s", "mm/s", "speed of the platform", 8)
FEED = Variable("feed", "feed_mm_s", "mm/s", "feed")

OF_SLIDER = (
    *(POSITION, FINE_POSITION, DIRECTION, DIRECTION_POSITION, SINCE_REVERSAL, TRAVEL, VELOCITY, ACCELERATION, FORCE),
    *(TIME, FINE_TIME, TIME_IN_SWEEP, TIME_POSITION, WARMING, SCREW_PHASE, NEIGHBOUR_VELOCITY),
    *(SINCE_REVERSAL_ALIKE, TRAVEL_ALIKE, LAG_BY_POSITION, GIVING_BY_POSITION),
)
OF_LEG = (
    *(each for each in OF_SLIDER if each not in (FINE_POSITION, SCREW_PHASE, NEIGHBOUR_VELOCITY)),
    *(
        TURNING,
        JOINT_ANGLE,
        JOINT_ANGLE_DIRECTION,
        JOINT_SINCE_REVERSAL,
        TURNING_BY_ANGLE,
        PLATFORM_TURNING,
        PLATFORM_ANGLE,
        SWING,
        SWING_ANGLE,
        INCLINATION,
        ROLL,
        PITCH,
        YAW,
    ),
)
OF_GUIDEWAY = (
    Variable("position", "sliders_mm", "mm", "position of the slider", 24),
    Variable("fine_position", "sliders_mm", "mm", "position of the slider", 100),
    *(DIRECTION_POSITION, VELOCITY, ACCELERATION, FORCE, TIME, TIME_POSITION),
)
OF_BALL = (TIME, FINE_TIME, ROLL, PITCH, YAW)
OF_PLATFORM_JOINT = (
    Variable("constant", "", "", "nothing: an offset"),
    Variable("joint_angle", "platform_joint_angle_rad", "rad", "angle of the platform's joint", 5),
    Variable("swing_angle", "swing_angle_rad", "rad", "swing angle of the leg about its guideway", 5),
    Variable("time", "time_s", "s", "time", 10, from_start=True),
)
OF_READING = (
    *(ANGLE, ANGLE_DIRECTION, BAR_ANGLE, DEFLECTION, READ, TIME, FINE_TIME, TIME_IN_SWEEP, WARMING, CIRCLE_DIRECTION),
    *(FEED, SPEED, ROLL, PITCH, YAW),
)
OF_ONE = (FINE_POSITION, FINE_TIME)
"""Variables of single elements: all sharing so detailed a function is no physics that anybody has seen."""


def step(instants_s: Sequence[float]) -> Variable:
    """Return the variable of steps at some instants, rounded down to what its name holds."""
    kept = sorted({math.floor(each / INSTANT_S + 1e-6) * INSTANT_S for each in instants_s})
    names = [f"{each:.4f}".rstrip("0").rstrip(".") for each in kept]
    at = tuple(float(each) for each in names)
    return Variable(f"step@{'/'.join(names)}", "time_s", "s", "time", len(at), instants=at)


def periodic(column: str, period: float) -> Variable:
    """Return the variable of what repeats with a period of `time` (s) or `position` (mm)."""
    name = f"{period:.7g}"
    of = {"time": ("time_s", "s", "time"), "position": ("sliders_mm", "mm", "position of the slider")}
    return Variable(f"{column}_period@{name}", *of[column], PERIOD_SPLINES, period=float(name))


def with_period(variable: Variable, period: float) -> Variable:
    """Return a variable of `periodic` with another period, as many splines as before."""
    return replace(periodic(variable.name.partition("_period@")[0], period), count=variable.count)


def numbered(name: str) -> Variable | None:
    """Return the variable whose name carries numbers; None where the name is not of that kind."""
    kind, _, numbers = name.partition("@")
    if kind not in ("step", "time_period", "position_period"):
        return None
    if not re.fullmatch(r"-?\d+(\.\d+)?(/-?\d+(\.\d+)?)*", numbers):
        return None
    values = [float(each) for each in numbers.split("/")]
    if kind == "step":
        return step(values)
    return periodic(kind.removesuffix("_period"), values[0]) if len(values) == 1 and values[0] > 0.0 else None
