"""What follows from a diagnosis: compensation for the controller, better circles for the next test."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from hexdbb import _core
from hexdbb.compensation import MAX_CORRECTION_MM, make_compensation, write_compensation
from hexdbb.discovery import Discovery
from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.model import Model, new_model
from hexdbb.plan import Plan, load_plan
from hexdbb.planning import PlanRequest, planned_unknowns, propose


def compensate(
    model: Model,
    output: Path | str,
    *,
    max_correction_mm: float = MAX_CORRECTION_MM,
    reference_temperature_c: float | None = None,
) -> _core.CompensationData:
    """Write the compensation file of a model: what a motion controller needs to correct the machine's errors.

    Parameters
    ----------
    model : Model
    output : path
        ``NAME.hexcomp``.
    max_correction_mm : float
        Largest correction of one slider, mm.
    reference_temperature_c : float, optional
        Temperature at the first sample of the record that thermal growth was fitted to, °C; growth is left out
        without it.

    Returns
    -------
    CompensationData
        `effects` that are corrected, `left_out` with the reasons.
    """
    data = make_compensation(
        model, max_correction_mm=max_correction_mm, reference_temperature_c=reference_temperature_c
    )
    write_compensation(data, Path(output))
    return data


def propose_plan(
    circles: int = 7,
    *,
    like: Plan | Path | str = "standard",
    machine: MachineFile | None = None,
    criterion: str = "minmax",
    aim: str | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Plan:
    """Choose the circles that determine most of a machine's errors, as ``hexdbb plan propose`` does.

    Parameters
    ----------
    circles : int
        Number of circles.
    like : Plan, path or name of a shipped plan
        Gauge, ball, feeds, directions and laps are taken from it.
    machine : MachineFile, optional
        The plan's own where not given.
    criterion : str
        A key of `hexdbb.planning.CRITERIA`.
    aim : str, optional
        An effect that the plan is to determine; all errors of the machine where not given.
    progress : callable
        Called with what is being done.

    Raises
    ------
    InputError
        Nothing within reach, a criterion or effect that is not known, or a gauge without a stated noise.
    """
    template = like if isinstance(like, Plan) else load_plan(like)
    chosen = machine or template.machine_file()
    rate_hz = chosen.can_setup.cycle_rate_hz
    unknowns = planned_unknowns(new_model(chosen), aim, _noise_mm(template), rate_hz)
    request = PlanRequest(template, chosen, unknowns, circles, criterion, off_nominal=aim is not None)
    return propose(request, progress)


def plan_next_test(found: Discovery, *, like: Plan | Path | str = "standard") -> Plan:
    """Return the plan of the circle that tells apart what a discovery could not.

    Parameters
    ----------
    found : Discovery
        As `discover` returns it, its verdict `ambiguous`.
    like : Plan, path or name of a shipped plan
        Directions and laps are taken from it; gauge and cup are those of the record.

    Raises
    ------
    InputError
        The discovery has no such circle.
    """
    test = found.next_test
    if test is None:
        raise InputError(f"no circle tells apart what was found: the verdict is {found.verdict} (expected ambiguous)")
    template, record = like if isinstance(like, Plan) else load_plan(like), found.samples.records[0]
    changed = {
        "gauge": record.gauge,
        "mounts": (record.mount(test.circle.mount),),
        "circles": (test.circle,),
        "feeds_mm_min": (test.feed_mm_min,),
    }
    return template.model_copy(update=changed)


def _noise_mm(plan: Plan) -> float:
    stated = plan.gauge.stated_noise_mm
    if stated is None:
        raise InputError("gauge.noise_um: not stated (expected the standard deviation of one reading in the plan)")
    return stated
