"""Which functions stand beside an effect's form that lives in functions of one variable (`Learned.of_its_form`)."""

from __future__ import annotations

from hexdbb.learned import variables as v
from hexdbb.learned.variable import Variable

Beside = dict[Variable, tuple[Variable, ...]]

EVERYWHERE: Beside = {
    # A delay, or a loop that lags, is a series in the derivatives of the motion, and a filter delays by the feed.
    v.VELOCITY: (v.ACCELERATION, v.VELOCITY_BY_FEED),
    # What happens at a reversal may differ between the two ends of the travel. What sticks there is held by a spring
    # for some travel; what decays afterwards does so with time.
    v.SINCE_REVERSAL: (v.SINCE_REVERSAL_ALIKE, v.TRAVEL),
    v.TRAVEL: (v.TRAVEL_ALIKE, v.SINCE_REVERSAL),
}
"""At every place that has the variables."""
BESIDE: dict[str, Beside] = {
    # A screw follows its motor and the machine's frame, each with its own delay. Not at legs: each may grow in its own
    # manner already, and with these functions legs explained what a screw does.
    "slider": EVERYWHERE | {v.TIME_POSITION: (v.TIME_POSITION_BENT, v.POSITION_OVER_TIME)},
    # Friction drags a ball that is off its place across its seat as the leg turns.
    "platform_joint": EVERYWHERE | {v.PLATFORM_JOINT_ANGLE: (v.JOINT_SINCE_REVERSAL, v.DRAGGED_BY_ANGLE)},
}
"""At places that have others besides."""
