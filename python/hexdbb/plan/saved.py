"""Plans written to files, as `hexdbb.plan.load_plan` reads them."""

from __future__ import annotations

from pathlib import Path

from hexdbb.files.atomic_file import write_text
from hexdbb.files.validation import dump_toml, parse_toml
from hexdbb.machine import SHIPPED_MACHINE, MachineFile, shipped_machine
from hexdbb.plan.file import Plan


def save_plan(plan: Plan, path: Path | str, comment: str = "", machine: MachineFile | None = None) -> None:
    """Write a plan, with a comment in its first line.

    Parameters
    ----------
    plan : Plan
    path : path
    comment : str
        One line.
    machine : MachineFile, optional
        The machine that is to drive it: the plan names the shipped one, or a file ``NAME-machine.toml`` that is written
        beside it. The plan's own where not given.

    Raises
    ------
    InputError
        The plan would not be read again.
    RunError
        A file cannot be written.
    """
    place = Path(path)
    if machine is not None:
        plan = plan.model_copy(update={"machine": _named(machine, place)})
    text = (f"# {comment}\n" if comment else "") + dump_toml(plan)
    parse_toml(text, Plan, str(place))
    write_text(place, text)


def _named(machine: MachineFile, plan: Path) -> str:
    if machine == shipped_machine():
        return SHIPPED_MACHINE
    beside = plan.with_name(f"{plan.stem}-machine.toml")
    write_text(beside, dump_toml(machine))
    return beside.name
