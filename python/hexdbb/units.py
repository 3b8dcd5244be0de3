"""Units of output: the engine's mm, rad and s as micrometres, microradians and milliseconds, with the unit named.

Unit names are ASCII (`um`) in identifiers, JSON and files; `readable_unit` gives the sign (`µm`) for people.
"""

from __future__ import annotations

SHOWN = {
    "mm": ("um", 1e3),
    "rad": ("urad", 1e6),
    "s": ("ms", 1e3),
    "mm/N": ("um/N", 1e3),
    "mm/K": ("um/K", 1e3),
    "mm/s": ("um/h", 3.6e6),
    "mm/mm": ("um/m", 1e6),
    "1/K": ("um/m/K", 1e6),
    "1/s": ("um/m/h", 3.6e9),
}
"""Engine unit to (unit of output, factor); a unit not listed is output unchanged."""


VERBATIM = "="
"""A unit behind this sign is output unchanged: a place along a guideway stays in mm."""


def shown_unit(engine_unit: str) -> str:
    """Return the ASCII name of the unit in which a value of `engine_unit` is output, for JSON and files."""
    return SHOWN.get(engine_unit, (engine_unit.removeprefix(VERBATIM), 1.0))[0]


def shown_factor(engine_unit: str) -> float:
    """Return the factor from `engine_unit` to its unit of output."""
    return SHOWN.get(engine_unit, (engine_unit, 1.0))[1]


def readable_unit(unit: str) -> str:
    """Return a unit's ASCII name as people read it: ``µm/m`` for ``um/m``, ``µrad`` for ``urad``."""
    return "/".join(f"µ{part[1:]}" if part in {"um", "urad"} else part for part in unit.split("/"))
