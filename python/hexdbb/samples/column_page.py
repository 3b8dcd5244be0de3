"""The glossary's table of the columns of the table of samples, generated from the engine's vocabulary.

The engine describes the columns of a sample's state (`state.hpp`, `for_each_column`); `OWN` describes those that the
table of samples adds. To rewrite the committed page: ``python -m hexdbb.samples.column_page docs/glossary.md``.
"""

from __future__ import annotations

import sys
from pathlib import Path

from hexdbb import _core
from hexdbb.record.file_pages import replaced
from hexdbb.samples.leg_directions import LEG_DIRECTIONS
from hexdbb.samples.load_shares import SHARES
from hexdbb.samples.since_turn import TURNS_OF_LOADS

BEGIN = "<!-- columns: made by `python -m hexdbb.samples.column_page docs/glossary.md`; do not edit -->"
END = "<!-- end of columns -->"
OWN = {
    "record": ("sample", "1", "index of the record in `Samples.records`"),
    "set_up": ("sample", "1", "index of cup, ball and bar in `Samples.set_ups`: one for each circle of each record"),
    "mount": ("sample", "1", "index of the fixing of the cup in `Samples.mounts`"),
    "reading_mm": ("sample", "mm", "ball-bar length minus nominal length"),
    "swing_angle_rad": ("leg", "rad", "angle of the leg about its guideway, from the guideway's sideways axis"),
    "swing_rate_rad_s": ("leg", "rad/s", "rate of the leg's swing about its guideway"),
    "leg_inclination_rad": ("leg", "rad", "angle of the leg to the vertical, nominal machine"),
    "time_in_sweep_s": ("sample", "s", "time since the first sample of the sweep"),
    "time_in_circle_s": (
        "sample",
        "s",
        "time since the first sample of the circle; nan where there is one only, or one sweep of each",
    ),
    "time_since_fixing_s": ("sample", "s", "time since the first sample of the fixing; nan where there is one only"),
    "wound_rad": (
        "sample",
        "rad",
        "angle turned since the first sample of the fixing, with its sign; nan where each has one sweep",
    ),
    "turned_rad": ("sample", "rad", "angle turned since the first sample of the sweep, with its sign"),
    "drive_load": ("leg", "1", "part of `leg_force` along the guideway"),
    "carriage_load": ("leg", "1", "part of `leg_force` across the guideway"),
    **{name: ("leg", "1", f"axial force of the leg by {load}") for name, load in SHARES.items()},
    **{name: ("leg", "1", f"{meaning}, nominal machine") for name, meaning in LEG_DIRECTIONS.items()},
    "carriages_acceleration_mm_s2": ("axis", "mm/s^2", "sum of the sliders' accelerations as vectors, base frame"),
    **{
        name: (
            "leg",
            "1",
            f"direction in which `{load}` changes, +1 or -1; 0: never changed"
            if name.endswith("direction")
            else f"change of `{load}` since it turned; 1e6: neither in its sweep nor along the run-up",
        )
        for name, load in TURNS_OF_LOADS.items()
    },
    "gap_mm": ("slider", "mm", "the slider's coordinate less that of the other one on its guideway"),
    "gap_rate_mm_s": ("slider", "mm/s", "the slider's velocity less that of the other one on its guideway"),
    "power_mm2_s3": ("slider", "mm^2/s^3", "velocity times acceleration of the slider; negative: it brakes"),
    "feed_ratio": ("sample", "1", "commanded speed along the circle over 50 mm/s"),
    "feed_ratio_squared": ("sample", "1", "the square of that"),
    "radius_mm": ("sample", "mm", "distance of the platform from the base's z axis, nominal machine"),
    "neighbour_velocity_mm_s": ("slider", "mm/s", "velocity of the other slider on the guideway"),
    "neighbour_acceleration_mm_s2": ("slider", "mm/s^2", "acceleration of the other slider on the guideway"),
    "neighbour_travel_direction": ("slider", "1", "direction of travel of the other slider on the guideway"),
    "screw_cos": ("slider", "1", "cosine of the angle that the slider's screw has turned from coordinate 0"),
    "screw_sin": ("slider", "1", "its sine"),
    "course": ("axis", "1", "direction in which the platform moves, a unit vector in the base frame; 0: it stands"),
    "course_in_platform": ("axis", "1", "the same in the platform frame"),
    **{f"course_{axis}": ("sample", "1", f"part of `course` along {axis}") for axis in "xy"},
    "gravity_in_platform": ("axis", "1", "direction in which gravity acts, a unit vector in the platform frame"),
    "tilt_rad": ("sample", "rad", "angle of the platform's z to the vertical"),
    "downhill_in_platform": ("axis", "1", "unit vector in its x-y plane to the platform's lower side; 0: it is level"),
    "bar_angle_rad": ("sample", "rad", "angle of the bar about the platform's z, nominal machine"),
    "bar_azimuth_rad": ("sample", "rad", "angle of the bar about the base's z, nominal machine"),
    "bar_elevation_rad": ("sample", "rad", "angle of the bar to the horizontal, nominal machine"),
    "deflection_mm": ("sample", "mm", "reading predicted by geometry and set-up as the readings determine them"),
    "gauge_scale_mm": ("sample", "mm", "where the gauge stands on its scale: the measured reading, nominal if planned"),
    "deflection_direction": ("sample", "1", "direction in which that changes, +1 or -1; 0: never moved"),
    "deflection_turning_mm": ("sample", "mm", "deflection times that direction"),
    "deflection_since_turn_mm": ("sample", "mm", "travel of the gauge since it turned; 1e6: likewise"),
    "NAME.lagged@S": ("sample", "1", "column `NAME` behind a first-order lag of `S` seconds, of its shape and unit"),
    "NAME.relaxing@S": ("sample", "1", "column `NAME` less the same"),
    "NAME.slipping@X": (
        "sample",
        "1",
        "column `NAME` as a contact feels it that yields by `X`, in its unit, then slips",
    ),
    "NAME.heated@S": (
        "sample",
        "1",
        "first-order lag, of `S` seconds, of the amount of the velocity `NAME`: from zero, and zero while it waits",
    ),
    "NAME.after@D": ("sample", "s", "time `NAME` and what a run-up of `D` degrees takes at the sweep's rate"),
    "NAME.along@D": (
        "sample",
        "1",
        "part of the vector `NAME` along the direction of `D` degrees in the x-y plane of its frame",
    ),
    "NAME.turning@R": (
        "sample",
        "1",
        "sign of the rate `NAME`, smoothed at zero: NAME / sqrt(NAME² + R²)",
    ),
    "NAME.relay@L/H": (
        "sample",
        "1",
        "+1 once column `NAME` has risen to `H`, -1 once it has fallen to `L`, else as it was; of its shape",
    ),
}
"""What they belong to, unit and meaning of the columns that are no part of the engine's state."""
INSIDE_THE_ENGINE = {"row"}
"""Columns that the engine fills in for parts of a table; a table of samples has `Samples.row_numbers`."""
SHAPES = {"sample": "(n,)", "axis": "(n, 3)", "slider": "(n, 6), sliders", "leg": "(n, 6), legs"}
"""Shape of a column by what its numbers belong to."""
UNITS = {"1": "", "degC": "°C"}
"""Units written otherwise for people than in the engine."""


def column_table() -> str:
    """Return the Markdown table of every column that `Samples` can have: name, shape, unit, meaning."""
    lines = ["| column | shape | unit | meaning |", "|---|---|---|---|"]
    lines += [_line(name, *described) for name, described in OWN.items()]
    known = [each for each in _core.state_columns() if each.name not in INSIDE_THE_ENGINE]
    lines += [_line(each.name, each.of, each.unit, each.meaning) for each in known]
    return "\n".join(lines)


def updated(page: str) -> str:
    """Return the glossary's text with the table between its markers generated anew."""
    return replaced(page, BEGIN, END, column_table())


def _line(name: str, of: str, unit: str, meaning: str) -> str:
    shown = UNITS.get(unit, unit.replace("^2", "²").replace("^3", "³").replace("^4", "⁴"))
    return f"| `{name}` | {SHAPES[of]} | {shown} | {meaning} |"


def main(page: Path) -> None:
    """Rewrite the table of the glossary."""
    page.write_text(updated(page.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
