"""What a chart shows, before it is drawn: colours, magnification, paths as lines, screening to a display's resolution.

Pictures (`hexdbb.plots`, matplotlib) and pages (report, workbench) share it; nothing here imports a drawing library.
"""

from hexdbb.charts.magnification import Scale, choose_scale
from hexdbb.charts.screening import screened

__all__ = ["Scale", "choose_scale", "screened"]
