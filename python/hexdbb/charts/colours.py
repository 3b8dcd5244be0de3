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
TEXT_COLOUR, QUIET_COLOUR, PAPER_COLOUR, RULE_COLOUR = "#1A1A1A", "#555555", "#FFFFFF", "#C8C8C8"
"""Pages: text, lesser text (7:1 on paper), background, rules."""
PASS_COLOUR, FAIL_COLOUR, NOTE_COLOUR = "#00573F", "#9B1C00", "#004B76"
"""Judgements on paper, all above 7:1; words say the same beside them."""


STYLE = {
    "measured-ccw": MEASURED_COLOURS[1],
    "measured-cw": MEASURED_COLOURS[-1],
    "predicted-ccw": PREDICTED_COLOURS[1],
    "predicted-cw": PREDICTED_COLOURS[-1],
    "common": COMMON_COLOUR,
    "reversing": REVERSING_COLOUR,
    "line": LINE_COLOUR,
    "nominal": NOMINAL_COLOUR,
    "grid": GRID_COLOUR,
    "text": TEXT_COLOUR,
    "quiet": QUIET_COLOUR,
    "paper": PAPER_COLOUR,
    "rule": RULE_COLOUR,
    "pass": PASS_COLOUR,
    "fail": FAIL_COLOUR,
    "note": NOTE_COLOUR,
}
"""CSS variables of pages, without the dashes before them."""


def style_sheet() -> str:
    """Return the colours as CSS variables of a page, so that page and pictures have one source."""
    return ":root{" + ";".join(f"--{name}:{colour}" for name, colour in STYLE.items()) + "}"


def resolved(css: str) -> str:
    """Return CSS with the colours in place of their variables, for what knows none."""
    for name, colour in STYLE.items():
        css = css.replace(f"var(--{name})", colour)
    return css
