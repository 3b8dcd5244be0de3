"""Which variable of the samples carries a residual: the angle, a slider's place, time, the way of moving, ..."""

from hexdbb.predictors.carriers import Carrier, Profile, carriers, telling
from hexdbb.predictors.columns import Columns, State, sample_columns
from hexdbb.predictors.pushes import Pushes
from hexdbb.predictors.words import sentence

__all__ = ["Carrier", "Columns", "Profile", "Pushes", "State", "carriers", "sample_columns", "sentence", "telling"]
