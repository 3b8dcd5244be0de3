"""The ledger of a model: what was done to it, step by step, what each step gained, and how the model stood before it.

A step keeps the effects and mounts the model had before, so that any number of steps can be taken back with nothing
but the model's own file. The machine is never changed by a step.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from hexdbb.model.terms import MountKey, Term


@dataclass(frozen=True)
class Snapshot:
    """How a model stood: its effects with their values, the mounts whose set-up it knew."""

    terms: tuple[Term, ...]
    mounts: tuple[MountKey, ...]


@dataclass(frozen=True)
class Size:
    """How large one value of an effect was found to be, in the unit shown; `sigma` is None where it is not known."""

    element: str
    name: str
    value: float
    sigma: float | None
    unit: str


@dataclass(frozen=True)
class LedgerStep:
    """One thing done to a model, to be read aloud. What was not looked at is None.

    Attributes
    ----------
    step : int
        Counts from 1.
    what : str
        ``diagnose``, ``add`` or ``remove``.
    rms_before_um, rms_after_um : float
        Residual of the readings that were fitted, root mean square.
    records : tuple of str
        Names of the records used.
    record_hashes : tuple of str
        SHA-256 of their contents, in the same order.
    effect : str
        The effect added or removed; empty where the step changed values only.
    elements : tuple of str
        Its elements meant; empty where all are.
    element_kind : str
        What an element is: ``slider``, ``guideway``, ``leg``, ``machine``.
    sizes : tuple of Size
        What the effect's values were found to be.
    peak_to_valley_before_um, peak_to_valley_after_um : float or None
        Largest minus smallest residual of the same readings.
    heldout_before_um, heldout_after_um : float or None
        The same root mean square on circles left out of the fit.
    heldout_peak_to_valley_before_um, heldout_peak_to_valley_after_um : float or None
        Largest minus smallest residual there.
    before : Snapshot or None
        The model before this step; None where nobody kept it.
    """

    step: int
    what: str
    rms_before_um: float
    rms_after_um: float
    records: tuple[str, ...]
    record_hashes: tuple[str, ...] = ()
    effect: str = ""
    elements: tuple[str, ...] = ()
    element_kind: str = ""
    sizes: tuple[Size, ...] = ()
    peak_to_valley_before_um: float | None = None
    peak_to_valley_after_um: float | None = None
    heldout_before_um: float | None = None
    heldout_after_um: float | None = None
    heldout_peak_to_valley_before_um: float | None = None
    heldout_peak_to_valley_after_um: float | None = None
    before: Snapshot | None = field(default=None, compare=False, repr=False)
