"""Discovery: whether anything is missing from a model, and which effect it is."""

from hexdbb.discovery.auto import AutoStep, closing_sentence, discover_all, is_needed, without_needless
from hexdbb.discovery.discover import Progress, absent_effects, discover
from hexdbb.discovery.own_effects import require_usable_effects
from hexdbb.discovery.result import Candidate, Cause, Discovery, GroupError, NextTest, Structure

__all__ = [
    "AutoStep",
    "Candidate",
    "Cause",
    "Discovery",
    "GroupError",
    "NextTest",
    "Progress",
    "Structure",
    "absent_effects",
    "closing_sentence",
    "discover",
    "discover_all",
    "is_needed",
    "require_usable_effects",
    "without_needless",
]
