"""Signs that change with a direction of motion: abruptly, or smoothly over a transition rate, as friction does."""

from __future__ import annotations

from hexdbb.learned.directed import is_directed
from hexdbb.learned.following import RATES, TURNING, following
from hexdbb.learned.variable import OF_MEMORY, Variable


def turns_with(variable: Variable) -> str | None:
    """Return the column at whose zero a variable's functions change sign abruptly; None if they do not."""
    if variable.turns_within or is_directed(variable):
        return None
    return variable.column if variable.signed else RATES[variable.times][0] if variable.times in RATES else None


def turning(variable: Variable, rate: float) -> Variable:
    """Return the same variable with its change of sign smoothed over a transition rate (mm/s, rad/s)."""
    return following(variable, TURNING, rate)


def at_once(times: str) -> str:
    """Return the direction column that a smoothed one replaces; other columns unchanged."""
    if not turns_gradually(times):
        return times
    return next(direction for direction, (rate, _) in RATES.items() if times.startswith(f"{rate}{OF_MEMORY}"))


def turns_gradually(times: str) -> bool:
    """Whether a multiplying column is a direction whose change of sign is smoothed."""
    return rate_of(times) is not None


def rate_of(times: str) -> str | None:
    """Return the rate at whose zero a multiplying column changes its sign smoothly; None where it does not."""
    rate, _, how = times.partition(OF_MEMORY)
    return rate if how.startswith(f"{TURNING}@") else None


def transition_rate(times: str) -> float:
    """Return over what rate such a column changes its sign, in the rate's unit."""
    return float(times.partition("@")[2])
