"""Figures of the pages that are drawn by code: those of the handbook of effects, and the one of the first look."""

from __future__ import annotations

from pathlib import Path



def draw_figures(source: Path) -> None:
    """Draw figures into staged pages, in place of the committed ones."""
