"""The numbers and the picture of docs/linuxcnc.md: `python -m tests.linuxcnc.report IMAGE.png`; prints its tables."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import click
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from tests.linuxcnc.machine import true_machine, write_compensation
from tests.linuxcnc.module import built_module
from tests.linuxcnc.program import CIRCLES, arcs, program
from tests.linuxcnc.readings import measured_paths, roundness
from tests.linuxcnc.session import PERIOD_S, Session, run_linuxcnc

from hexdbb.comparison import iso230
from hexdbb.machine import shipped_machine

Paths = dict[tuple[str, bool, int], iso230.Path]


@click.command(help=__doc__)
@click.argument("image", type=click.Path(path_type=Path))
def main(image: Path) -> None:
    truth = true_machine()
    with tempfile.TemporaryDirectory() as folder:
        compensation = Path(folder) / "sp120.hexcomp"
        write_compensation(truth, compensation)
        session = run_linuxcnc(Path(folder) / "work", built_module(), compensation, program())
    by_tag = measured_paths(session, arcs(), truth, shipped_machine())
    paths = {(arc.circle.name, arc.is_compensated, arc.direction): by_tag[arc.tag] for arc in arcs()}
    click.echo("\n".join([*_error_table(paths), "", *_servo_table(session)]))
    _draw(paths, image)


def _error_table(paths: Paths) -> Iterator[str]:
    yield "| circle | quantity | compensation off | on | reduction factor |"
    yield "|---|---|---|---|---|"
    for circle in CIRCLES:
        off, on = (roundness(paths[circle.name, on, 1], paths[circle.name, on, -1]) for on in (False, True))
        rows = {
            "radial error, RMS": (off.rms, on.rms),
            "peak to valley, G(b)": (off.peak_to_valley, on.peak_to_valley),
            "hysteresis, H": (off.hysteresis, on.hysteresis),
        }
        for name, (before, after) in rows.items():
            yield f"| {circle.name} | {name} | {1e3 * before:.1f} µm | {1e3 * after:.2f} µm | {before / after:.0f} |"


def _servo_table(session: Session) -> Iterator[str]:
    yield "| compensation | inverse kinematics, median | 99.9 % within | largest slider acceleration |"
    yield "|---|---|---|---|"
    tag, spent_ns = session.columns["tag"], session.columns["inverse_ns"]
    acceleration = np.abs(np.diff(session.sliders_mm, n=2, axis=0)).max(axis=1) / PERIOD_S**2
    for name, is_on in (("off", False), ("on", True)):
        tags = [arc.tag for arc in arcs() if arc.is_compensated == is_on]
        rows = np.flatnonzero(np.isin(tag, tags))
        # The first and last second of an arc are acceleration and braking.
        steady = np.concatenate([np.flatnonzero(tag == each)[1000:-1000] for each in tags])
        median, tail = np.percentile(spent_ns[rows], [50.0, 99.9])
        yield f"| {name} | {median:.0f} ns | {tail:.0f} ns | {acceleration[steady].max():.0f} mm/s² |"


def _draw(paths: Paths, image: Path) -> None:
    figure = Figure(figsize=(10.0, 5.0), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(2, len(CIRCLES), sharex=True)
    for column, circle in zip(axes.T, CIRCLES, strict=True):
        for axis, is_on in zip(column, (False, True), strict=True):
            both = [paths[circle.name, is_on, direction] for direction in (1, -1)]
            centre = iso230.set_up_centre_mm(*both)
            for path, label in zip(both, ("counter-clockwise", "clockwise"), strict=True):
                about = path.about(centre)
                axis.plot(np.degrees(about.angle_rad), 1e3 * about.deviation_mm, linewidth=0.9, label=label)
            axis.set_title(f"{circle.name}: compensation {'on' if is_on else 'off'}", fontsize=9)
            axis.set_ylabel("radial error, µm")
            axis.grid(linewidth=0.3)
        column[1].set_xlabel("angle, degrees")
        column[1].set_xticks(range(0, 361, 60))
    axes[0, 0].legend(fontsize=7)
    figure.savefig(image, dpi=110)


if __name__ == "__main__":
    main()
