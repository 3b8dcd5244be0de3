"""The functions behind ``import hexdbb as hx``: records in, results out.

Each takes a record, several, or the table of samples made of them, and calls the package that does the work.
"""

from hexdbb.api.analysis import (
    add_effect,
    compare,
    diagnose,
    discover,
    discover_all,
    draft_effect,
    predict,
    preview_effect,
    remove_effect,
    table_of,
)
from hexdbb.api.control import compensate, plan_next_test, propose_plan
from hexdbb.api.measuring import measure, simulated_rig
from hexdbb.api.reporting import rank_contributions, report

__all__ = [
    "add_effect",
    "compare",
    "compensate",
    "diagnose",
    "discover",
    "discover_all",
    "draft_effect",
    "measure",
    "plan_next_test",
    "predict",
    "preview_effect",
    "propose_plan",
    "rank_contributions",
    "remove_effect",
    "report",
    "simulated_rig",
    "table_of",
]
