"""Variables on which an unknown cause may depend: a column of the samples and a space of functions of it.

A closed list: a file or a command names a variable, it never defines one. Each stands for splines of a column, possibly
times a second column, possibly with a step where the column changes sign.
"""

from __future__ import annotations

from dataclasses import dataclass

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
        Whether a step with the column's sign belongs to it.
    is_log : bool
        Whether the splines are those of the column's logarithm.
    """

    name: str
    column: str
    unit: str
    words: str
    count: int = 1
    times: str = ""
    period: float = 0.0
    signed: bool = False
    is_log: bool = False

    @property
    def columns(self) -> int:
        """Number of functions."""
        return self.count + int(self.signed)


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
VELOCITY = Variable("velocity", "velocity_mm_s", "mm/s", "velocity of the slider", 12, signed=True)
ACCELERATION = Variable("acceleration", "acceleration_mm_s2", "mm/s²", "acceleration of the slider", 12)
FORCE = Variable("leg_force", "leg_force", "", "axial force of the leg per load", 12)
TIME = Variable("time", "time_s", "s", "time", 10)
TIME_POSITION = Variable("time_position", "sliders_mm", "mm", "position of the slider, growing", 6, times=ELAPSED)
WARMING = Variable("warming", "warming_k", "K", "warming", 6)
SCREW_PHASE = Variable("screw_phase", "sliders_mm", "mm", "turn of the screw", 12, period=SCREW_LEAD)
TURNING = Variable(
    "turning_rate", "slider_joint_rate_rad_s", "rad/s", "turning rate of the slider's joint", 12, signed=True
)
JOINT_ANGLE = Variable("joint_angle", "slider_joint_angle_rad", "rad", "angle of the slider's joint", 12)
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
ANGLE = Variable("angle", "angle_rad", "rad", "polar angle", 24, period=TURN)
ANGLE_DIRECTION = Variable(
    "angle_direction", "angle_rad", "rad", "polar angle, by direction of the circle", 24, times="direction", period=TURN
)
BAR_ANGLE = Variable("bar_angle", "bar_angle_rad", "rad", "angle of the bar in the platform", 24, period=TURN)
READ = Variable("reading", "nominal_reading_mm", "mm", "nominal reading", 8)
CIRCLE_DIRECTION = Variable("circle_direction", "", "", "direction of the circle", times="direction")
FEED = Variable("feed", "feed_mm_s", "mm/s", "feed")

OF_SLIDER = (
    *(POSITION, FINE_POSITION, DIRECTION, DIRECTION_POSITION, SINCE_REVERSAL, TRAVEL, VELOCITY, ACCELERATION, FORCE),
    *(TIME, TIME_POSITION, WARMING, SCREW_PHASE),
)
OF_LEG = (
    *(each for each in OF_SLIDER if each not in (FINE_POSITION, SCREW_PHASE)),
    *(TURNING, JOINT_ANGLE, PLATFORM_TURNING, PLATFORM_ANGLE, SWING, SWING_ANGLE),
)
OF_GUIDEWAY = (
    Variable("position", "sliders_mm", "mm", "position of the slider", 24),
    Variable("fine_position", "sliders_mm", "mm", "position of the slider", 200),
    TIME_POSITION,
)
OF_BALL = (TIME,)
OF_PLATFORM_JOINT = (
    Variable("constant", "", "", "nothing: an offset"),
    Variable("joint_angle", "platform_joint_angle_rad", "rad", "angle of the platform's joint", 5),
)
OF_READING = (ANGLE, ANGLE_DIRECTION, BAR_ANGLE, READ, TIME, WARMING, CIRCLE_DIRECTION, FEED)
