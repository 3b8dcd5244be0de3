"""Measure a plan's circles on a machine or on the simulated rig."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

from hexdbb.capture import Request, RunProgress, SimulatedRig, opened_bus, prepare, running_clock
from hexdbb.capture import measure as measure_request
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.plan import Conditions, Plan, load_plan
from hexdbb.record import Record, conditions_metadata


def simulated_rig(
    truth: Path | str | None = None, *, seed: int | None = None, faults: tuple[str, ...] = ()
) -> SimulatedRig:
    """Describe a simulated rig to measure on: a machine whose errors the program does not know.

    Parameters
    ----------
    truth : path, optional
        Truth file: errors and mechanisms of the hidden machine (docs/simulated-rig.md); random errors where not given.
    seed : int, optional
        Seed of the random machine, or of the noise of a truth file.
    faults : tuple of str
        Faults to inject, as ``hexdbb rig --fault`` takes them.
    """
    return SimulatedRig(None if truth is None else Path(truth), seed, faults)


def measure(
    plan: Plan | Path | str,
    output: Path | str,
    bus: SimulatedRig | str | None = None,
    *,
    rate_hz: float | None = None,
    lockstep: bool | None = None,
    overwrite: bool = False,
    conditions: Conditions | None = None,
) -> Record:
    """Drive the circles of a plan and record them, as ``hexdbb-run`` does.

    Parameters
    ----------
    plan : Plan, path or name of a shipped plan (``thesis``, ``standard``)
    output : path
        Record to write, ``NAME.parquet``.
    bus : str or SimulatedRig, optional
        CAN bus as ``interface:channel``, for instance ``socketcan:can0``; a simulated rig where not given.
    rate_hz : float, optional
        Cycles per second; the machine file's where not given.
    lockstep : bool, optional
        As fast as the bus allows (default when simulated), or at the cycle rate.
    overwrite : bool
        Replace an existing record.
    conditions : Conditions, optional
        Operator, notes, temperature: kept in the record, in place of those of the plan.

    Returns
    -------
    Record
        As written to `output`.

    Raises
    ------
    InputError
        The plan cannot be run, or the record exists; nothing has moved.
    RunError
        A fault stopped the run: all six axes stand, and what was captured is kept.
    """
    place, source = Path(output), SimulatedRig() if bus is None else bus
    refuse_existing(place, overwrite)
    chosen = plan if isinstance(plan, Plan) else load_plan(plan)
    machine = chosen.machine_file()
    simulated = isinstance(source, SimulatedRig)
    in_lockstep = simulated if lockstep is None else lockstep
    cycle_s = 1.0 / (rate_hz or machine.can_setup.cycle_rate_hz)
    origin = str(chosen.path) if chosen.path is not None else str(plan)
    metadata: dict[str, object] = {
        "plan": origin,
        "cycle_rate_hz": 1.0 / cycle_s,
        "bus": "simulated rig" if simulated else source,
        "pace": "lockstep" if in_lockstep else "real time",
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        **conditions_metadata(chosen.conditions, conditions),
    }
    request, progress = Request(chosen, machine, origin, cycle_s, place, overwrite, metadata=metadata), RunProgress()
    programme = prepare(request)
    with opened_bus(source, machine) as opened, running_clock(in_lockstep, cycle_s, progress) as clock:
        return measure_request(request, programme, opened, clock, progress)
