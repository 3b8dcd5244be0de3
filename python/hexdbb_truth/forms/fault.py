"""What a fault outside the catalogue is: a mechanism at a port, how it is drawn, and what else explains it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hexdbb_truth.forms.family import Draw
from hexdbb_truth.forms.labels import Equivalent
from hexdbb_truth.forms.ports import Action


@dataclass(frozen=True, eq=False)
class Fault:
    """A fault as drawn."""

    action: Action
    equivalents: tuple[Equivalent, ...] = ()


@dataclass(frozen=True, eq=False)
class Outside:
    """A kind of fault.

    Attributes
    ----------
    unit : str
        Of size.
    start, limit : float
        Where the search for a size begins; largest size of a machine in use.
    variables : tuple of str
        What it depends on; any of them counts. See `labels`.
    drawn : callable
        Draws it.
    plan : str
        The plan that can see it.
    """

    unit: str
    start: float
    limit: float
    variables: tuple[str, ...]
    drawn: Callable[[Draw], Fault]
    plan: str = "standard"
