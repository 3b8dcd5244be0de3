"""`hexdbb plan check`: reach, limits and clearances of a plan, and what it would determine."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import numpy as np

from hexdbb.capture.bus_load import check_load
from hexdbb.cli.consoles import message_console, say
from hexdbb.cli.plan_assessment import PlanAssessment, assess_plan, noise_option
from hexdbb.cli.plan_tables import (
    LIMITED,
    print_assessment,
    print_clearances,
    print_motion,
    print_nearest,
    warn_of_condition,
)
from hexdbb.errors import InputError
from hexdbb.kinematics.margins import nearest_end, nearest_sliders
from hexdbb.machine import MachineFile
from hexdbb.model import load_model, new_model
from hexdbb.plan import Plan, ball_places_sentences, load_plan
from hexdbb.planning import Clearances, angle_of_row, circle_clearances
from hexdbb.trajectory import Programme, plan_programme


@click.command("check", short_help="reach, limits, clearances, what a plan determines")
@click.argument("plan_name", metavar="PLAN")
@click.option(
    "--rate", "rate_hz", type=click.FloatRange(min=1.0), help="Cycles per second; default: the machine file's."
)
@click.option(
    "-m",
    "--model",
    "model_path",
    type=click.Path(path_type=Path),
    help="Model whose free values are to be determined; default: the thesis' 33 errors, cup and ball offset.",
)
@noise_option
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def check(
    plan_name: str, rate_hz: float | None, model_path: Path | None, noise_um: float | None, as_json: bool
) -> None:
    """Check reach, limits and clearances of a plan, and compute what it would determine of the machine.

    PLAN is a plan file or the name of a shipped plan. A plan out of reach ends with exit status 2; the message names
    circle, angle and limit. Uncertainties and detectable sizes are first order, at the stated noise of the gauge.

    \b
    Examples:
      hexdbb plan check standard
      hexdbb plan check my-plan.toml --rate 400 --noise 1.0
      hexdbb plan check my-plan.toml -m model.toml --json
    """
    plan = load_plan(plan_name)
    machine = plan.machine_file()
    rate_hz = rate_hz or machine.can_setup.cycle_rate_hz
    model = new_model(machine) if model_path is None else load_model(model_path)
    if model.machine != machine:
        raise InputError(f"{model_path}: machine: {model.machine.name} (expected the plan's, {machine.name})")
    try:
        load = check_load(rate_hz, machine.can_setup.bitrate_bit_s, len(machine.can_setup.drive_nodes))
        with message_console().status(f"{plan_name}: path, reach and limits"):
            programme = plan_programme(plan, machine, 1.0 / rate_hz, plan_name)
    except InputError as error:
        if as_json:
            say(json.dumps({"reachable": False, "reason": str(error)}, indent=2))
        raise
    with message_console().status(f"{plan_name}: margins and clearances"):
        runs = [
            {**_run_json(programme, index), **_margins(programme, index, machine)}
            for index in range(len(programme.runs))
        ]
        clearances = _clearances(plan, machine, plan_name)
    assessment = assess_plan(plan, model, rate_hz, noise_um, plan_name)
    for line in ball_places_sentences(plan_name, plan.mounts, plan.circles):
        say(line, err=True)
    if as_json:
        extent = {"rows": len(programme), "disk_bytes": int(programme.extent.disk_bytes)}
        motion = {"reachable": True, "duration_s": programme.duration_s, **extent, "bus_load": load, "runs": runs}
        motion["nearest"] = _nearest(programme, machine)
        circles = [_clearance_json(identity, each) for identity, each in clearances.items()]
        say(json.dumps({**motion, "circles": circles, **assessment.to_json()}, indent=2))
        return
    _print(plan_name, programme, load, runs, clearances, assessment, machine)


def _print(
    plan_name: str,
    programme: Programme,
    load: float,
    runs: list[dict[str, float]],
    clearances: dict[int, Clearances],
    assessment: PlanAssessment,
    machine: MachineFile,
) -> None:
    print_motion(f"plan {plan_name}: within reach and limits", runs, machine.can_setup.limits)
    say(f"{programme.extent.words()} at {1.0 / programme.cycle_s:g} Hz, bus load at most {load:.0%}\n")
    print_nearest(_nearest(programme, machine))
    print_clearances(clearances)
    print_assessment(assessment)
    warn_of_condition(plan_name, assessment)


def _clearances(plan: Plan, machine: MachineFile, plan_name: str) -> dict[int, Clearances]:
    found = {each.id: circle_clearances(machine, each, plan.mount_of(each).cup_mm) for each in plan.circles}
    for identity, each in found.items():
        if each is None:
            expected = "room for the feed-in at every angle"
            raise InputError(
                f"{plan_name}: circle {identity}: out of reach at the start of the feed-in (expected {expected})"
            )
    return {identity: each for identity, each in found.items() if each is not None}


def _nearest(programme: Programme, machine: MachineFile) -> dict[str, dict[str, Any]]:
    """Return which sliders come nearest to each other and to an end of travel in the whole motion, and where."""
    pairs, ends, first = [], [], 0
    for block in programme.rows.blocks():
        pair, end = nearest_sliders(block.sliders_mm), nearest_end(machine, block.sliders_mm)
        pairs.append(replace(pair, row=first + pair.row))
        ends.append(replace(end, row=first + end.row))
        first += len(block)
    pair, end = min(pairs, key=lambda each: each.distance_mm), min(ends, key=lambda each: each.left_mm)
    return {
        "sliders": {
            "sliders": [pair.first, pair.second],
            "distance_mm": pair.distance_mm,
            "min_gap_mm": machine.sliders.min_gap_mm,
            **_place(programme, pair.row),
        },
        "end_of_travel": {
            "slider": end.slider,
            "end_mm": end.end_mm,
            "left_mm": end.left_mm,
            **_place(programme, end.row),
        },
    }


def _place(programme: Programme, row: int) -> dict[str, Any]:
    """Return where in the motion a row of the programme is; null off the circles."""
    there = programme.rows.part(row, row + 1)
    run, angle_deg = int(there.run[0]), float(there.angle_deg[0])
    return {
        "circle": programme.runs[run].circle.id if run >= 0 else None,
        "direction": programme.runs[run].direction if run >= 0 else None,
        "angle_deg": None if np.isnan(angle_deg) else angle_deg,
    }


def _clearance_json(identity: int, found: Clearances) -> dict[str, Any]:
    assert found.nearest is not None and found.nearest_end is not None  # of every circle within reach
    return {
        "circle": identity,
        "to_end_of_travel_mm": found.to_end_of_travel_mm,
        "slider": found.nearest_end.slider,
        "to_min_gap_mm": found.to_min_gap_mm,
        "sliders": [found.nearest.first, found.nearest.second],
        "slider_distance_mm": found.nearest.distance_mm,
        "angle_deg": angle_of_row(found.nearest.row),
        "to_joint_limit_deg": found.to_joint_limit_deg if np.isfinite(found.to_joint_limit_deg) else None,
        "bar_angle_deg": found.bar_angle_deg,
        "pose_condition": found.condition,
    }


def _run_json(programme: Programme, index: int) -> dict[str, float]:
    run = programme.runs[index]
    return {
        "circle": run.circle.id,
        "feed_mm_min": run.feed_mm_min,
        "direction": run.direction,
        "samples": int(programme.captured[index]),
    }


def _margins(programme: Programme, index: int, machine: MachineFile) -> dict[str, float]:
    """Return the largest slider rates of a run, and its margins to the ends of travel and to the smallest gap."""
    margins, rates = {"to_end_of_travel_mm": math.inf, "to_min_gap_mm": math.inf}, [0.0] * len(LIMITED)
    known_mm = np.empty((0, 6))
    last = int(programme.begins[index + 1]) if index + 1 < len(programme.begins) else len(programme)
    for block in programme.rows.blocks(int(programme.begins[index]), last):
        sliders_mm = block.sliders_mm
        gap_mm = nearest_sliders(sliders_mm).distance_mm - machine.sliders.min_gap_mm
        margins["to_end_of_travel_mm"] = min(margins["to_end_of_travel_mm"], nearest_end(machine, sliders_mm).left_mm)
        margins["to_min_gap_mm"] = min(margins["to_min_gap_mm"], gap_mm)
        rate = np.vstack([known_mm, sliders_mm])
        known_mm = rate[-len(LIMITED) :]
        for order in range(len(LIMITED)):
            rate = np.diff(rate, axis=0) / programme.cycle_s
            rates[order] = max(rates[order], float(np.abs(rate).max(initial=0.0)))
    return margins | {f"{name}_{unit}": rate for (name, unit), rate in zip(LIMITED, rates, strict=True)}
