"""Effect of one prior standard deviation on the reading along the thesis' circle, in both directions, as a picture.

One parameter at a time of the effect's first element is given its prior standard deviation, and the prediction is run
with and without it. The circle is run 0.1 mm off the bar's length, so that a gauge's gain shows; temperature rises by
1 K a lap for effects of temperature, and is not measured for all others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.effects.handbook import effect_infos, handbook, shown_size
from hexdbb.machine import MachineFile
from hexdbb.model import new_model
from hexdbb.plan import load_plan
from hexdbb.samples import Samples, predict

Floats = NDArray[np.float64]

PER_LAP = 720
BAR_MM = 99.9
UM_PER_MM = 1000.0
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
"""Okabe and Ito's palette, one a parameter; clockwise is dashed."""
FLAT = 1e-6
"""A change that varies by less than this part of its size is drawn as constant."""
SHARE_OF_RADIUS = 0.3
"""Part of the circle's drawn radius that the largest deviation takes."""


@dataclass(frozen=True)
class Signature:
    """Change of the reading by one parameter of an effect, µm, shape (directions, n)."""

    parameter: _core.ParameterInfo
    change_um: Floats


def write_handbook(folder: Path) -> list[Path]:
    """Write every page and picture of the handbook; return their paths."""
    images = folder / "images"
    images.mkdir(parents=True, exist_ok=True)
    written = []
    for name, text in handbook().items():
        written.append(folder / name)
        written[-1].write_text(text, encoding="utf-8")
    angle_rad, directions, samples = _circle()
    for info in effect_infos():
        written.append(images / f"{info.name}.png")
        _draw(info, angle_rad, directions, signatures(info, samples), written[-1])
    return written


def signatures(info: _core.EffectInfo, samples: Sequence[Samples]) -> list[Signature]:
    """Compute the signature of every parameter that pushes by itself: the largest of those in some tables."""
    still = new_model(_machine(), [info.name])
    found = []
    for index, parameter in enumerate(info.parameters):
        if parameter.is_shape:
            continue
        values = np.zeros(len(still.values))
        values[index] = parameter.prior_sigma
        moved = still.with_values(values)
        changes = [UM_PER_MM * (predict(each, moved).reading_mm - predict(each, still).reading_mm) for each in samples]
        largest = max(changes, key=lambda change: float(np.abs(change).max()))
        found.append(Signature(parameter, largest.reshape(-1, PER_LAP)))
    return found


def _machine() -> MachineFile:
    return load_plan("thesis").machine_file()


def _circle() -> tuple[Floats, list[int], list[Samples]]:
    """Return polar angles, directions, and samples of one lap in each direction, with and without a thermometer."""
    plan = load_plan("thesis")
    runs = [next(run for run in plan.runs() if run.direction == direction) for direction in (1, -1)]
    angle_rad = np.arange(PER_LAP, dtype=np.float64) * (2.0 * np.pi / PER_LAP)
    warming_k = np.tile(angle_rad / (2.0 * np.pi), len(runs))
    samples = [Samples.planned(_machine(), runs, angle_rad, BAR_MM, warming_k=each) for each in (None, warming_k)]
    return angle_rad, [run.direction for run in runs], samples


def _draw(info: _core.EffectInfo, angle_rad: Floats, directions: list[int], drawn: list[Signature], path: Path) -> None:
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    FigureCanvasAgg(figure)
    plain = figure.add_subplot(1, 2, 1)
    polar = figure.add_subplot(1, 2, 2, projection="polar")
    largest = max(float(np.abs(each.change_um).max()) for each in drawn) or 1.0
    closed = np.append(angle_rad, angle_rad[:1] + 2.0 * np.pi)
    polar.plot(closed, np.ones(len(closed)), color="0.6", linewidth=0.8)
    for signature, colour in zip(drawn, COLOURS, strict=False):
        for direction, change_um in zip(directions, signature.change_um, strict=True):
            polar_angle = np.mod(direction * angle_rad, 2.0 * np.pi)
            order = np.argsort(polar_angle)
            way = "counter-clockwise" if direction > 0 else "clockwise"
            label = f"{signature.parameter.name} {shown_size(signature.parameter)}" if direction > 0 else None
            line: dict[str, Any] = {
                "color": colour,
                "linestyle": "-" if direction > 0 else "--",
                "linewidth": 1.1,
                "gid": way,
            }
            plain.plot(np.degrees(polar_angle[order]), change_um[order], label=label, **line)
            polar.plot(polar_angle[order], 1.0 + SHARE_OF_RADIUS * change_um[order] / largest, **line)
    plain.set(xlabel="polar angle (deg)", ylabel="change of the reading (µm)", xlim=(0, 360), xticks=range(0, 361, 60))
    plain.set_title(f"{info.name}, {info.element_kind} {info.elements[0]}; dashed: clockwise", fontsize=9)
    plain.grid(alpha=0.3)
    if all(np.ptp(each.change_um) < FLAT * largest for each in drawn):
        plain.set_ylim(0.0, 1.5 * largest)  # or rounding errors would fill the picture
    plain.legend(fontsize=8)
    polar.set_yticks([])
    polar.set_ylim(0.0, 1.0 + 1.3 * SHARE_OF_RADIUS)
    polar.set_title(f"largest deviation {largest:.3g} µm", fontsize=9)
    figure.savefig(path, dpi=100, metadata={"Software": None})
