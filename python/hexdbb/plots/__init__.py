"""Pictures of a comparison: polar plots with a stated magnification, residual against angle, ISO 230-4 table.

::

    for page in comparison_pages(comparison):
        save_figure(page.draw(), Path("demo-compare" + page.suffix))
"""

from hexdbb.plots.learned import learned_figure
from hexdbb.plots.magnification import Scale, choose_scale
from hexdbb.plots.pages import Page, comparison_pages, save_figure

__all__ = ["Page", "Scale", "choose_scale", "comparison_pages", "learned_figure", "save_figure"]
