"""Colours of all pictures and pages: a direction has one hue everywhere, and nothing else has it.

Okabe and Ito's palette, which the colour-blind can tell apart.
"""

from __future__ import annotations

MEASURED_COLOURS = {1: "#56B4E9", -1: "#E69F00"}
"""Light blue counter-clockwise, orange clockwise."""
PREDICTED_COLOURS = {1: "#004B76", -1: "#8C3A00"}
"""The same two hues, dark enough to be seen on the measured path they should cover."""
BY_NAME = {
    "ccw": PREDICTED_COLOURS[1],
    "cw": PREDICTED_COLOURS[-1],
    "moving up": "#009E73",
    "moving down": "#CC79A7",
}
"""Lines of a predictor that are told apart: directions of the circle, directions of travel."""
COMMON_COLOUR, REVERSING_COLOUR = "#009E73", "#CC79A7"
"""Part common to both directions of the circle, and part that reverses with the direction."""
LINE_COLOUR = "#404040"
"""What belongs to no direction."""
FUNCTION_COLOUR, BAND_COLOUR, FORMULA_COLOUR = "#00694D", "#009E73", "#D55E00"
"""A function learned, its band, and the formula of a known effect."""
NOMINAL_COLOUR = "#595959"
GRID_COLOUR = "#D9D9D9"
