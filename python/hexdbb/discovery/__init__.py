"""Discovery: whether anything is missing from a model, and which effect it is."""

from hexdbb.discovery.auto import AutoStep, closing_sentence, discover_all, is_needed, predicts_better, without_needless
from hexdbb.discovery.discover import Progress, absent_effects, discover
from hexdbb.discovery.draft import Draft, draft_effect, require_draftable
from hexdbb.discovery.form import CauseForm, form_of
from hexdbb.discovery.likely import LikelyCause, likely_cause
from hexdbb.discovery.own_effects import require_usable_effects
from hexdbb.discovery.result import Candidate, Cause, Discovery, GroupError, NextTest, Structure

__all__ = [
    "AutoStep",
    "Candidate",
    "Cause",
    "CauseForm",
    "Discovery",
    "Draft",
    "GroupError",
    "LikelyCause",
    "NextTest",
    "Progress",
    "Structure",
    "absent_effects",
    "closing_sentence",
    "discover",
    "discover_all",
    "draft_effect",
    "form_of",
    "is_needed",
    "likely_cause",
    "predicts_better",
    "require_draftable",
    "require_usable_effects",
    "without_needless",
]
