"""Units at the edges: the engine's mm, rad and s as µm, µrad and ms in files, tables and JSON, with the unit named."""

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
"""Engine unit to (unit shown, factor); a unit not listed is shown as it is."""


def shown_unit(engine_unit: str) -> str:
    """Name the unit in which a value of `engine_unit` is shown."""
    return SHOWN.get(engine_unit, (engine_unit, 1.0))[0]


def shown_factor(engine_unit: str) -> float:
    """Give the factor from `engine_unit` to the unit shown."""
    return SHOWN.get(engine_unit, (engine_unit, 1.0))[1]


def printed_unit(shown: str) -> str:
    """Return a unit as printed for people: `um` and `urad` of files and JSON become µm and µrad."""
    return shown.replace("um", "µm").replace("urad", "µrad")
