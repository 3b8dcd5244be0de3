"""Figures of the pages that the build draws anew: those of the handbook of effects, and those of the first look.

The committed ones are shown on a forge. `python -m docs.site.figures docs` rewrites them.
"""

from __future__ import annotations

import sys
from pathlib import Path

from docs.site.first_look import draw_first_look

from hexdbb.effects.signature import write_handbook


def draw_figures(docs: Path) -> list[Path]:
    """Draw the figures, and write the handbook that they belong to, into a folder of pages; return the pictures' paths.

    What stands there is replaced.
    """
    (docs / "images").mkdir(parents=True, exist_ok=True)
    written = [*draw_first_look(docs / "images"), *write_handbook(docs / "effects")]
    return [path for path in written if path.suffix == ".png"]


if __name__ == "__main__":
    print(f"{len(draw_figures(Path(sys.argv[1])))} files")
