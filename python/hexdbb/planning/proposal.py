"""Proposing a plan: candidates, choice, refinement off the grid, and the plan that can be driven.

The grid's choice is refined by coordinate exchange (Meyer, Nachtsheim, Technometrics 37(1), 1995): every circle in
turn tries its neighbours, with steps that halve. The plan is then made with its whole motion, ways between circles
included; circles that cannot follow one another in one order are tried in others. No random number is drawn: the same
question has the same answer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from hexdbb.errors import InputError, RunError
from hexdbb.machine import MachineFile
from hexdbb.plan import Circle, Mount, Plan
from hexdbb.planning.candidates import Candidate, Grid, grid_candidates, neighbours, other_radii, within_reach
from hexdbb.planning.clearances import Demands
from hexdbb.planning.criteria import Criterion, criterion
from hexdbb.planning.exchange import Choice, Progress, Search, is_better
from hexdbb.planning.information import Information, Unknowns, information_of
from hexdbb.trajectory import plan_programme

STEPS_DEG = (6.0, 3.0, 1.0)
"""Of the refinement, off a grid of 6 degrees and more."""
MOST_PASSES = 10
MOST_REFINED = 6
"""So many of the grid's best choices are refined for each number of cups: the best on the grid need not be the best off
it."""
START = "D"
"""Criterion of the greedy start: it tells few circles apart where the smallest singular value is still zero."""


@dataclass(frozen=True)
class Question:
    """What a plan is wanted for.

    `like` lends machine, gauge, ball, feeds, directions and laps; its first mount is the centre of the cup places
    tried.
    """

    like: Plan
    machine: MachineFile
    unknowns: Unknowns
    circles: int
    criterion: str = "D"
    most_mounts: int = 1
    off_nominal: bool = False
    """Let radii differ from the bar's length; the bar then comes off between circles of different radii."""
    demands: Demands = field(default_factory=Demands)
    grid: Grid = field(default_factory=Grid)


def propose(question: Question, progress: Progress) -> Plan:
    """Choose circles and make a plan of them.

    Parameters
    ----------
    question : Question
    progress : callable
        Told, in words, what is being done.

    Returns
    -------
    Plan
        Checked by computing its whole motion.

    Raises
    ------
    InputError
        Fewer than one circle or cup place, a criterion that is not known, nothing within reach.
    RunError
        Where the circles chosen cannot be driven one after another.
    """
    if question.circles < 1:
        raise InputError(f"circles {question.circles}: nothing to choose (expected 1 or more)")
    if question.most_mounts < 1:
        raise InputError(f"mounts {question.most_mounts}: a cup has to stand somewhere (expected 1 or more)")
    criterion(question.criterion, np.ones(1, bool), np.eye(1))  # a name that is not known is told before the work
    progress("circles within reach")
    reach = grid_candidates(question.like, question.machine, question.demands, question.grid)
    pools = [pool for pool in reach if pool]
    if not pools:
        raise InputError(f"{_name(question.like)}: no circle of the grid is within reach with the clearances demanded")
    progress(f"what {sum(map(len, pools))} circles would tell")
    information = [information_of(pool, question.like, question.unknowns) for pool in pools]
    whole = sum((each.total(range(len(each))).told()[0] for each in information), np.zeros(()))
    judge, start = (criterion(name, question.unknowns.wanted, whole) for name in (question.criterion, START))
    search = Search(information, judge)
    rounds = search.rounds(question.circles, min(question.most_mounts, question.circles), start, progress)
    # Fewest cups first, so that more cups must earn their place.
    hopeful = list(dict.fromkeys(chosen for ranked in rounds for chosen in ranked[:MOST_REFINED]))
    refined = []
    for number, chosen in enumerate(hopeful):
        progress(f"refining choice {number + 1} of {len(hopeful)}")
        refined.append(_refined([pools[mount][place] for mount, place in chosen.circles], judge, question))
    return _driven(_best(refined, judge, question), question, progress)


def _best(choices: Sequence[list[Candidate]], judge: Criterion, question: Question) -> list[Candidate]:
    """Give the first of the best choices."""
    best, score = choices[0], -np.inf
    for each in choices:
        search, others = _search_about(each[:1], each[1:], judge, question)
        reached = search.score([*others, (0, 0)])
        if is_better(reached, score):
            best, score = each, reached
    return best


def _refined(chosen: Sequence[Candidate], judge: Criterion, question: Question) -> list[Candidate]:
    """Let every circle try its neighbours until none is better, with smaller and smaller steps."""
    best = list(chosen)
    for step_deg in STEPS_DEG:
        for _ in range(MOST_PASSES):
            moved = [_moved(best, place, step_deg, judge, question) for place in range(len(best))]
            if not any(moved):
                break
    return best


def _moved(best: list[Candidate], place: int, step_deg: float, judge: Criterion, question: Question) -> bool:
    """Put the best neighbour in the place of one circle; say whether there was a better one."""
    own = best[place]
    near = [*neighbours(own, step_deg), *(other_radii(own, question.like) if question.off_nominal else ())]
    new = (each for each in near if each not in best)
    options = [own, *within_reach(new, question.like, question.machine, question.demands)]
    search, choices = _search_about(options, [*best[:place], *best[place + 1 :]], judge, question)
    scores = [search.score([*choices, (0, option)]) for option in range(len(options))]
    if not is_better(max(scores), scores[0]):
        return False
    best[place] = options[int(np.argmax(scores))]
    return True


def _search_about(
    options: Sequence[Candidate], others: Sequence[Candidate], judge: Criterion, question: Question
) -> tuple[Search, list[Choice]]:
    """Make a search over the options for one circle, and the choices that the other circles are."""
    cups = list(dict.fromkeys([options[0].cup_mm, *(each.cup_mm for each in others)]))
    groups = [[each for each in others if each.cup_mm == cup] for cup in cups]
    groups[0] = [*options, *groups[0]]
    information: list[Information] = [
        information_of(group, question.like, question.unknowns) for group in groups if group
    ]
    choices = [
        (mount, place)
        for mount, group in enumerate(groups)
        for place in range(len(options) if mount == 0 else 0, len(group))
    ]
    return Search(information, judge), choices


def _driven(chosen: Sequence[Candidate], question: Question, progress: Progress) -> Plan:
    """Make a plan whose whole motion is within reach and limits, of the first order of circles that has one."""
    reason = ""
    for number, order in enumerate(_orders(chosen)):
        progress(f"motion of the whole plan, order {number + 1}")
        plan = _plan_of(order, question.like)
        try:
            plan_programme(plan, question.machine, 1.0 / question.unknowns.cycle_rate_hz, "the plan proposed")
        except InputError as error:
            reason = str(error)
            continue
        return plan
    raise RunError(f"the circles chosen cannot be driven one after another: {reason}")


def _orders(chosen: Sequence[Candidate]) -> Iterator[list[Candidate]]:
    """Yield orders of the circles: from each as the first, cup place by cup place, the nearest orientation next."""
    for first in range(len(chosen)):
        left = [*chosen[first:], *chosen[:first]]
        order = [left.pop(0)]
        while left:
            here = order[-1]
            nearest = min(left, key=lambda each: (each.cup_mm != here.cup_mm, _turn_deg(each, here)))
            left.remove(nearest)
            order.append(nearest)
        yield order


def _turn_deg(one: Candidate, other: Candidate) -> float:
    return float(np.linalg.norm(np.subtract(one.platform_rpy_deg, other.platform_rpy_deg)))


def _plan_of(order: Sequence[Candidate], like: Plan) -> Plan:
    cups = list(dict.fromkeys(each.cup_mm for each in order))
    mounts = tuple(Mount(id=identity, cup_mm=cup) for identity, cup in enumerate(cups))
    circles: tuple[Circle, ...] = tuple(
        each.circle(like, identity, cups.index(each.cup_mm)) for identity, each in enumerate(order)
    )
    return like.model_copy(update={"mounts": mounts, "circles": circles})


def _name(plan: Plan) -> str:
    return str(plan.path) if plan.path is not None else "plan"
