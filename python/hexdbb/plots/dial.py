"""Round panels: angle and deviation drawn in plain axes, whose frame and ticks are never made.

matplotlib's own polar axes take twenty times as long to make and to draw; of these a comparison has thirty.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike, NDArray

from hexdbb.plots.labels import Labels


class Dial:
    """A panel about its middle; angles counter-clockwise from the right, radians.

    Parameters
    ----------
    axes : Axes
        Empty; it gets no frame.
    centre, rim : float
        Values in the middle and at the rim.
    beside : float
        Half of the panel's width over the radius: more than 1 leaves room for labels at either side.
    """

    def __init__(self, axes: Axes, centre: float, rim: float, beside: float = 1.0) -> None:
        self.axes, self.centre, self.rim = axes, centre, rim
        axes.set_axis_off()
        axes.set(xlim=(-beside, beside), ylim=(-1.0, 1.0), aspect="equal")

    def places(self, angle_rad: ArrayLike, value: ArrayLike) -> NDArray[np.float64]:
        """Return where angles and values lie in the panel, shape (n, 2): the rim has radius 1."""
        angle = np.asarray(angle_rad, dtype=np.float64)
        radius = (np.asarray(value, dtype=np.float64) - self.centre) / (self.rim - self.centre)
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])

    def line(self, angle_rad: ArrayLike, value: ArrayLike, **style: Any) -> Line2D:
        """Draw a line, straight between its points."""
        drawn = Line2D(*self.places(angle_rad, value).T, **style)
        self._add(drawn)
        return drawn

    def lines(self, every: list[NDArray[np.float64]], **style: Any) -> LineCollection:
        """Draw lines of one style, each of shape (n, 2): angle and value."""
        drawn = LineCollection([self.places(*line.T) for line in every], **style)
        self.axes.add_collection(drawn, autolim=False)
        drawn.set_clip_path(None)  # a collection's clip has another name in each SVG; nothing lies beyond the rim
        drawn.set_in_layout(False)
        return drawn

    def labels(self, angle_rad: ArrayLike, value: ArrayLike, texts: Sequence[str], **style: Any) -> Labels:
        """Write short texts at places."""
        angles, values = np.broadcast_arrays(angle_rad, value)
        return Labels(self.axes, self.places(angles, values), texts, **style)

    def _add(self, line: Line2D) -> None:
        self.axes.add_line(line)
        line.set_clip_on(False)
        line.set_in_layout(False)
