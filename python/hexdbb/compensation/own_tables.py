"""Users' effects as tables: those whose push at every place is a function of one variable of one slider or leg.

A user's effect is code, which no controller runs. Asked in states of one's own choosing, it shows on which columns it
depends; where its push is f(x) + t g(x), x and t columns that a controller knows, f and g become tables. All that is
assumed is tested on states drawn at random, and an effect that fails a test is left out with the reason.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hexdbb import _core
from hexdbb.compensation.probe import NO_FACTORS, SWITCHES, WHOLE, Probe, drawn_state, places, ranges
from hexdbb.compensation.tables import TOLERANCE_MM, NoTableError
from hexdbb.errors import InputError
from hexdbb.machine import MachineFile
from hexdbb.model import OwnEffect, is_shaped

Floats = NDArray[np.float64]
Columns = Mapping[str, Floats]

TRIALS = 64
"""States on which what is assumed of an effect is tested: a push that depends on more fails in nearly all of them."""
SAME_MM = 1e-9
"""Rounding of pushes of some mm."""
GRID = 8193
"""Places at which a function is taken: every 0.1 mm of a travel of 0.8 m, so that a pitch error is met fifty times a
period."""
STEEPEST = 0.05
"""Steepest function of a slider's position, mm per mm: the correction would else move by more than a tenth of the
slider itself, and the compensator's iteration would need more than its four steps."""
JUMP_SHARE = 0.2
"""Part of a function's range between two neighbours of `GRID` places above which it jumps: no table follows that."""


@dataclass(frozen=True)
class _Asked:
    """A user's effect at its values, asked in states of a machine."""

    effect: OwnEffect
    values: Floats
    machine: MachineFile

    def push_mm(self, probe: Probe) -> Floats:
        """Return the push at every column of its port, shape (n, columns)."""
        first, count = _core.PORTS[self.port]
        try:
            if is_shaped(self.effect):
                found = self.effect.tabulated_at(probe, self.values)
            else:
                found = self.effect.tabulated(probe)
        except InputError:
            what = "fails in states that were not measured"
            if probe.missing is not None:
                what = f"depends on {probe.missing}, which is not known to a controller"
            raise NoTableError(what) from None
        # The value of a shape is what the effect was asked at, not a factor of a push.
        shapes = getattr(self.effect, "shapes", {})
        names = [each.name for each in self.effect.info().parameters]
        factor = np.where([names[each % len(names)] in shapes for each in range(len(self.values))], 0.0, self.values)
        push = np.zeros((len(probe), count))
        for value, port, column in zip(found.values, found.ports, found.per_unit.T, strict=True):
            push[:, port - first] += factor[value] * column
        return push

    def at(self, columns: Columns) -> Floats:
        """Return the push in some states, shape (n, columns of the port)."""
        return self.push_mm(Probe(columns))

    @property
    def port(self) -> str:
        """Port that is pushed."""
        port: str = self.effect.info().ports[0]
        return port


def own_tables(effect: OwnEffect, values: Floats, machine: MachineFile) -> list[_core.CompensationTable]:
    """Return the tables of a user's effect at its values.

    Raises
    ------
    NoTableError
        Why it is none.
    """
    asked, state = _Asked(effect, values, machine), drawn_state(machine, TRIALS)
    if asked.port in ("ball", "cup", "reading"):
        raise NoTableError(f"pushes the {asked.port}, not the machine")
    probe = Probe(state)
    pushed = asked.push_mm(probe)
    if not pushed.any():
        raise NoTableError("pushes nothing at its values")
    rows = np.arange(0, TRIALS, 2)[::-1]
    if _differ(asked.at({name: column[rows] for name, column in state.items()}), pushed[rows]):
        raise NoTableError("depends on other samples of a record, which are not known to a controller")
    variable, times = _variables(asked, state, list(probe.read))
    return _tables(asked, state, variable, times)


def _variables(asked: _Asked, state: Columns, read: list[str]) -> tuple[str, str]:
    """Return the column of which the push is a function, and the one in which it is linear; empty where none is."""
    if len(read) > 2:
        raise NoTableError(f"depends on {', '.join(read)} together (expected a function of one of them)")
    if not read:
        return "", ""
    if len(read) == 1:
        return read[0], ""
    for variable, times in (read, read[::-1]):
        if times in NO_FACTORS:
            continue
        constant, slope = _linear_parts(asked, state, times)
        if not _differ(asked.at(state), constant + _of_places(asked, state[times]) * slope):
            return variable, times
    raise NoTableError(f"depends on {' and '.join(read)} together (expected to be linear in one of them)")


def _linear_parts(asked: _Asked, state: Columns, times: str) -> tuple[Floats, Floats]:
    """Return f and g of a push f + t g, from t = +1 and -1: all that a direction of travel takes."""
    up, down = (asked.at({**state, times: np.full_like(state[times], t)}) for t in (1.0, -1.0))
    return 0.5 * (up + down), 0.5 * (up - down)


def _tables(asked: _Asked, state: Columns, variable: str, times: str) -> list[_core.CompensationTable]:
    """Return one table for each column of the port that is pushed, and for each part of f + t g."""
    low, high = ranges(asked.machine).get(variable, (0.0, 0.0))
    at = places(variable, low, high, 2 if variable in SWITCHES else GRID) if variable else np.zeros(1)
    grid = {
        name: np.broadcast_to(column[:1], (len(at), *column.shape[1:])).copy()
        for name, column in state.items()
        if name != variable
    }
    if variable:
        grid[variable] = at if variable in WHOLE else np.repeat(at[:, None], 6, axis=1)
    _require_own_leg(asked, state, grid, variable)
    parts = dict(zip(("", times), _linear_parts(asked, grid, times), strict=True)) if times else {"": asked.at(grid)}
    return [
        _table(asked, variable, factor, at, column, place)
        for factor, part in parts.items()
        for place, column in enumerate(part.T)
        if np.abs(column).max() > SAME_MM
    ]


def _table(
    asked: _Asked, variable: str, times: str, at: Floats, value_mm: Floats, place: int
) -> _core.CompensationTable:
    if variable and variable not in SWITCHES:
        _require_smooth(variable, at, value_mm)
    kept = _few(at, value_mm)
    return _core.CompensationTable(
        effect=asked.effect.name,
        port=asked.port,
        variable=variable,
        times=times,
        period=0.0,
        pushes=[(_leg_of(asked.port, place), place, 1.0)],
        knots=at[kept].tolist(),
        values_mm=value_mm[kept].tolist(),
    )


def _require_own_leg(asked: _Asked, state: Columns, grid: Columns, variable: str) -> None:
    """Require that every place depends on its own slider or leg alone: the others elsewhere change nothing."""
    every = asked.at(state)
    for leg in range(6):
        elsewhere = {name: column if column.ndim == 1 else np.roll(column, 1, axis=0) for name, column in state.items()}
        for name, column in state.items():
            if column.ndim == 2:
                elsewhere[name][:, leg] = column[:, leg]
        mine = [place for place in range(every.shape[1]) if _leg_of(asked.port, place) == leg]
        if _differ(asked.at(elsewhere)[:, mine], every[:, mine]):
            raise NoTableError(f"depends on {variable} of several sliders together (expected of its own)")


def _require_smooth(variable: str, at: Floats, value_mm: Floats) -> None:
    change = np.abs(np.diff(value_mm))
    worst = int(np.argmax(change))
    if change[worst] > max(JUMP_SHARE * float(np.ptp(value_mm)), TOLERANCE_MM):
        raise NoTableError(f"jumps at {variable} = {at[worst]:.4g} (expected no jump: a drive cannot follow it)")
    if variable == "sliders_mm" and change[worst] > STEEPEST * (at[1] - at[0]):
        raise NoTableError(f"changes by more than {STEEPEST:g} mm per mm of travel, at {at[worst]:.4g} mm")


def _few(at: Floats, value_mm: Floats) -> NDArray[np.intp]:
    """Return places between which lines miss no other by `TOLERANCE_MM` (Douglas and Peucker 1973)."""
    if len(at) < 3:
        return np.arange(len(at))
    kept, spans = {0, len(at) - 1}, [(0, len(at) - 1)]
    while spans:
        first, last = spans.pop()
        line = np.interp(at[first : last + 1], at[[first, last]], value_mm[[first, last]])
        off = np.abs(value_mm[first : last + 1] - line)
        worst = first + int(np.argmax(off))
        if off.max() > TOLERANCE_MM and first < worst < last:
            kept.add(worst)
            spans += [(first, worst), (worst, last)]
    return np.array(sorted(kept))


def _leg_of(port: str, place: int) -> int:
    """Return the slider or leg to which a column of a port belongs."""
    return place * 6 // int(_core.PORTS[port][1])


def _of_places(asked: _Asked, column: Floats) -> Floats:
    """Return a column's numbers at every place of the port, shape (n, places)."""
    places = range(int(_core.PORTS[asked.port][1]))
    if column.ndim == 1:
        return np.repeat(column[:, None], len(places), axis=1)
    return column[:, [_leg_of(asked.port, each) for each in places]]


def _differ(one: Floats, other: Floats) -> bool:
    return bool(np.abs(one - other).max(initial=0.0) > SAME_MM)
