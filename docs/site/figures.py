"""Figures of the pages that the build draws anew: those of the handbook of effects, and those of the first look.

The committed ones are shown on a forge. `python -m docs.site.figures docs` rewrites them.
"""

from __future__ import annotations

import sys
from pathlib import Path

from docs.site.first_look import draw_first_look
from hexdbb.effects.signature import write_handbook


def draw_figures(docs: Path) -> list[Path]:
    """Draw the figures into the folders of pages, in place of those that are there; return their paths."""
    return [*draw_first_look(docs / "images"), *write_handbook(docs / "effects")]


if __name__ == "__main__":
    print(f"{len(draw_figures(Path(sys.argv[1])))} files")
