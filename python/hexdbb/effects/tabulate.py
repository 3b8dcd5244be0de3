"""From a user's function to numbers the engine can work with: the effect's push per unit in every sample.

What a user's function gives is checked here, once: its shape, that it is finite, that it changes. Everything after that
is the engine's (`TabulatedEffect`), as for its own effects.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.effects.sample_state import SampleState, sample_state
from hexdbb.effects.shapes import SHAPES
from hexdbb.effects.traces import line_of
from hexdbb.errors import InputError
from hexdbb.machine import MachineFile

if TYPE_CHECKING:
    from hexdbb.effects.user import UserEffect

Floats = NDArray[np.float64]


class UserEffectError(InputError):
    """A user's effect cannot be used; the message begins with its file and line."""


@dataclass(frozen=True)
class Tabulated:
    """A user's effect as numbers: value `values[j]` pushes port column `ports[j]` by `per_unit[:, j]`."""

    effect: UserEffect
    values: tuple[int, ...]
    ports: tuple[int, ...]
    per_unit: Floats
    """Shape (n, k)."""

    def add_to(self, engine: _core.Model) -> None:
        """Append it, values zero, to a model that is to predict the samples it was tabulated for, or a part of them."""
        values, ports = list(self.values), list(self.ports)
        engine.add_tabulated(self.effect.info(), values=values, ports=ports, per_unit=self.per_unit)


def add_own(effect: UserEffect, engine: _core.Model, samples: _core.Samples, machine: MachineFile) -> None:
    """Append a user's effect, values zero, to a model that is to predict samples, or a part of them.

    In a part of a record an effect may well be the same everywhere: that is asked of whole records only (`tabulate`).

    Raises
    ------
    UserEffectError
        Its function raises, or gives a wrong shape or a value that is not finite.
    """
    _tabulated(effect, sample_state(samples, machine), must_vary=False).add_to(engine)


def evaluated(effect: UserEffect, samples: object) -> Tabulated:
    """Evaluate for a table of samples."""
    return _tabulated(effect, samples, must_vary=False)  # type: ignore[arg-type]


def tabulate(effects: Sequence[UserEffect], state: SampleState) -> tuple[list[Tabulated], list[UserEffectError]]:
    """Evaluate users' effects; one that fails does not hold up the others.

    Returns
    -------
    tabulated : list of Tabulated
    failed : list of UserEffectError
        Of the effects that raise, or give a wrong shape, a value that is not finite, or the same push in every sample.
    """
    tabulated, failed = [], []
    for each in effects:
        try:
            tabulated.append(_tabulated(each, state, must_vary=True))
        except UserEffectError as error:
            failed.append(error)
    return tabulated, failed


def _tabulated(effect: UserEffect, state: SampleState, *, must_vary: bool) -> Tabulated:
    columns = [_columns(effect, name, basis, len(state)) for name, basis in _bases(effect, state)]
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
    return Tabulated(effect, tuple(values), tuple(ports), np.hstack(tables))


def _bases(effect: UserEffect, state: SampleState) -> list[tuple[str, object]]:
    """Call the user's function; one result a parameter."""
    try:
        with np.errstate(all="ignore"):  # a value that is not finite is named below
            result = effect.basis(state)
    except Exception as error:  # a user's function may raise anything
        line = line_of(effect.path, error) or effect.line
        said = f"{type(error).__name__}: {error}"
        raise UserEffectError(f"{effect.path}:{line}: effect {effect.name}: {said}") from None
    if len(effect.parameters) == 1:
        return [(effect.parameters[0], result)]
    count = len(effect.parameters)
    if not isinstance(result, (tuple, list)) or len(result) != count:
        raise UserEffectError(f"{effect.where}: gives {_kind(result)} (expected {count} arrays, one a parameter)")
    return list(zip(effect.parameters, result, strict=True))


def _columns(effect: UserEffect, parameter: str, basis: object, count: int) -> Floats:
    """Check one parameter's basis; shape (count, columns of the port)."""
    of = f"{effect.where}: {parameter}"
    expected = (count, *SHAPES[effect.port])
    if basis is None:
        raise UserEffectError(f"{of}: gives nothing (expected to return an array of shape {expected})")
    try:
        table = np.asarray(basis, dtype=np.float64)
    except (TypeError, ValueError):
        raise UserEffectError(
            f"{of}: gives {_kind(basis)} (expected an array of numbers of shape {expected})"
        ) from None
    if table.shape != expected:
        raise UserEffectError(f"{of}: gives shape {table.shape} (expected {expected} at port {effect.port})")
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
