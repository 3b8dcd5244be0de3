"""Run the benchmark of the compensator and write its page, docs/real-time.md.

Usage: compensation_report.py BENCHMARK_PROGRAM [-o docs/real-time.md]
Single calls are timed, so that the page can tell the tail; a busy machine makes it longer, not shorter.
"""

from __future__ import annotations

from pathlib import Path

from measured_by import compiler, median_rows, processor, report

REPETITIONS = 5
TITLES = {
    "sliders/geometry": "targets: the thesis' 33 geometric errors",
    "sliders/backlash": "the same and backlash",
    "sliders/pitch": "geometry and pitch errors",
    "sliders/sag": "geometry and sag under the platform's weight",
    "sliders/usual": "geometry, backlash, pitch errors and sag",
    "sliders/all": "every effect that can be corrected, thermal growth included",
    "pose/geometry": "pose of slider coordinates: geometry",
    "pose/usual": "the same: geometry, backlash, pitch errors and sag",
    "pose/all": "the same: every effect",
}
TABLES = {
    "table/vertical": "height of both sliders of a guideway, by their positions",
    "table/position": "position of a slider",
    "table/velocity": "velocity of a slider, with a step at 0",
    "table/acceleration": "acceleration of a slider, with a step at 0",
    "table/since_reversal": "travel of a slider since a reversal, times its direction",
    "table/turning": "turning rate of a leg's slider joint, with a step at 0",
    "table/joint_angle": "angle of a leg's slider joint",
    "table/swing": "swing rate of a leg, with a step at 0",
    "table/platform_angle": "angle of a leg's platform joint",
    "table/force": "force of a leg",
    "table/usual_turning": "beside pitch errors and sag: turning rate",
    "table/usual_vertical": "beside pitch errors and sag: height, by position",
}
PAGE = """\
# Real time

`Compensator::sliders` and `Compensator::pose` (C: `hexdbb_sliders_from_pose`, `hexdbb_pose_from_sliders`) are made for
the cycle of a motion controller: after creation they do not allocate, throw, lock or make system calls, and they take
at most four inverse solutions (`kMaxIterations`), each in closed form. Each claim has a test:

| claim | test |
|---|---|
| no allocation in 100,000 calls of each, all effects and tables | `test_no_allocation.cpp` counts `new` and `malloc` |
| no system call, hence no blocking lock | `test_real_time.cpp`: 100,000 calls under seccomp's strict mode |
| no exception | declared `noexcept`; a pose that is not finite or out of reach is a status |
| continuous at reversals, constant at standstill | `test_compensation.cpp` |

## Time of a call
Machine: {processor}. Compiler: {compiler}, `-O3` for any x86-64, AVX2 chosen at load time.
A circle of 90 mm at 3000 mm/min, one pose per millisecond, platform tilted; single calls timed, the time of the clock
subtracted. Medians of {repetitions} repetitions; made by `make bench`. Goal: 200 ns, and 99.9 % of calls within three
times the median.

| work | median | 99.9 % within | tail / median | most iterations |
|---|---|---|---|---|
{targets}

| work | time |
|---|---|
{poses}

A table of a learned or user's effect, added to geometry and backlash; both compensators compute the same pose in turn,
and the clock's own time is in both; means of the middle half of all calls. The first table of a leg's force, or of what
turns at the platform, includes solving for these. Goal: 60 ns.

| function of | without | with | added | with / without |
|---|---|---|---|---|
{tables}

The C interface adds the three rotations of roll, pitch and yaw: some tens of ns.
A lag proportional to velocity, and a function of a turning rate, are corrected with the velocities of the controller,
without those of the correction itself: at 3000 mm/min and 2 ms of lag the difference is below 1 µm.
"""


def results(program: Path) -> dict[str, dict[str, float]]:
    """Median row of each benchmark, by its name without the kind of time."""
    return {name.removesuffix("/manual_time"): row for name, row in median_rows(program, REPETITIONS).items()}


def page(rows: dict[str, dict[str, float]]) -> str:
    """Lay out the page."""
    targets, tables, poses = [], [], []
    for name, row in rows.items():
        title = (TITLES | TABLES).get(name, name)
        if "without_ns" in row:
            without, with_table = row["without_ns"], row["with_ns"]
            ratio = f"{with_table / without:.2f}"
            tables.append(
                f"| {title} | {without:.0f} ns | {with_table:.0f} ns | {with_table - without:.0f} ns | {ratio} |"
            )
        elif "p999_ns" in row:
            median, tail = row["median_ns"], row["p999_ns"]
            iterations = f"{row['iterations_needed']:.0f}"
            targets.append(f"| {title} | {median:.0f} ns | {tail:.0f} ns | {tail / median:.1f} | {iterations} |")
        else:
            poses.append(f"| {title} | {row['cpu_time']:.0f} ns |")
    return PAGE.format(
        processor=processor(),
        compiler=compiler(),
        repetitions=REPETITIONS,
        targets="\n".join(targets),
        tables="\n".join(tables),
        poses="\n".join(poses),
    )


if __name__ == "__main__":
    report(__doc__, "the benchmark of the compensator", lambda program: page(results(program)))
