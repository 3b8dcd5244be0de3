"""Files of one set-up, one for each circle, as a program of a ball bar exports them: angle, reading, direction."""

from __future__ import annotations

from pathlib import Path

from tests.imports.make import PACE

from hexdbb.importing import mapping_of, save_mapping
from hexdbb.plan import load_plan
from hexdbb.rig.truth import TruthFile
from hexdbb_truth.simulate import simulate

PLAN, FEED_MM_MIN = "standard", 753.98
CIRCLES = {"level": 0, "rolled": 1, "pitched": 3}
"""Circles of the plan, all in one mount, by the names of the files."""


def write_files(folder: Path, *, with_mapping: bool) -> list[Path]:
    """Write the files, of a machine without errors, with a mapping file beside each if asked for."""
    plan = load_plan(PLAN)
    circles = tuple(each for each in plan.circles if each.id in CIRCLES.values())
    driven = plan.model_copy(update={"circles": circles, "feeds_mm_min": (FEED_MM_MIN,)})
    columns = simulate(TruthFile(seed=3), driven, 3, PACE).columns
    paths = []
    for name, circle in CIRCLES.items():
        rows = columns["circle"] == circle
        readings = zip(*(columns[each][rows] for each in ("angle_deg", "reading_um", "direction")), strict=True)
        lines = ["angle (deg),reading (um),direction", *(f"{a:.4f},{r:.1f},{d:+d}" for a, r, d in readings)]
        paths.append(folder / f"{name}.csv")
        paths[-1].write_text("\n".join(lines) + "\n")
        if with_mapping:
            mapping = mapping_of(plan=PLAN, circle=circle, feed_mm_min=FEED_MM_MIN)
            save_mapping(mapping, paths[-1].with_suffix(".toml"))
    return paths
