"""Argument and options of every study: the study file, and what replaces its keys."""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from hexdbb.machine import SHIPPED_MACHINE
from hexdbb.plan import shipped_plans
from hexdbb.studies.file import changed, load_study
from hexdbb.studies.setting import Setting, setting_of

OPTIONS = (
    click.argument("study", required=False, default="standard", metavar="[STUDY]"),
    click.option("-n", "--cases", type=int, metavar="N", help="Number of simulated cases."),
    click.option("--seed", type=int, help="Seed of all that is drawn."),
    click.option("--plan", "plan", metavar="PLAN", help="Plan file or shipped plan."),
    click.option("--machine", "machine", metavar="FILE", help="Machine file."),
    click.option("--noise", "noise_um", type=float, metavar="UM", help="Noise of one reading, µm."),
    click.option("--rate", "rate_hz", type=float, metavar="HZ", help="Readings per second."),
)


def setting_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add them; the command takes `setting`, which returns the setting with changes of the tables it is called with."""

    @functools.wraps(command)
    def with_setting(
        study: str,
        cases: int | None,
        seed: int | None,
        plan: str | None,
        machine: str | None,
        noise_um: float | None,
        rate_hz: float | None,
        **others: Any,
    ) -> Any:
        keys = {
            "cases": cases,
            "seed": seed,
            "plan": None if plan is None else _path(plan, shipped_plans()),
            "machine": None if machine is None else _path(machine, [SHIPPED_MACHINE]),
            "rate_hz": rate_hz,
        }
        changes: dict[str, Any] = {key: value for key, value in keys.items() if value is not None}
        if noise_um is not None:
            changes["gauge"] = {"noise_um": noise_um}

        def setting(**tables: Any) -> Setting:
            return setting_of(changed(load_study(study), {**changes, **tables}, "options"))

        return command(setting=setting, **others)

    for option in reversed(OPTIONS):
        with_setting = option(with_setting)
    return with_setting


def _path(given: str, shipped: list[str]) -> str:
    """Return a shipped name as it is, a path so that it does not depend on where the study file is."""
    return given if given in shipped else str(Path(given).absolute())
