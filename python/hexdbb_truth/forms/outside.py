"""Faults outside the catalogue: what a machine has that no effect describes, with its true place and variable.

More are added as one more module with a `TABLE`, joined here: in `BY_NAME_ONLY`, so that the series of cases that
studies have drawn so far stay as they are.
"""

from hexdbb_truth.forms import (
    outside_anywhere,
    outside_blind,
    outside_blind_three,
    outside_blind_three_measuring,
    outside_blind_three_structure,
    outside_blind_two,
    outside_drives,
    outside_last,
    outside_later,
    outside_measuring,
    outside_others,
    outside_structure,
)
from hexdbb_truth.forms.fault import Fault, Outside

__all__ = ["ANYWHERE", "BY_NAME_ONLY", "EVERY_OUTSIDE", "OUTSIDE", "Fault", "Outside"]

OUTSIDE: dict[str, Outside] = {
    **outside_drives.TABLE,
    **outside_structure.TABLE,
    **outside_measuring.TABLE,
    **outside_later.TABLE,
    **outside_last.TABLE,
    **outside_blind.TABLE,
    **outside_blind_two.TABLE,
}
"""Kinds by name: those that lists of cases mix."""
BY_NAME_ONLY: dict[str, Outside] = {
    **outside_blind_three.TABLE,
    **outside_blind_three_structure.TABLE,
    **outside_blind_three_measuring.TABLE,
    **outside_others.TABLE,
}
"""Kinds by name that are in a list only where it is told to have them."""
ANYWHERE: dict[str, Outside] = outside_anywhere.TABLE
"""Kinds by name that nobody chose: all places, pushed by all states."""
EVERY_OUTSIDE: dict[str, Outside] = {**OUTSIDE, **BY_NAME_ONLY, **ANYWHERE}
"""Kinds that a case may name."""
