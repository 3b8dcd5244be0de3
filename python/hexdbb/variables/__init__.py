"""Which variable of the samples carries a residual: the angle, a slider's place, time, the way of moving, ..."""

from hexdbb.variables.carriers import Carrier, Profile, carriers, telling
from hexdbb.variables.columns import Columns, State, sample_columns
from hexdbb.variables.pushes import Pushes
from hexdbb.variables.words import sentence

__all__ = ["Carrier", "Columns", "Profile", "Pushes", "State", "carriers", "sample_columns", "sentence", "telling"]
