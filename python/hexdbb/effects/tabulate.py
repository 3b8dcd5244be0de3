"""From a user's function to numbers the engine can work with: the effect's push per unit in every sample.

What a user's function returns is checked here, once: its shape, that it is finite, that it changes. Everything after
that is the engine's (`TabulatedEffect`), as for its own effects.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.effects.traces import line_of
from hexdbb.errors import InputError
from hexdbb.model import Tabulated
from hexdbb.samples import PUSH_SHAPES, Samples

if TYPE_CHECKING:
    from hexdbb.effects.user import UserEffect

Floats = NDArray[np.float64]


class UserEffectError(InputError):
    """A user's effect cannot be used; the message begins with its file and line."""


def tabulated(effect: UserEffect, samples: Samples, *, must_vary: bool) -> Tabulated:
    """Evaluate a user's effect for a table of samples.

    Parameters
    ----------
    effect : UserEffect
    samples : Samples
    must_vary : bool
        Refuse an effect that is the same in every sample. In a part of a record it may well be: that is asked of whole
        records only.

    Raises
    ------
    UserEffectError
        The function raises, or returns a wrong shape or a value that is not finite.
    """
    columns = [_columns(effect, name, basis, len(samples)) for name, basis in _bases(effect, samples)]
    if must_vary:
        for name, table in zip(effect.parameters, columns, strict=True):
            _require_variation(f"{effect.where}: {name}", table)
    first_port = _core.PORTS[effect.port][0]
    values, ports, tables = [], [], []
    for parameter, table in enumerate(columns):
        width = table.shape[1]
        for column in range(width):
            element = column * effect.elements // width
            values.append(element * len(columns) + parameter)
            ports.append(first_port + column)
        tables.append(table)
    return Tabulated(effect.info(), tuple(values), tuple(ports), np.hstack(tables))


def _bases(effect: UserEffect, samples: Samples) -> list[tuple[str, object]]:
    """Call the user's function; one result for each parameter."""
    try:
        with np.errstate(all="ignore"):  # a value that is not finite is named below
            result = effect.basis(samples)
    except Exception as error:  # a user's function may raise anything
        line = line_of(effect.path, error) or effect.line
        said = f"{type(error).__name__}: {error}"
        raise UserEffectError(f"{effect.path}:{line}: effect {effect.name}: {said}") from None
    if len(effect.parameters) == 1:
        return [(effect.parameters[0], result)]
    count = len(effect.parameters)
    if not isinstance(result, (tuple, list)) or len(result) != count:
        raise UserEffectError(
            f"{effect.where}: returns {_kind(result)} (expected {count} arrays, one for each parameter)"
        )
    return list(zip(effect.parameters, result, strict=True))


def _columns(effect: UserEffect, parameter: str, basis: object, count: int) -> Floats:
    """Check one parameter's basis; shape (count, columns of the port)."""
    of = f"{effect.where}: {parameter}"
    expected = (count, *PUSH_SHAPES[effect.port])
    if basis is None:
        raise UserEffectError(f"{of}: returns nothing (expected an array of shape {expected})")
    try:
        table = np.asarray(basis, dtype=np.float64)
    except (TypeError, ValueError):
        raise UserEffectError(
            f"{of}: returns {_kind(basis)} (expected an array of numbers of shape {expected})"
        ) from None
    if table.shape != expected:
        raise UserEffectError(f"{of}: returns shape {table.shape} (expected {expected} at port {effect.port})")
    table = table.reshape(count, -1)
    wrong = ~np.isfinite(table).all(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise UserEffectError(
            f"{of}: {table[row][~np.isfinite(table[row])][0]} in sample {row + 1} (expected a number)"
        )
    return table


def _require_variation(of: str, table: Floats) -> None:
    if not table.any():
        raise UserEffectError(f"{of}: zero in every sample (expected a push that depends on the state)")
    if len(table) > 1 and (table == table[0]).all():
        raise UserEffectError(f"{of}: the same in every sample (expected a push that depends on the state)")


def _kind(value: object) -> str:
    return "nothing" if value is None else f"a {type(value).__name__}"
