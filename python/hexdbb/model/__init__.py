"""Models: a machine and a list of effects with their values; the file that holds them; the ledger of what was done."""

from hexdbb.model.catalogue import default_effects, effect_info, effect_names
from hexdbb.model.choice import Choice
from hexdbb.model.file import load_model, save_model
from hexdbb.model.learned import LearnedEffect
from hexdbb.model.ledger import LedgerStep, Size, Snapshot
from hexdbb.model.model import Model, new_model
from hexdbb.model.own import OwnEffect, OwnEffects, Shape, ShapedEffect, Tabulate, Tabulated, is_shaped
from hexdbb.model.terms import MountKey, Parameter, Term, new_term
from hexdbb.model.variants import switched_off, with_value

__all__ = [
    "Choice",
    "LearnedEffect",
    "LedgerStep",
    "Model",
    "MountKey",
    "OwnEffect",
    "OwnEffects",
    "Parameter",
    "Shape",
    "ShapedEffect",
    "Size",
    "Snapshot",
    "Tabulate",
    "Tabulated",
    "Term",
    "default_effects",
    "effect_info",
    "effect_names",
    "is_shaped",
    "load_model",
    "new_model",
    "new_term",
    "save_model",
    "switched_off",
    "with_value",
]
