"""Changing a model: effects added and taken away, every step kept with what it gained, every step undone."""

from hexdbb.ledger.change import add_effect, remove_effect
from hexdbb.ledger.choice import held_at_zero, with_effect
from hexdbb.ledger.history import History, history
from hexdbb.ledger.undo import undo

__all__ = ["History", "add_effect", "held_at_zero", "history", "remove_effect", "undo", "with_effect"]
