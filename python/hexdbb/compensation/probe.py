"""Samples that were never taken: states in which a user's effect is asked what it pushes.

They look like `hexdbb.samples.Samples` to the effect's function, have the columns that a controller knows, and note
which of them the function reads.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.machine import MachineFile

Floats = NDArray[np.float64]

WHOLE = ("temperature_c", "warming_k")
"""Columns of the whole machine; those of sliders and legs have shape (n, 6)."""
SWITCHES = ("travel_direction", "slider_joint_direction")
"""Columns that are +1 or -1 but for the travel over which they change."""
NO_FACTORS = ("sliders_mm", "since_reversal_mm")
"""Columns by which no controller multiplies a function (`may_multiply` in compensation_tables.hpp)."""
LOGARITHMIC = ("since_reversal_mm",)
"""Columns whose logarithm is spread evenly: what follows a reversal may be over within a play of some µm."""
SHORTEST_MM = 1e-4
"""Shortest travel since a reversal that is asked for, an encoder count; nearer, a table is held."""


def ranges(machine: MachineFile) -> dict[str, tuple[float, float]]:
    """Return the range of every column that a controller knows, in its unit; beyond it a table is held."""
    fastest = machine.can_setup.limits.velocity_mm_s
    quickest = machine.can_setup.limits.acceleration_mm_s2
    # The ball joint of two legs that are drawn apart by both sliders at full speed, at a third of a leg's length.
    turning = 3.0 * fastest / min(machine.legs.lengths_mm)
    travels_mm = machine.sliders.travels_mm
    found = {
        "sliders_mm": (min(low for low, _ in travels_mm), max(high for _, high in travels_mm)),
        "velocity_mm_s": (-fastest, fastest),
        "travel_direction": (-1.0, 1.0),
        "leg_force": (-2.0, 2.0),  # six steep legs carry a sixth each; legs that nearly lie carry several times that
        "temperature_c": (0.0, 60.0),  # of any workshop
        "warming_k": (-30.0, 30.0),
        "slider_joint_angle_rad": (0.0, np.pi),
        "slider_joint_rate_rad_s": (-turning, turning),
        "slider_joint_direction": (-1.0, 1.0),
        "platform_joint_angle_rad": (0.0, np.pi),
        "platform_joint_rate_rad_s": (-turning, turning),
        "swing_angle_rad": (-np.pi, np.pi),
        "swing_rate_rad_s": (-turning, turning),
        "since_reversal_mm": (SHORTEST_MM, max(high - low for low, high in travels_mm)),
        "acceleration_mm_s2": (-quickest, quickest),
        "leg_inclination_rad": (0.0, np.pi),
        "drive_load": (-2.0, 2.0),  # parts of the leg's force
        "carriage_load": (-2.0, 2.0),
    }
    return {name: found[name] for name in _core.TABLE_VARIABLES}


def places(column: str, low: float, high: float, count: int) -> Floats:
    """Return places from `low` to `high` at which a function of a column is taken, shape (count,)."""
    spread = np.geomspace if column in LOGARITHMIC else np.linspace
    found: Floats = spread(low, high, count)
    return found


class Probe:
    """Columns by name, as a user's function takes samples.

    Parameters
    ----------
    columns : mapping of str to ndarray, shape (n, 6) or (n,)
    """

    def __init__(self, columns: Mapping[str, Floats]) -> None:
        self._columns = columns
        self.read: dict[str, None] = {}
        """Columns that were read, in that order."""
        self.missing: str | None = None
        """The first column that was asked for in vain."""

    def __len__(self) -> int:
        return len(next(iter(self._columns.values())))

    def __getitem__(self, name: str) -> Floats:
        if name not in self._columns:
            self.missing = self.missing or name
            raise KeyError(name)
        self.read[name] = None
        return self._columns[name].copy()

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError:
            raise AttributeError(name) from None


def drawn_state(machine: MachineFile, count: int) -> dict[str, Floats]:
    """Return the columns a controller knows at `count` states drawn within their ranges, the same each time."""
    draw = np.random.default_rng(1)

    def drawn(name: str, low: float, high: float) -> Floats:
        shape = count if name in WHOLE else (count, 6)
        if name in LOGARITHMIC:
            logarithm: Floats = np.exp(draw.uniform(np.log(low), np.log(high), shape))
            return logarithm
        return draw.uniform(low, high, shape)

    found = {name: drawn(name, *limits) for name, limits in ranges(machine).items()}
    return found | {name: np.sign(found[name]) for name in SWITCHES}
