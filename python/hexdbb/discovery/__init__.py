"""Discovery: whether anything is missing from a model, and which effect it is."""

from hexdbb.discovery.discover import absent_effects, discover
from hexdbb.discovery.lack_of_fit import FitTest, LackOfFit
from hexdbb.discovery.result import Candidate, Discovery, NextTest, Structure

__all__ = [
    "Candidate",
    "Discovery",
    "FitTest",
    "LackOfFit",
    "NextTest",
    "Structure",
    "absent_effects",
    "discover",
]
