"""The generated pages and their pictures; `test_thesis_pages.py` compares the committed pages with the generators."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from hexdbb.files.atomic_file import write_text
from hexdbb.plan import load_plan
from hexdbb.plots import save_figure
from hexdbb.studies.thesis.circular_test import joint_plane_test, plan_test
from hexdbb.studies.thesis.contours import reference_contours
from hexdbb.studies.thesis.contours_page import contours_page
from hexdbb.studies.thesis.linearity import linearity_study
from hexdbb.studies.thesis.pictures import contours_figure, linearity_figure
from hexdbb.studies.thesis.tables_page import tables_page

PAGES: dict[str, Callable[[], str]] = {
    "thesis-contours.md": contours_page,
    "thesis-tables.md": tables_page,
}

PICTURES: dict[str, Callable[[], Figure]] = {
    "thesis-contours-joint-plane": lambda: contours_figure(reference_contours(joint_plane_test())),
    "thesis-contours-plan": lambda: contours_figure(
        reference_contours(plan_test(load_plan("thesis"), 0, "plan thesis, circle 0"))
    ),
    "thesis-linearity": lambda: linearity_figure(linearity_study()),
}
"""Stem below `images/` to the figure."""


def write_pages(directory: Path) -> list[Path]:
    """Write pages and pictures (PNG, in `images/`) into an existing directory, and return their paths.

    Raises
    ------
    RunError
        A file cannot be written.
    """
    written = []
    for name, page in PAGES.items():
        write_text(directory / name, page())
        written.append(directory / name)
    images = directory / "images"
    images.mkdir(exist_ok=True)
    for stem, figure in PICTURES.items():
        written += save_figure(figure(), images / stem, (".png",))
    return written
