"""Charts of a report as SVG text: circles, residuals, the falling error, predictors."""

from hexdbb.reporting.drawings.circle import polar_svg, scale_of
from hexdbb.reporting.drawings.fall import fall_svg
from hexdbb.reporting.drawings.predictor import predictor_svg
from hexdbb.reporting.drawings.unrolled import unrolled_svg

__all__ = ["fall_svg", "polar_svg", "predictor_svg", "scale_of", "unrolled_svg"]
