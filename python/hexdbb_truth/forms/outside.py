"""Faults outside the catalogue: what a machine has that no effect describes, with its true place and variable.

More are added as one more module with a `TABLE`, joined here.
"""

from hexdbb_truth.forms import (
    outside_blind,
    outside_blind_two,
    outside_drives,
    outside_last,
    outside_later,
    outside_measuring,
    outside_structure,
)
from hexdbb_truth.forms.fault import Fault, Outside

__all__ = ["OUTSIDE", "Fault", "Outside"]

OUTSIDE: dict[str, Outside] = {
    **outside_drives.TABLE,
    **outside_structure.TABLE,
    **outside_measuring.TABLE,
    **outside_later.TABLE,
    **outside_last.TABLE,
    **outside_blind.TABLE,
    **outside_blind_two.TABLE,
}
"""Kinds by name."""
