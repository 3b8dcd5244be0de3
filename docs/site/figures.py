"""Figures that the build draws anew: those of the handbook of effects."""

from __future__ import annotations

from pathlib import Path


def draw_figures(source: Path) -> None:
    """Draw figures into staged pages, in place of the committed ones."""
