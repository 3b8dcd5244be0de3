"""Planning: which circles determine most of the machine, before any of them is driven."""

from hexdbb.planning.candidates import GRIDS, Grid
from hexdbb.planning.clearances import Clearances, RequiredClearances, angle_of_row, circle_clearances
from hexdbb.planning.criteria import CRITERIA
from hexdbb.planning.detectable import Detectable, detectable_sizes
from hexdbb.planning.information import planned_unknowns
from hexdbb.planning.picture import spectrum_figure
from hexdbb.planning.proposal import PlanRequest, propose

__all__ = [
    "CRITERIA",
    "GRIDS",
    "Clearances",
    "Detectable",
    "Grid",
    "PlanRequest",
    "RequiredClearances",
    "angle_of_row",
    "circle_clearances",
    "detectable_sizes",
    "planned_unknowns",
    "propose",
    "spectrum_figure",
]
