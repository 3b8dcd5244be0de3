"""Discovery: whether anything is missing from a model, and which effect it is."""

from hexdbb.discovery.auto import AutoStep, discover_all, is_needed, without_needless
from hexdbb.discovery.discover import discover
from hexdbb.discovery.lack_of_fit import FitTest, LackOfFit
from hexdbb.discovery.own_effects import failing_effects
from hexdbb.discovery.result import Candidate, Discovery, NextTest, Structure
from hexdbb.discovery.search import absent_effects

__all__ = [
    "AutoStep",
    "Candidate",
    "Discovery",
    "FitTest",
    "LackOfFit",
    "NextTest",
    "Structure",
    "absent_effects",
    "discover",
    "discover_all",
    "failing_effects",
    "is_needed",
    "without_needless",
]
