"""Models: a machine and a list of effects with their values; the file that holds them; the ledger of what was done."""

from hexdbb.model.file import load_model, save_model
from hexdbb.model.ledger import LedgerStep, Size, State
from hexdbb.model.model import Model, default_effects, effect_info, new_model
from hexdbb.model.own import OwnEffect, OwnEffects, Tabulate, Tabulated
from hexdbb.model.selection import parse_selection, split_choice
from hexdbb.model.terms import MountKey, Parameter, Term, new_term

__all__ = [
    "LedgerStep",
    "Model",
    "MountKey",
    "OwnEffect",
    "OwnEffects",
    "Parameter",
    "Size",
    "State",
    "Tabulate",
    "Tabulated",
    "Term",
    "default_effects",
    "effect_info",
    "load_model",
    "new_model",
    "new_term",
    "parse_selection",
    "save_model",
    "split_choice",
]
