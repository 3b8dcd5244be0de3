"""The wanted workspace of a machine: whether it is reached, how near it comes to limits and to singular poses."""

from hexdbb.workspace.assessment import CONDITION_MAX, Assessment, Worst, assess
from hexdbb.workspace.maps import LevelMap, level_map
from hexdbb.workspace.poses import Poses, workspace_poses
from hexdbb.workspace.reach import require_reach, suggested_workspace
from hexdbb.workspace.template import plan_template

__all__ = [
    "CONDITION_MAX",
    "Assessment",
    "LevelMap",
    "Poses",
    "Worst",
    "assess",
    "level_map",
    "plan_template",
    "require_reach",
    "suggested_workspace",
    "workspace_poses",
]
