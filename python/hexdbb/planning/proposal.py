"""Proposing a plan: candidates, choice, refinement off the grid, and a plan that can be driven.

The choice on the grid is refined (`hexdbb.planning.refinement`). The motion of the whole plan, paths between circles
included, is then computed; circles that cannot follow one another in one order are tried in others. No random number is
drawn: the same request gives the same plan.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from hexdbb.errors import InputError, RunError
from hexdbb.machine import MachineFile
from hexdbb.plan import Circle, Mount, Plan
from hexdbb.planning.candidates import CandidateCircle, Grid, grid_candidates
from hexdbb.planning.clearances import RequiredClearances
from hexdbb.planning.criteria import make_criterion
from hexdbb.planning.exchange import CircleExchange, ReportStep
from hexdbb.planning.information import PlannedUnknowns
from hexdbb.planning.known_circles import KnownCircles
from hexdbb.planning.refinement import Refinement
from hexdbb.trajectory import plan_programme, require_extent

MAX_REFINED = 6
"""Choices refined for each number of cup positions: limits the time, which is proportional to it; more than one,
because the best on the grid need not be the best off it."""
START = "D"
"""Criterion of the greedy start: it distinguishes choices of few circles, whose smallest singular value is still
zero."""


@dataclass(frozen=True)
class PlanRequest:
    """The purpose of a plan and the limits of the search for it."""

    template: Plan
    """Its gauge, ball, feeds, directions and laps are kept; its first mount is the centre of the cup positions."""
    machine: MachineFile
    unknowns: PlannedUnknowns
    circles: int
    """Number of circles."""
    criterion: str = "D"
    """A key of `hexdbb.planning.CRITERIA`."""
    most_mounts: int = 1
    """Largest number of cup positions."""
    off_nominal: bool = False
    """Whether radii may differ from the bar's length; the bar is then removed between circles of different radii."""
    required: RequiredClearances = field(default_factory=RequiredClearances)
    grid: Grid = field(default_factory=Grid)


def propose(request: PlanRequest, report_step: ReportStep = lambda _: None) -> Plan:
    """Choose circles and return a plan of them.

    Parameters
    ----------
    request : PlanRequest
    report_step : callable
        Called with a description of each step of the work.

    Returns
    -------
    Plan
        Checked by computing its whole motion.

    Raises
    ------
    InputError
        Fewer than one circle or cup position, an unknown criterion, more rows than a plan may take, or no candidate
        within reach.
    RunError
        The chosen circles cannot be driven one after another.
    """
    if request.circles < 1:
        raise InputError(f"circles {request.circles}: no circle to choose (expected 1 or more)")
    if request.most_mounts < 1:
        raise InputError(f"mounts {request.most_mounts}: no position for the cup (expected 1 or more)")
    make_criterion(request.criterion, np.ones(1, bool), np.eye(1))  # an unknown name is refused before the work
    _require_extent(request)
    report_step("circles within reach")
    reach = grid_candidates(request.template, request.machine, request.required, request.grid)
    pools = [pool for pool in reach if pool]
    if not pools:
        raise InputError(
            f"{_name(request.template)}: no circle of the grid is within reach with the required clearances"
        )
    report_step(f"information of {sum(map(len, pools))} circles")
    known = KnownCircles(request.template, request.machine, request.required, request.unknowns)
    information = [known.information(pool) for pool in pools]
    whole = sum((each.total(range(len(each))).marginal()[0] for each in information), np.zeros(()))
    criterion, start = (
        make_criterion(name, request.unknowns.of_interest, whole) for name in (request.criterion, START)
    )
    rounds = CircleExchange(information, criterion).rounds(
        request.circles, min(request.most_mounts, request.circles), start, report_step
    )
    # Fewest cups first: a plan with more cups must be better to replace one with fewer.
    promising = list(dict.fromkeys(chosen for ranked in rounds for chosen in ranked[:MAX_REFINED]))
    refinement = Refinement(known, criterion, off_nominal=request.off_nominal)
    refined = []
    for number, chosen in enumerate(promising):
        report_step(f"refining choice {number + 1} of {len(promising)}")
        refined.append(refinement.refined([pools[mount][place] for mount, place in chosen.circles]))
    return _driven(refinement.best(refined), request, report_step)


def _driven(chosen: Sequence[CandidateCircle], request: PlanRequest, report_step: ReportStep) -> Plan:
    """Return the plan of the first order of circles whose whole motion is within reach and limits."""
    reason = ""
    for number, order in enumerate(_orders(chosen)):
        report_step(f"motion of the whole plan, order {number + 1}")
        plan = _plan_of(order, request.template)
        try:
            plan_programme(plan, request.machine, 1.0 / request.unknowns.cycle_rate_hz, "the proposed plan")
        except InputError as error:
            reason = str(error)
            continue
        return plan
    raise RunError(f"the chosen circles cannot be driven one after another: {reason}")


def _orders(chosen: Sequence[CandidateCircle]) -> Iterator[list[CandidateCircle]]:
    """Yield orders of the circles: from each as the first, cup by cup, the nearest orientation next."""
    for first in range(len(chosen)):
        left = [*chosen[first:], *chosen[:first]]
        order = [left.pop(0)]
        while left:
            here = order[-1]
            nearest = min(left, key=lambda each: (each.cup_mm != here.cup_mm, _turn_deg(each, here)))
            left.remove(nearest)
            order.append(nearest)
        yield order


def _turn_deg(one: CandidateCircle, other: CandidateCircle) -> float:
    return float(np.linalg.norm(np.subtract(one.platform_rpy_deg, other.platform_rpy_deg)))


def _plan_of(order: Sequence[CandidateCircle], template: Plan) -> Plan:
    cups = list(dict.fromkeys(each.cup_mm for each in order))
    mounts = tuple(Mount(id=identity, cup_mm=cup) for identity, cup in enumerate(cups))
    circles: tuple[Circle, ...] = tuple(
        each.circle(template, identity, cups.index(each.cup_mm)) for identity, each in enumerate(order)
    )
    return template.model_copy(update={"mounts": mounts, "circles": circles})


def _require_extent(request: PlanRequest) -> None:
    """Check before the search that so many circles with the template's feeds, directions and laps can be computed."""
    template = request.template
    alike = template.circles[0].model_copy(update={"feeds_mm_min": None, "directions": None, "laps": None})
    runs = template.model_copy(update={"circles": (alike,)}).runs() * request.circles
    cycle_s = 1.0 / request.unknowns.cycle_rate_hz
    require_extent(runs, template.overshoot_deg, request.machine.can_setup.limits, cycle_s, "the proposed plan")


def _name(plan: Plan) -> str:
    return str(plan.path) if plan.path is not None else "plan"
