"""Pictures of comparisons, diagnoses and discoveries: polar plots, residuals against angle, the forms of causes.

::

    pages = comparison_pages(comparison)  # what matters first is the first
    save_figure(pages[0].draw(), Path("demo-compare"))
    save_pdf((page.draw() for page in pages), Path("demo-compare.pdf"))
"""

from hexdbb.plots.analysis_pages import diagnosis_pages, discovery_pages
from hexdbb.plots.learned import learned_figure
from hexdbb.plots.pages import comparison_pages
from hexdbb.plots.residual_circles import residual_figure
from hexdbb.plots.saving import Page, save_figure, save_pages, save_pdf
from hexdbb.plots.trend import trend_effects_figure, trend_figure

__all__ = [
    "Page",
    "comparison_pages",
    "diagnosis_pages",
    "discovery_pages",
    "learned_figure",
    "residual_figure",
    "save_figure",
    "save_pages",
    "save_pdf",
    "trend_effects_figure",
    "trend_figure",
]
