"""Errors of the true machine other than geometry: mechanisms stepped in time, each with its own inner state.

A mechanism is a table in the truth file (a pydantic model, named by `kind`) and the object that the table starts.
`MECHANISMS` is the table of kinds; another mechanism is another row.
Units: files in µm, ms, min, degrees; mechanisms in mm, s, rad.
"""

from hexdbb.rig.mechanisms.base import Mechanism, MechanismTable, Motion, Push
from hexdbb.rig.mechanisms.friction import ReversalSpike, StickSlip
from hexdbb.rig.mechanisms.guideway import Dent, GuidewayBend, Straightness
from hexdbb.rig.mechanisms.measuring import BallEccentricity, BarDrift, BarGain, LooseCup, MainsPickup, SampleDelay
from hexdbb.rig.mechanisms.structure import GravitySag, JointOffset, LegThermal, ScrewThermal
from hexdbb.rig.mechanisms.transmission import Backlash, EncoderInterpolation, LeadError, PitchCyclic, ServoLag

__all__ = ["CATALOGUED", "MECHANISMS", "OUTSIDE", "Mechanism", "MechanismTable", "Motion", "Push"]

CATALOGUED: dict[str, type[MechanismTable]] = {
    "backlash": Backlash,
    "reversal_spike": ReversalSpike,
    "pitch_cyclic": PitchCyclic,
    "lead_error": LeadError,
    "straightness": Straightness,
    "servo_lag": ServoLag,
    "leg_thermal": LegThermal,
    "screw_thermal": ScrewThermal,
    "gravity_sag": GravitySag,
    "joint_offset": JointOffset,
    "bar_drift": BarDrift,
    "bar_gain": BarGain,
    "sample_delay": SampleDelay,
    "ball_eccentricity": BallEccentricity,
}
"""Kinds with an effect of the same name in the catalogue of effects."""

OUTSIDE: dict[str, type[MechanismTable]] = {
    "dent": Dent,
    "mains_pickup": MainsPickup,
    "loose_cup": LooseCup,
    "stick_slip": StickSlip,
    "guideway_bend": GuidewayBend,
    "encoder_interpolation": EncoderInterpolation,
}
"""Kinds without an effect in the catalogue."""

MECHANISMS: dict[str, type[MechanismTable]] = {**CATALOGUED, **OUTSIDE}
"""Kinds of ``[[mechanism]]`` in a truth file."""
