"""Variables on which an unknown cause may depend, place by place: the simplest, which are looked at first.

A closed list: those of `further.py` are looked at where none of these settles what is missing, and some carry numbers
in their names, which the readings chose (`numbered.py`).
"""

from __future__ import annotations

from dataclasses import replace

from hexdbb.learned.variable import BENT, EACH_SWEEP, ELAPSED, SCREW_LEAD, TURN, Variable

LEAST_TILT = 1e-3
"""rad: drives that follow a command of constant orientation leave a hundredth of it; a commanded change is more."""

POSITION = Variable("position", "sliders_mm", "mm", "position of the slider", 14)
FINE_POSITION = Variable("fine_position", "sliders_mm", "mm", "position of the slider", 64)
DIRECTION = Variable("direction", "", "", "direction of travel", times="travel_direction")
DIRECTION_POSITION = Variable(
    "direction_position",
    "sliders_mm",
    "mm",
    "position, by direction of travel",
    6,
    times="travel_direction",
    parts=("direction", "position"),
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
VELOCITY_OVER_TIME = Variable(
    "velocity_over_time",
    "time_s",
    "s",
    "time, times the velocity of the slider",
    6,
    times="velocity_mm_s",
    of_forms=True,
)
"""Beside a lag or a delay: the gauge's clock drifts against the drives' clock, or grease warms. Six splines, as of any
product: with 16 nothing less was left of delays that wander."""
VELOCITY_BY_FEED = Variable(
    "velocity_by_feed",
    "feed_mm_s",
    "mm/s",
    "feed, times the velocity of the slider",
    times="velocity_mm_s",
    of_forms=True,
)
"""Beside a lag or a delay: that of a filter depends on the feed."""
NEIGHBOUR_VELOCITY = Variable(
    "neighbour_velocity",
    "velocity_mm_s",
    "mm/s",
    "velocity of the other slider on the guideway",
    12,
    signed=True,
    of_neighbour=True,
)
GAP = Variable("gap", "gap_mm", "mm", "distance from the other slider on the guideway", 12)
"""Bellows between two carriages push them apart: one odd function of the distance, shared by both sliders."""
GAP_RATE = Variable(
    "gap_rate", "gap_rate_mm_s", "mm/s", "velocity against the other slider on the guideway", 12, signed=True
)
"""A cover that spans two carriages drags the one by the other: likewise."""
ACCELERATION = Variable("acceleration", "acceleration_mm_s2", "mm/s²", "acceleration of the slider", 12, signed=True)
POWER = Variable(
    "direction_power",
    "power_mm2_s3",
    "mm²/s³",
    "power of the drive per mass, by direction of travel",
    12,
    times="travel_direction",
    signed=True,
)
"""What a drive does only where it brakes, or only where it speeds up."""
FORCE = Variable("leg_force", "leg_force", "", "axial force of the leg per load", 12)
DRIVE_LOAD = Variable("drive_load", "drive_load", "", "force along the guideway per load", 12)
CARRIAGE_LOAD = Variable("carriage_load", "carriage_load", "", "force across the guideway per load", 12)
JERK = Variable("jerk", "jerk_mm_s3", "mm/s³", "jerk of the slider", 12, signed=True)
LOADS_SINCE_TURN = tuple(
    Variable(
        f"{load.name}_since_turn",
        f"{load.column}_since_turn",
        "",
        f"change of the {load.words.removesuffix(' per load')} since it turned",
        10,
        times=f"{load.column}_direction",
        is_log=True,
    )
    for load in (FORCE, DRIVE_LOAD, CARRIAGE_LOAD)
)
"""A bolted joint slips, and a preloaded nut winds up, behind the load: they remember where it turned, not when."""
SWINGS = 24
"""Splines over time of what swings several times in a test of half an hour."""
TIME = Variable("time", "time_s", "s", "time", 10)
FINE_TIME = Variable("fine_time", "time_s", "s", "time", 40)
TIME_IN_SWEEP = Variable("time_in_sweep", "time_in_sweep_s", "s", "time since the capture began", 10, is_log=True)
IN_CIRCLE = Variable("time_in_circle", "time_in_circle_s", "s", "time since the circle was begun", 10, is_log=True)
"""The operator takes the bar in hand where a circle begins, not with every sweep of it."""
MOST_SWEEPS = 96
"""Sweeps of which each may be otherwise: a test of an hour has thirty to a hundred. Those beyond are like the last."""
SWEEP = Variable(
    "each_sweep",
    EACH_SWEEP,
    "",
    "number of the sweep",
    MOST_SWEEPS - 1,
    instants=tuple(each + 0.5 for each in range(MOST_SWEEPS - 1)),
)
"""What is another with each sweep: a cup that sits a little otherwise each time that the bar comes, a bar that a warm
hand has lengthened, a drive that was referenced anew."""
SINCE_FIXING = Variable(
    "time_since_fixing", "time_since_fixing_s", "s", "time since the set-up was fixed", 10, is_log=True
)
"""What was just fixed settles, fast at first and in the same manner after each fixing, which no function of time
describes. As many splines as time within a sweep has, over the logarithm of the time."""
ROLL, PITCH, YAW = (
    Variable(name, "platform_rpy_rad", "rad", f"{name} of the platform", 8, axis=axis, least=LEAST_TILT)
    for axis, name in enumerate(("roll", "pitch", "yaw"))
)
TILT = Variable("tilt", "tilt_rad", "rad", "tilt of the platform", 8, least=LEAST_TILT)
DOWNHILL = replace(TILT, name="tilt_downhill", times="downhill_in_platform", is_vector=True)
"""What is clamped loosely to the platform falls to its lower side, whichever that is. Of some circles, each with its
own orientation, functions of roll, pitch or yaw along three axes say as much, and predict no other."""
TIME_POSITION = Variable(
    "time_position", "sliders_mm", "mm", "position of the slider, growing", 6, times=ELAPSED, parts=("time", "position")
)
TIME_POSITION_BENT = replace(TIME_POSITION, name="time_position_bent", times=BENT, of_forms=True)
"""Beside what grows in proportion to time: what warms does so by less and less."""
POSITION_OVER_TIME = Variable(
    "position_over_time",
    "time_s",
    "s",
    "time, times the position of the slider",
    SWINGS,
    times="sliders_mm",
    from_start=True,
    of_forms=True,
)
"""Beside the same: a law of its own in time, in proportion to the position. A screw whose temperature swings with its
cooling, every five to fifteen minutes of a test of forty, has no form of ten splines: it was a function of a force."""
WARMING = Variable("warming", "warming_k", "K", "warming", 6)
SCREW_PHASE = Variable("screw_phase", "sliders_mm", "mm", "turn of the screw", 12, period=SCREW_LEAD)
SCREW_COS_POSITION, SCREW_SIN_POSITION = (
    Variable(
        f"{column}_position",
        "sliders_mm",
        "mm",
        f"position, times the {words} of the screw's turn",
        6,
        times=column,
        of_forms=True,
    )
    for column, words in (("screw_cos", "cosine"), ("screw_sin", "sine"))
)
"""Beside a pitch error: its amplitude and phase change along the screw, which wears most where it is used most."""
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
    parts=("joint_angle", "turning_rate"),
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
CONSTANT = Variable("constant", "", "", "nothing: an offset")
FINE_TURN = 72
"""Splines of a turn, one for every five degrees: the width of a dent in a ball."""
ANGLE = Variable("angle", "angle_rad", "rad", "polar angle", 24, period=TURN)
ANGLE_DIRECTION = Variable(
    "angle_direction",
    "angle_rad",
    "rad",
    "polar angle, by direction of the circle",
    24,
    times="direction",
    period=TURN,
    parts=("circle_direction",),
)
BAR_ANGLE = Variable("bar_angle", "bar_angle_rad", "rad", "angle of the bar in the platform", 24, period=TURN)
BAR_AZIMUTH = Variable("bar_azimuth", "bar_azimuth_rad", "rad", "angle of the bar in the base", 24, period=TURN)
"""A chip in the cup displaces the bar's ball for one direction of the bar in the base, whatever the platform's yaw."""
FINE_BAR_ANGLE, FINE_BAR_AZIMUTH = (
    replace(each, name=f"fine_{each.name}", count=FINE_TURN) for each in (BAR_ANGLE, BAR_AZIMUTH)
)
"""For a dent in a ball, which is a few degrees wide."""
OF_BALLS = {BAR_ANGLE.column: "platform", BAR_AZIMUTH.column: "cup", ANGLE.column: "cup"}
"""Directions of the bar, and at which of its two balls each counts: on level circles the polar angle is the azimuth."""
BAR_ELEVATION = Variable(
    "bar_elevation", "bar_elevation_rad", "rad", "angle of the bar to the horizontal", 8, least=LEAST_TILT
)
"""A bar sags by its own weight where it lies, and a gauge's plunger weighs on its spring where it stands."""
READ = Variable("reading", "nominal_reading_mm", "mm", "nominal reading", 8, of_forms=True)
DEFLECTION = Variable("deflection", "deflection_mm", "mm", "predicted deflection of the gauge", 12)
SINCE_TURN = Variable(
    "deflection_since_turn",
    "deflection_since_turn_mm",
    "mm",
    "travel of the gauge since it turned",
    10,
    times="deflection_direction",
    is_log=True,
)
TURNED = Variable("turned", "turned_rad", "rad", "angle turned since the circle began, with its sign", 10)
"""A cable that is wound up pulls more with every turn, and the other way round in the other direction."""
WOUND = Variable("wound", "wound_rad", "rad", "angle turned since the set-up was fixed, with its sign", 10)
"""What is wound up from lap to lap, and unwound the other way round, where nobody lets it go in between."""
CIRCLE_DIRECTION = Variable("circle_direction", "", "", "direction of the circle", times="direction")
SPEED = Variable("speed", "speed_mm_s", "mm/s", "speed of the platform", 8)
FEED = Variable("feed", "feed_mm_s", "mm/s", "feed")

CARRIAGES_ACCELERATION = Variable(
    "acceleration", "", "", "acceleration of all carriages", times="carriages_acceleration_mm_s2", is_vector=True
)
COURSE, COURSE_IN_PLATFORM = (
    Variable("course", "", "", "direction in which the platform moves", times=column, is_vector=True)
    for column in ("course", "course_in_platform")
)
"""Friction and play act against it; one for places pushed in the base frame, one for those in the platform frame."""

OF_DRIVE = (POSITION_OVER_TIME, VELOCITY_OVER_TIME, VELOCITY_BY_FEED, SCREW_COS_POSITION, SCREW_SIN_POSITION)
OF_SLIDER = (
    *(POSITION, FINE_POSITION, DIRECTION, DIRECTION_POSITION, SINCE_REVERSAL, TRAVEL, VELOCITY, ACCELERATION, FORCE),
    *(TIME, FINE_TIME, TIME_IN_SWEEP, TIME_POSITION, WARMING, SCREW_PHASE, NEIGHBOUR_VELOCITY),
    *(SINCE_REVERSAL_ALIKE, TRAVEL_ALIKE, TIME_POSITION_BENT, *OF_DRIVE),
)
OF_LEG = (
    *(each for each in OF_SLIDER if each not in (FINE_POSITION, SCREW_PHASE, NEIGHBOUR_VELOCITY, *OF_DRIVE)),
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
    *(DIRECTION_POSITION, VELOCITY, ACCELERATION, FORCE, TIME, TIME_POSITION, TIME_POSITION_BENT),
)
OF_CUP = (TIME, FINE_TIME, IN_CIRCLE, SINCE_FIXING)
OF_BALL = (*OF_CUP, ROLL, PITCH, YAW, DOWNHILL)
"""The ball hangs on the platform; of how that is oriented the cup, on the table, knows nothing."""
PLATFORM_JOINT_ANGLE = Variable("joint_angle", "platform_joint_angle_rad", "rad", "angle of the platform's joint", 5)
DRAGGED_BY_ANGLE = replace(JOINT_ANGLE_DIRECTION, count=PLATFORM_JOINT_ANGLE.count, of_forms=True)
"""As few splines as other functions of a platform's joint have: each pushes along three axes."""
OF_PLATFORM_JOINT = (
    CONSTANT,
    PLATFORM_JOINT_ANGLE,
    Variable("swing_angle", "swing_angle_rad", "rad", "swing angle of the leg about its guideway", 5),
    Variable("time", "time_s", "s", "time", 10, from_start=True),
    *(JOINT_SINCE_REVERSAL, DRAGGED_BY_ANGLE),
)
OF_READING = (
    *(ANGLE, ANGLE_DIRECTION, BAR_ANGLE, DEFLECTION, READ, TIME, FINE_TIME, TIME_IN_SWEEP, IN_CIRCLE, WARMING),
    *(CIRCLE_DIRECTION, FEED, SPEED, ROLL, PITCH, YAW, SINCE_TURN, TURNED, BAR_ELEVATION, BAR_AZIMUTH),
    *(FINE_BAR_ANGLE, FINE_BAR_AZIMUTH),
)
OF_ONE = (FINE_POSITION, FINE_TIME)
"""Variables of single elements: all sharing so detailed a function is no physics that anybody has seen."""
