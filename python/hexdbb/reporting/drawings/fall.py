"""The falling error: root mean square residual after each step of the model, fitted and held-out circles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hexdbb.model import LedgerStep
from hexdbb.reporting.drawings.axes import Frame
from hexdbb.reporting.drawings.svg import chart, element, label, path

WIDTH, HEIGHT = 440.0, 220.0
LEAST_UM = 1e-3
"""Smallest error drawn: a nanometre, far below any gauge."""
DECADE = (1.0, 2.0, 5.0)


def fall_svg(steps: Sequence[LedgerStep], noise_um: float) -> str:
    """Draw the error on a logarithmic scale, from before the first step to after the last, with the noise.

    Parameters
    ----------
    steps : sequence of LedgerStep
        One at least.
    noise_um : float
        Of one reading.
    """
    fitted = [steps[0].rms_before_um, *(step.rms_after_um for step in steps)]
    held = [steps[0].heldout_before_um, *(step.heldout_after_um for step in steps)]
    held_um = np.array([np.nan if each is None else each for each in held])
    fitted_um, at = np.maximum(np.array(fitted), LEAST_UM), np.arange(len(fitted), dtype=np.float64)
    every = np.concatenate([fitted_um, held_um[np.isfinite(held_um)], [max(noise_um, LEAST_UM)]])
    low, high = np.log10(every.min()) - 0.15, np.log10(every.max()) + 0.2
    frame = Frame(WIDTH, HEIGHT, (-0.3, len(steps) + 0.7), (float(low), float(high)))
    inside = [*_grid(frame, len(steps)), _noise(frame, noise_um)]
    for kind, values_um in (("held", held_um), ("fitted", fitted_um)):
        y = frame.y(np.log10(values_um))
        inside.append(path(frame.x(at), y, class_=f"fall {kind}"))
        radius = {"fitted": 4, "held": 6}[kind]
        inside += [
            element("circle", cx=float(frame.x(place)), cy=float(down), r=radius, class_=f"dot {kind}")
            for place, down in zip(at, y, strict=True)
            if np.isfinite(down)
        ]
    inside += [
        label(f"{value:.2f}", float(frame.x(place)) + 9.0, float(frame.y(np.log10(value))) - 6.0, class_="value")
        for place, value in zip(at, fitted_um, strict=True)
    ]
    title = "Root mean square residual after each step of the model, µm, logarithmic"
    return chart(title, frame.box, inside, class_="fallen")


def _grid(frame: Frame, count: int) -> list[str]:
    low, high = frame.y_range
    ticks = [
        step * 10.0**decade
        for decade in range(int(np.floor(low)), int(np.ceil(high)) + 1)
        for step in DECADE
        if low <= np.log10(step * 10.0**decade) <= high
    ]
    drawn = []
    for tick in ticks:
        at = float(frame.y(np.log10(tick)))
        drawn.append(element("line", x1=42, x2=WIDTH - 8.0, y1=at, y2=at, class_="ring"))
        drawn.append(label(f"{tick:g}", 38.0, at + 4.0, text_anchor="end", class_="tick"))
    names = ["at first", *(f"step {number}" for number in range(1, count + 1))]
    drawn += [
        label(name, float(frame.x(place)), HEIGHT - 12.0, text_anchor="middle", class_="tick")
        for place, name in enumerate(names)
        if count <= 10 or place % (-(-count // 10)) == 0
    ]
    return [*drawn, label("RMS residual, µm", 2.0, 11.0, class_="axis")]


def _noise(frame: Frame, noise_um: float) -> str:
    at = float(frame.y(np.log10(max(noise_um, LEAST_UM))))
    line = element("line", x1=42, x2=WIDTH - 8.0, y1=at, y2=at, class_="noise")
    return line + label(f"noise {noise_um:.2f} µm", WIDTH - 10.0, at + 13.0, text_anchor="end", class_="tick")
