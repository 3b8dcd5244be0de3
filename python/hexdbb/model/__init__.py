"""Models: a machine and a list of effects with their values; the file that holds them; the ledger of what was done."""

from hexdbb.model.file import load_model, save_model
from hexdbb.model.model import LedgerStep, Model, MountKey, Parameter, Term, default_effects, new_model, new_term
from hexdbb.model.selection import parse_selection

__all__ = [
    "LedgerStep",
    "Model",
    "MountKey",
    "Parameter",
    "Term",
    "default_effects",
    "load_model",
    "new_model",
    "new_term",
    "parse_selection",
    "save_model",
]
