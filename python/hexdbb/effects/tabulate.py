"""From a user's function to numbers the engine can work with: the effect's push per unit in every sample.

What a user's function returns is checked here, once: its shape, that it is finite, that it changes. Everything after
that is the engine's (`TabulatedEffect`), as for its own effects.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.effects.traces import line_of
from hexdbb.errors import InputError
from hexdbb.model import Shape, Tabulated
from hexdbb.samples import PUSH_SHAPES, Samples

if TYPE_CHECKING:
    from hexdbb.effects.user import UserEffect

Floats = NDArray[np.float64]

STEP = 1e-3
"""Step of a shape's derivative in its prior standard deviations: far below what bends, far above rounding."""


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
    starts = {name: shape.start for name, shape in effect.declared_shapes}
    columns = _pushes(effect, samples, starts)
    if must_vary:
        for name, table in zip(effect.parameters, columns, strict=True):
            _require_variation(f"{effect.where}: {name}", table)
    first_port = _core.PORTS[effect.port][0]
    values, ports, tables = [], [], []
    for parameter, table in enumerate(columns):
        width = table.shape[1]
        for column in range(width):
            element = column * effect.elements // width
            values.append(element * _stride(effect) + parameter)
            ports.append(first_port + column)
        tables.append(table)
    return Tabulated(effect.info(), tuple(values), tuple(ports), np.hstack(tables))


def tabulated_at(effect: UserEffect, samples: Samples, values: Floats) -> Tabulated:
    """Evaluate a user's effect with shapes: the push per unit of its parameters, and by each shape.

    Parameters
    ----------
    effect : UserEffect
    samples : Samples
    values : ndarray, shape (size,)
        Parameters, then shapes, element by element.

    Returns
    -------
    Tabulated
        What the shapes' values push is to first order about `values`, as differences from there.
    """
    count, first_port = len(effect.parameters), _core.PORTS[effect.port][0]
    known: dict[tuple[float, ...], list[Floats]] = {}

    def at(shapes: Floats) -> list[Floats]:
        key = tuple(map(float, shapes))
        if key not in known:
            names = [name for name, _ in effect.declared_shapes]
            known[key] = _pushes(effect, samples, dict(zip(names, key, strict=True)))
        return known[key]

    numbers: list[int] = []
    ports: list[int] = []
    tables: list[Floats] = []
    for element, own in enumerate(values.reshape(effect.elements, -1)):
        sizes, shapes = own[:count], own[count:]
        width = at(shapes)[0].shape[1] // effect.elements
        mine = slice(element * width, (element + 1) * width)
        parts = [table[:, mine] for table in at(shapes)]
        for index, (_, shape) in enumerate(effect.declared_shapes):
            parts.append(_slope(at, shapes, index, shape, sizes)[:, mine] if sizes.any() else 0.0 * parts[0])
        for parameter, table in enumerate(parts):
            numbers += [element * _stride(effect) + parameter] * width
            ports += range(first_port + mine.start, first_port + mine.stop)
            tables.append(table)
    return Tabulated(effect.info(), tuple(numbers), tuple(ports), np.hstack(tables))


def _slope(at: Callable[[Floats], list[Floats]], shapes: Floats, index: int, shape: Shape, sizes: Floats) -> Floats:
    """Return the derivative of the push of some sizes by one shape: a central difference, inside its domain."""
    step = np.zeros(len(shapes))
    room = min(shape.upper - shapes[index], shapes[index] - shape.lower)
    step[index] = STEP * shape.prior_sigma
    if room > step[index]:
        low, high = shapes - step, shapes + step
    else:
        inward = 1.0 if shape.upper - shapes[index] > shapes[index] - shape.lower else -1.0
        low, high = sorted((shapes, shapes + inward * step), key=lambda each: float(each[index]))
    change = [above - below for above, below in zip(at(high), at(low), strict=True)]
    total = sum(size * each for size, each in zip(sizes, change, strict=True))
    found: Floats = np.asarray(total) / float(high[index] - low[index])
    return found


def _stride(effect: UserEffect) -> int:
    """Return the number of values of an element."""
    return len(effect.parameters) + len(effect.declared_shapes)


def _pushes(effect: UserEffect, samples: Samples, shapes: Mapping[str, float]) -> list[Floats]:
    """Return what one unit of each parameter pushes, shape (n, columns of the port) each."""
    return [_columns(effect, name, basis, len(samples)) for name, basis in _bases(effect, samples, shapes)]


def _bases(effect: UserEffect, samples: Samples, shapes: Mapping[str, float]) -> list[tuple[str, object]]:
    """Call the user's function; one result for each parameter."""
    try:
        with np.errstate(all="ignore"):  # a value that is not finite is named below
            result = effect.basis(samples, **shapes)
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
