"""One predictor of the residual: what the bins of a variable explain."""

from __future__ import annotations

import numpy as np

from hexdbb.predictors import Predictor
from hexdbb.reporting.drawings.axes import Frame, padded, round_ticks
from hexdbb.reporting.drawings.svg import chart, element, label, path

WIDTH, HEIGHT = 300.0, 170.0
CLASS_OF = {"ccw": "mean ccw", "cw": "mean cw", "moving up": "up", "moving down": "down"}
"""Lines that are told apart, as in `hexdbb.charts.colours.BY_NAME`."""


def predictor_svg(predictor: Predictor) -> str:
    """Draw the response in the reading, µm, over the variable."""
    centres = np.concatenate([each.centre for each in predictor.profiles])
    means = np.concatenate([each.mean_um for each in predictor.profiles])
    low, high = float(centres.min()), float(centres.max())
    room = 0.5 if not predictor.unit else 0.02 * max(high - low, 1e-9)
    frame = Frame(WIDTH, HEIGHT, (low - room, high + room), padded(means))
    x_ticks = np.unique(centres) if not predictor.unit else round_ticks(*frame.x_range, 5)
    names = dict(predictor.classes)
    shown = np.zeros(0) if names else x_ticks
    inside = list(frame.grid(shown, round_ticks(*frame.y_range, 4), predictor.unit, "µm"))
    inside += [
        label(names[tick], float(frame.x(tick)), HEIGHT - 17.0, text_anchor="middle", class_="tick")
        for tick in x_ticks.tolist()
        if tick in names and len(names) <= 8
    ]
    for profile in predictor.profiles:
        kind, x, y = CLASS_OF.get(profile.name, "only"), frame.x(profile.centre), frame.y(profile.mean_um)
        if predictor.unit:
            inside.append(path(x, y, class_=kind))
        else:
            inside += [
                element("circle", cx=across, cy=down, r=3.5, class_=f"dot {kind}")
                for across, down in zip(x.tolist(), y.tolist(), strict=True)
            ]
    return chart(f"Residual against {predictor.variable}, µm", frame.box, inside, class_="predictor")
