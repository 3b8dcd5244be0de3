"""Proposing a plan: candidates, choice, refinement off the grid, and a plan that can be driven.

The choice on the grid is refined by coordinate exchange (Meyer, Nachtsheim, Technometrics 37(1), 1995): every circle in
turn is replaced by its best neighbour, with decreasing steps. The motion of the whole plan, paths between circles
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
from hexdbb.planning.candidates import CandidateCircle, Grid, grid_candidates, neighbours, other_radii, within_reach
from hexdbb.planning.clearances import RequiredClearances
from hexdbb.planning.criteria import Criterion, make_criterion
from hexdbb.planning.exchange import CircleExchange, CircleIndex, ReportStep, is_better
from hexdbb.planning.information import Information, PlannedUnknowns, information_of
from hexdbb.trajectory import plan_programme, require_extent

STEPS_DEG = (6.0, 3.0, 1.0)
"""Steps of the refinement: the finest spacing of the grid's tilts, half of it, and 1 deg,
which moves the end of a bar of 100 mm by less than 2 mm."""
MAX_PASSES = 10
"""Limit of passes over all circles with one step, against endless refinement; it ends earlier, when no neighbour is
better."""
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
    information = [information_of(pool, request.template, request.unknowns) for pool in pools]
    whole = sum((each.total(range(len(each))).marginal()[0] for each in information), np.zeros(()))
    criterion, start = (
        make_criterion(name, request.unknowns.of_interest, whole) for name in (request.criterion, START)
    )
    rounds = CircleExchange(information, criterion).rounds(
        request.circles, min(request.most_mounts, request.circles), start, report_step
    )
    # Fewest cups first: a plan with more cups must be better to replace one with fewer.
    promising = list(dict.fromkeys(chosen for ranked in rounds for chosen in ranked[:MAX_REFINED]))
    refined = []
    for number, chosen in enumerate(promising):
        report_step(f"refining choice {number + 1} of {len(promising)}")
        refined.append(_refined([pools[mount][place] for mount, place in chosen.circles], criterion, request))
    return _driven(_best(refined, criterion, request), request, report_step)


def _best(
    choices: Sequence[list[CandidateCircle]], criterion: Criterion, request: PlanRequest
) -> list[CandidateCircle]:
    """Return the best choice, the first among equals."""
    best, score = choices[0], -np.inf
    for each in choices:
        exchange, others = _exchange_about(each[:1], each[1:], criterion, request)
        reached = exchange.score([*others, (0, 0)])
        if is_better(reached, score):
            best, score = each, reached
    return best


def _refined(chosen: Sequence[CandidateCircle], criterion: Criterion, request: PlanRequest) -> list[CandidateCircle]:
    """Return a choice with every circle replaced by its best neighbour until none is better, with decreasing steps."""
    best = list(chosen)
    for step_deg in STEPS_DEG:
        for _ in range(MAX_PASSES):
            moved = [_moved(best, place, step_deg, criterion, request) for place in range(len(best))]
            if not any(moved):
                break
    return best


def _moved(
    best: list[CandidateCircle], place: int, step_deg: float, criterion: Criterion, request: PlanRequest
) -> bool:
    """Replace one circle by its best neighbour; return whether there was a better one."""
    own = best[place]
    near = [*neighbours(own, step_deg), *(other_radii(own, request.template) if request.off_nominal else ())]
    new = (each for each in near if each not in best)
    options = [own, *within_reach(new, request.template, request.machine, request.required)]
    exchange, others = _exchange_about(options, [*best[:place], *best[place + 1 :]], criterion, request)
    scores = [exchange.score([*others, (0, option)]) for option in range(len(options))]
    if not is_better(max(scores), scores[0]):
        return False
    best[place] = options[int(np.argmax(scores))]
    return True


def _exchange_about(
    options: Sequence[CandidateCircle], others: Sequence[CandidateCircle], criterion: Criterion, request: PlanRequest
) -> tuple[CircleExchange, list[CircleIndex]]:
    """Return the exchange over the options for one circle, and the indices of the other circles in it."""
    cups = list(dict.fromkeys([options[0].cup_mm, *(each.cup_mm for each in others)]))
    groups = [[each for each in others if each.cup_mm == cup] for cup in cups]
    groups[0] = [*options, *groups[0]]
    information: list[Information] = [
        information_of(group, request.template, request.unknowns) for group in groups if group
    ]
    fixed = [
        (mount, place)
        for mount, group in enumerate(groups)
        for place in range(len(options) if mount == 0 else 0, len(group))
    ]
    return CircleExchange(information, criterion), fixed


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
