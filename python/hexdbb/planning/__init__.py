"""Planning: which circles tell most about the machine, before any of them is driven."""

from hexdbb.planning.candidates import GRIDS, Grid
from hexdbb.planning.clearances import Clearances, Demands, circle_clearances
from hexdbb.planning.criteria import CRITERIA
from hexdbb.planning.detectable import Detectable, detectable_sizes
from hexdbb.planning.information import unknowns_of
from hexdbb.planning.picture import spectrum_figure
from hexdbb.planning.proposal import Question, propose

__all__ = [
    "CRITERIA",
    "GRIDS",
    "Clearances",
    "Demands",
    "Detectable",
    "Grid",
    "Question",
    "circle_clearances",
    "detectable_sizes",
    "propose",
    "spectrum_figure",
    "unknowns_of",
]
