"""The cause found as a user's effect, ready to be given physics."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from hexdbb.discovery.learning import with_learned
from hexdbb.discovery.result import Discovery
from hexdbb.discovery.words import NOTHING
from hexdbb.effects import draft
from hexdbb.errors import InputError, RunError
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.learned.places import is_learned
from hexdbb.model import Model


@dataclass(frozen=True)
class Draft:
    """Source of a user's effect.

    Attributes
    ----------
    name : str
        The learned effect that it was made of, as `hexdbb add` takes it.
    sentence : str
        What it is: the main cause, or the best learned function beside it.
    source : str
        Python, as ``--effects FILE.py`` takes it.
    """

    name: str
    sentence: str
    source: str = field(repr=False)


def require_draftable(path: Path, overwrite: bool) -> None:
    """Check that a draft may be written to a file.

    Raises
    ------
    InputError
        It is no Python file, or exists already.
    """
    if path.suffix != ".py":
        raise InputError(f"{path}: cannot hold an effect (expected the name of a Python file, NAME.py)")
    refuse_existing(path, overwrite)


def draft_effect(found: Discovery) -> Draft:
    """Write the main cause of a discovery as a user's effect.

    Where the main cause is a known effect, or none that a function of one variable describes, the best learned function
    that was tried takes its place, which the sentence states.

    Parameters
    ----------
    found : Discovery

    Raises
    ------
    RunError
        Where nothing is missing, or no learned function was tried.
    """
    main = found.causes[0].choice if found.causes else ""
    for name in dict.fromkeys((main, *(each for one in found.candidates for each in one.names))):
        model = _model(found, name) if is_learned(name) else None
        if model is not None:
            return Draft(name, _sentence(name, main), draft(model, name))
    why = NOTHING if found.verdict == "none" and not found.sufficiency.matters else "no learned function was tried"
    raise RunError(f"no effect to draft: {why}")


def _model(found: Discovery, name: str) -> Model | None:
    """Return a fitted model that has the learned effect; None where it cannot be fitted."""
    if found.learned is not None and found.learned.term(name) is not None:
        return found.learned
    learned = with_learned(found.samples, found.base, [name], found.noise)
    return None if learned is None else learned[0]


def _sentence(name: str, main: str) -> str:
    if name == main:
        return f"{name}, the main cause"
    return f"{name}, the best learned function; " + (f"the main cause is {main}" if main else "no cause was named")
