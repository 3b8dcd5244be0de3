"""Files that a session writes beside the model: report, plan of the next circle, compensation, effects of one's own.

Each calls the function that the command of the same name calls, and appends the lines that do the same to the script.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from hexdbb import api
from hexdbb.effects import load_effects
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, write_text
from hexdbb.plan import save_plan
from hexdbb.workbench.own_code import COMPUTING_S, require_ending
from hexdbb.workbench.script import Name, call
from hexdbb.workbench.session import Session


def write_report(session: Session, path: Path) -> str:
    """Write the report of the records with the model; return its verdict: ``hexdbb report``."""
    with session.doing(f"writing {path}") as table:
        found = api.report(table, session.model, path)
        session.script.add(call("hx.report", Name("samples"), Name("model"), str(path)))
    return found.verdict


def write_compensation(session: Session, path: Path) -> Sequence[tuple[str, str]]:
    """Write the compensation file; return what of the model it leaves out, with the reasons."""
    with session.doing(f"writing {path}"):
        data = api.compensate(session.model, path)
        session.script.add(call("hx.compensate", Name("model"), str(path)))
        return list(data.left_out)


def write_next_plan(session: Session, path: Path, progress: Callable[[str], None] = lambda _: None) -> str:
    """Write the plan of the next circle; return what it is for.

    The circle that tells apart what was found, where the verdict is ambiguous; else the one that alone determines most
    of the machine's errors, ``hexdbb plan propose --circles 1``.
    """
    with session.doing("planning the next circle"):
        refuse_existing(path, overwrite=False)
        machine = session.samples.machine
        if session.found is not None and session.found.next_test is not None:
            between = " from ".join(session.found.next_test.between)
            plan, what = api.plan_next_test(session.found), f"tells {between}"
            session.script.add("plan = hx.plan_next_test(found)")
        else:
            plan = api.propose_plan(1, machine=machine, progress=progress)
            what = "determines most of the machine's errors alone"
            session.script.add("plan = hx.propose_plan(1, machine=records[0].machine)")
        save_plan(plan, path, f"The circle that {what}.", machine)
        session.script.add(f"hx.save_plan(plan, {str(path)!r}, machine=records[0].machine)")
    return what


def write_effects(session: Session, path: Path, source: str, computing_s: int = COMPUTING_S) -> list[str]:
    """Write a Python file of effects, try it in a process of its own, and let its effects compete.

    Returns
    -------
    list of str
        Names of the effects.

    Raises
    ------
    InputError
        The file is another one that exists already, does not run, or does not end (`require_ending`).
    """
    with session.doing(f"trying {path}"):
        if path.suffix != ".py" or (path.exists() and path != session.effects_path):
            raise InputError(f"{path}: not written (expected a new name that ends in .py)")
        write_text(path, source)
        session.effects_path = path
        paths = [record.path for record in session.records if record.path is not None]
        require_ending(path, paths, computing_s, mapping=session.mapping)
        effects = load_effects(path)
        session.know_effects(effects)
    return [each.name for each in effects]
