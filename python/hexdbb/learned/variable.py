"""A variable on which an unknown cause may depend: a column of the samples and a space of functions of it.

A file or a command names a variable, it never defines one (`variables.py`, `further.py`, `numbered.py`). Each stands
for splines of a column, possibly times a second column, possibly with a step where the column changes sign.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

ELAPSED = "elapsed"
"""Time since the beginning, divided by its span: no column of the samples, since a function's own limits scale it."""
BENT = "elapsed_bent"
"""Zero at both ends of that time and 1 in its middle: what warms grows fast at first, and then hardly more."""
_GROWING = (ELAPSED, BENT)
SPLINES_MIN = 3
"""A cubic spline has one more function at least."""
SCREW_LEAD = -1.0
"""Period of a variable that repeats with every turn of the machine's screws."""
TURN = 2.0 * np.pi
AXES_OF_VECTOR = 3
"""Numbers of a column that belongs to axes, not to sliders or legs."""
EACH_SWEEP = "sweep"
"""Column that counts the sweeps."""
NUMBERED = "@"
"""In the name of a variable: what follows are the numbers."""
OF_MEMORY = "."
"""In the name of a column of the samples that remembers: what follows the column's own name, and says how."""

IN_MOUNT = "mount@"
"""In the name of what multiplies a function: 1 with one mount of the cup, 0 with the others; its number, from 1."""

LINGERING = "lingering"
"""The same where functions of the state linger, not the state: what they do builds up and dies away."""

ZERO_AT_REST = frozenset({"velocity_mm_s"})
"""Columns that are zero while the machine waits between two sweeps."""


def is_growing(times: str) -> bool:
    """Whether what multiplies a function is no column of the samples but a growth with time."""
    return times.partition(OF_MEMORY)[0] in _GROWING


def mount_of(times: str) -> int | None:
    """Return the index of the only mount with which a function acts; None where what multiplies it is no mount."""
    return int(times.removeprefix(IN_MOUNT)) - 1 if times.startswith(IN_MOUNT) else None


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
    turns_within : float
        Range of the column over which such a step is smeared; 0: a small part of what it has in the readings.
    is_even : bool
        Whether its splines lie evenly all the same: what grows with a velocity or with its square bends nowhere.
    from_start : bool
        Whether functions are zero at the column's smallest value: they say what changes, not an offset that stays.
    of_neighbour : bool
        Whether the column is that of the other slider on the same guideway.
    of_element : int
        Slider or leg, from 1, whose column it is, whatever is pushed; 0: that of the element pushed.
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
    parts : tuple of str
        For a product of two states, the names of their variables; a place need not have them.
    is_vector : bool
        Whether `times` is a vector; one function then pushes along each of its three axes.
    beside : tuple of str
        Columns that multiply further functions of the column, one each, before the one that `times` multiplies; an
        empty name: nothing multiplies that function.
    is_coarse : bool
        Whether it has no more splines, whatever readings ask for: along six axes at once they would describe anything,
        of what lingers only the noise.
    """

    name: str
    column: str
    unit: str
    words: str
    count: int = 1
    times: str = ""
    period: float = 0.0
    signed: bool = False
    turns_within: float = 0.0
    is_even: bool = False
    from_start: bool = False
    of_neighbour: bool = False
    of_element: int = 0
    is_log: bool = False
    axis: int = 0
    least: float = 0.0
    of_forms: bool = False
    instants: tuple[float, ...] = ()
    parts: tuple[str, ...] = ()
    is_vector: bool = False
    beside: tuple[str, ...] = ()
    is_coarse: bool = False

    def __hash__(self) -> int:
        """Return a hash of what tells nearly all variables apart: one of all fields takes a twentieth of a search."""
        return hash((self.name, self.column, self.count, self.times, self.period))

    @property
    def ways(self) -> int:
        """Number of functions of the column: several where each is multiplied by something else."""
        return 1 + len(self.beside)

    @property
    def all_times(self) -> tuple[str, ...]:
        """What multiplies its functions of the column, one after the other; empty where nothing does."""
        return (*self.beside, self.times)

    @property
    def each_way(self) -> bool:
        """Whether either direction, of which `times` holds the sign, has a function of its own.

        One is alike both ways, and one times that sign.
        """
        return len(self.beside) == 1 and not any(self.beside)

    @property
    def columns(self) -> int:
        """Number of coefficients of one component."""
        return self.ways * (self.count + int(self.signed))

    @property
    def state(self) -> str:
        """Column of the samples that its functions are functions of, whether what they do lingers or not."""
        return self.column.partition(f"{OF_MEMORY}{LINGERING}@")[0]

    @property
    def lingers_s(self) -> float:
        """Time constant (s) with which what its functions do dies away; 0 where they act at once."""
        return float(self.column.partition(f"{OF_MEMORY}{LINGERING}@")[2] or 0.0)

    @property
    def is_zero_at_rest(self) -> bool:
        """Whether that column is zero while the machine waits between two sweeps."""
        return self.state in ZERO_AT_REST

    @property
    def needs(self) -> frozenset[str]:
        """Columns of the samples that its functions follow from."""
        factors = {"mount" if mount_of(each) is not None else each for each in self.all_times}
        named = {"time_s" if is_growing(each) else each for each in (*factors, self.column)} - {""}
        remembered = {"time_s" for each in named if OF_MEMORY in each}
        return frozenset({each.partition(OF_MEMORY)[0] for each in named} | remembered)

    @property
    def is_anew(self) -> bool:
        """Whether it is another with each sweep, as its column counts."""
        return self.column == EACH_SWEEP

    @property
    def is_constant(self) -> bool:
        """Whether it is an offset that nothing changes."""
        return not self.needs

    @property
    def is_smooth(self) -> bool:
        """Whether it has splines enough for their smoothness to be chosen."""
        return self.count > SPLINES_MIN and not self.instants

    @property
    def may_be_finer(self) -> bool:
        """Whether readings may ask for more splines."""
        return self.is_smooth and not self.is_coarse
