"""Variables on which an unknown cause may depend, as data: which column of the state, and which function of it.

Every variable stands for a space of functions: a spline of a column, possibly times the direction of travel or the
time, possibly with a step where the column changes sign, or constant. A table of values can hold each of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hexdbb.evidence import splines

Floats = NDArray[np.float64]

NEVER = 1e5
"""Times and ways since a reversal beyond this stand for a reversal that never was."""
SMALL_PART = 0.05
"""A signed variable's step is smeared over this part of its RMS, within which its sign is not certain."""


@dataclass(frozen=True)
class Variable:
    """A space of functions of the state.

    Attributes
    ----------
    name : str
        As in `learned:leg:5:turning_rate`.
    column : str
        Of the state; empty where only `times` counts.
    unit : str
    count : int
        Number of spline columns.
    times : str
        A second column that multiplies; `direction` turns the push over with the direction of travel.
    period : float
        Of the column, in its unit; 0 where it is not periodic.
    signed : bool
        Whether a step with the column's sign belongs to it.
    is_log : bool
        Whether the spline's argument is the column's logarithm.
    instants : tuple of float
        Values of `column` from which a step each holds; empty where it has none.
    """

    name: str
    column: str
    unit: str
    count: int = 1
    times: str = ""
    period: float = 0.0
    signed: bool = False
    is_log: bool = False
    instants: tuple[float, ...] = ()

    @property
    def is_step(self) -> bool:
        """Whether it is made of steps."""
        return bool(self.instants)

    @property
    def needs_bounds(self) -> bool:
        """Whether its functions need the range of their argument."""
        return self.is_smooth and not self.period

    @property
    def columns(self) -> int:
        """Number of columns of its design."""
        return self.count + int(self.signed)

    def prior_factor(self, roughness: float) -> Floats:
        """Return T of the prior covariance T T' of the coefficients, not scaled; shape (columns, columns)."""
        factor = np.eye(self.columns)
        if self.is_step:
            return factor
        factor[: self.count, : self.count] = _prior_factor(self.count, roughness, self.period > 0.0)
        return factor

    @property
    def is_smooth(self) -> bool:
        """Whether its smoothness is to be chosen."""
        return self.count > splines.DEGREE and not self.is_step

    def design(self, state: Mapping[str, Floats], element: int, bounds: tuple[float, float] | None = None) -> Floats:
        """Return the functions at every row, shape (n, columns).

        Parameters
        ----------
        state : mapping of str to ndarray
        element : int
            Column of those parts of the state that have six.
        bounds : tuple of float, optional
            Range of the spline's argument; that of the rows themselves where not given.
        """
        count = len(state["time"])
        weight = np.ones(count) if not self.times else of(state, self.times, element)
        if not self.column:
            return weight[:, None].copy()
        values = of(state, self.column, element)
        if self.is_step:
            return weight[:, None] * (values[:, None] >= np.array(self.instants))
        argument = self.argument(values)
        if self.count == 1:
            basis = np.nan_to_num(argument)[:, None]
        elif self.period:
            basis = splines.design(argument, 0.0, self.period, self.count, periodic=True)
        else:
            basis = splines.design(argument, *(bounds or self.bounds(state, element)), self.count)
        if self.signed:
            size = np.sqrt(np.mean(values**2))
            basis = np.column_stack([basis, np.tanh(values / (SMALL_PART * size + 1e-300))])
        return weight[:, None] * basis

    def argument(self, values: Floats) -> Floats:
        """Return the spline's argument; nan where the column is not known, long ago where nothing ever reversed."""
        known = np.where(np.abs(values) < NEVER, values, np.inf if self.is_log else np.nan)
        return np.log(np.maximum(known, 1e-3)) if self.is_log else known

    def bounds(self, state: Mapping[str, Floats], element: int) -> tuple[float, float]:
        """Return the range of the spline's argument over the rows, a little widened."""
        argument = self.argument(of(state, self.column, element))
        known = argument[np.isfinite(argument)]
        if not len(known):
            return 0.0, 1.0
        low, high = float(known.min()), float(known.max())
        return low, high + max(1e-9 * abs(high), 1e-9)

    def varies(self, state: Mapping[str, Floats], element: int) -> bool:
        """Check that the state has the columns and that they vary enough for the functions to be known."""
        names = [name for name in (self.column, self.times) if name]
        if any(name not in state for name in names):
            return False
        for name in names:
            values = of(state, name, element)
            values = values[np.isfinite(values) & (np.abs(values) < NEVER)]
            if len(values) < 5 * self.count or float(np.ptp(values)) <= 1e-9 * max(float(np.abs(values).max()), 1e-9):
                return False
        return True


def of(state: Mapping[str, Floats], name: str, element: int) -> Floats:
    """Return a column of the state, that of one element where it has six."""
    values = state[name]
    return values if values.ndim == 1 else values[:, element]


def screw_phase(lead_mm: float) -> Variable:
    """Return the variable of all that repeats with the screw's turn."""
    return Variable("screw_phase", "position", "mm", 12, period=lead_mm)


@lru_cache(maxsize=256)
def _prior_factor(count: int, roughness: float, periodic: bool) -> Floats:
    return splines.prior_factor(count, roughness, periodic=periodic)


POSITION = Variable("position", "position", "mm", 14)
FINE_POSITION = Variable("fine_position", "position", "mm", 64)
FINE_ALONG = Variable("fine_position", "position", "mm", 200)
DIRECTION = Variable("direction", "", "", 1, times="direction")
DIRECTION_POSITION = Variable("direction_position", "position", "mm", 6, times="direction")
SINCE_REVERSAL = Variable("since_reversal_time", "since_reversal_s", "s", 10, times="direction", is_log=True)
TRAVEL = Variable("since_reversal_travel", "since_reversal_mm", "mm", 10, times="direction", is_log=True)
VELOCITY = Variable("velocity", "velocity", "mm/s", 12, signed=True)
SPEED = Variable("speed", "speed", "mm/s", 8)
ACCELERATION = Variable("acceleration", "acceleration", "mm/s²", 12)
FORCE = Variable("leg_force", "leg_force", "", 12)
TIME = Variable("time", "time", "s", 10)
FINE_TIME = Variable("fine_time", "time", "s", 40)
TIME_IN_RUN = Variable("time_in_run", "time_in_run", "s", 10, is_log=True)
YAW = Variable("yaw", "yaw", "rad", 8)
TILTS = tuple(Variable(name, name, "rad", 8) for name in ("tilt_x", "tilt_y"))
TIME_POSITION = Variable("time_position", "position", "mm", 6, times="elapsed")
TURNING = Variable("turning_rate", "slider_joint_rate", "rad/s", 12, signed=True)
JOINT_ANGLE = Variable("joint_angle", "slider_joint_angle", "rad", 12)
PLATFORM_TURNING = Variable("platform_turning_rate", "platform_joint_rate", "rad/s", 12, signed=True)
PLATFORM_ANGLE = Variable("platform_joint_angle", "platform_joint_angle", "rad", 12)
SWING = Variable("swing_rate", "swing_rate", "rad/s", 12, signed=True)
SWING_ANGLE = Variable("swing_angle", "swing_angle", "rad", 12)
WARMING = Variable("warming", "warming", "K", 6)
ANGLE = Variable("angle", "polar_angle", "rad", 24, period=2.0 * np.pi)
ANGLE_DIRECTION = Variable("angle_direction", "polar_angle", "rad", 24, times="circle_direction", period=2.0 * np.pi)
BAR_ANGLE = Variable("bar_angle", "bar_angle", "rad", 24, period=2.0 * np.pi)
READ = Variable("reading", "nominal_reading", "mm", 8)
CIRCLE_DIRECTION = Variable("circle_direction", "", "", 1, times="circle_direction")
FEED = Variable("feed", "feed", "mm/s", 1)

OF_SLIDER = (
    POSITION,
    FINE_POSITION,
    DIRECTION,
    DIRECTION_POSITION,
    SINCE_REVERSAL,
    TRAVEL,
    VELOCITY,
    SPEED,
    ACCELERATION,
    FORCE,
    TIME,
    FINE_TIME,
    TIME_POSITION,
    WARMING,
)
OF_LEG = (
    *(each for each in OF_SLIDER if each is not FINE_POSITION),
    TURNING,
    JOINT_ANGLE,
    PLATFORM_TURNING,
    PLATFORM_ANGLE,
    SWING,
    SWING_ANGLE,
    YAW,
    *TILTS,
)
OF_GUIDEWAY = (Variable("position", "position", "mm", 24), FINE_ALONG, TIME_POSITION)
OF_BALL = (TIME, FINE_TIME, YAW, *TILTS)
OF_PLATFORM_JOINT = (Variable("constant", "", ""), Variable("joint_angle", "platform_joint_angle", "rad", 5))
OF_READING = (
    ANGLE,
    ANGLE_DIRECTION,
    BAR_ANGLE,
    READ,
    TIME,
    FINE_TIME,
    TIME_IN_RUN,
    WARMING,
    CIRCLE_DIRECTION,
    FEED,
    YAW,
    *TILTS,
)
