"""Fits that a model's ledger keeps: values fitted, effects added and removed, every step with its gain; undo."""

from hexdbb.ledger.change import add_effect, fit_model, remove_effect
from hexdbb.ledger.history import History, history
from hexdbb.ledger.preview import preview_effect
from hexdbb.ledger.undo import undo

__all__ = ["History", "add_effect", "fit_model", "history", "preview_effect", "remove_effect", "undo"]
