"""Pictures of comparisons, diagnoses and discoveries: polar plots, residuals against angle, the forms of causes.

::

    for page in comparison_pages(comparison):
        save_figure(page.draw(), Path("demo-compare" + page.suffix))
"""

from hexdbb.plots.analysis_pages import diagnosis_pages, discovery_pages
from hexdbb.plots.learned import learned_figure
from hexdbb.plots.pages import Page, comparison_pages, save_figure, save_pages
from hexdbb.plots.residual_circles import residual_figure

__all__ = [
    "Page",
    "comparison_pages",
    "diagnosis_pages",
    "discovery_pages",
    "learned_figure",
    "residual_figure",
    "save_figure",
    "save_pages",
]
