"""Loading the file that holds a user's effects: named on the command line by the user, never by data."""

from __future__ import annotations

import importlib.util
from pathlib import Path

from hexdbb.effects.traces import line_of
from hexdbb.effects.user import LOADING, UserEffect
from hexdbb.errors import InputError


def load_effects(path: Path | str) -> list[UserEffect]:
    """Run a Python file and return the effects it declares, in the order of its lines.

    Raises
    ------
    InputError
        No such file, a file that does not run (with the line that failed), no effect in it, or two of one name.
    """
    place = Path(path)
    if not place.is_file():
        raise InputError(f"{place}: no such file (expected a Python file that declares effects)")
    spec = importlib.util.spec_from_file_location(f"hexdbb_user_effects_{place.stem}", place)
    if spec is None or spec.loader is None:
        raise InputError(f"{place}: not a Python file (expected NAME.py)")
    module = importlib.util.module_from_spec(spec)
    declared: list[UserEffect] = []
    token = LOADING.set(declared)
    try:
        spec.loader.exec_module(module)
    except InputError:
        raise
    except Exception as error:  # a user's file may raise anything
        words = error.msg if isinstance(error, SyntaxError) else error
        raise InputError(f"{place}:{_line_in(place, error)}: {type(error).__name__}: {words}") from None
    finally:
        LOADING.reset(token)
    # What a loop declares has no name in the file; what another file declares may have one.
    own = [each for each in declared if each.path == str(place.absolute())]
    named = [each for each in vars(module).values() if isinstance(each, UserEffect)]
    found = {id(each): each for each in (*own, *named)}
    effects = sorted(found.values(), key=lambda each: each.line)
    if not effects:
        raise InputError(f"{place}: declares no effect (expected a function under @hexdbb.effects.effect)")
    names = [each.name for each in effects]
    for each in effects:
        if names.count(each.name) > 1:
            raise InputError(f"{each.where}: declared twice (expected a name of its own)")
    return effects


def _line_in(path: Path, error: Exception) -> int:
    """Return the line of a file in which an error arose."""
    if isinstance(error, SyntaxError):
        return error.lineno or 0
    # A module knows its file by the whole path, however it was named.
    return line_of(str(path.absolute()), error)
