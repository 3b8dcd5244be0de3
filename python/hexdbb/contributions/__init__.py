"""Every error's part in the circular deviation, ranked: geometry and effects alike, in µm and per cent.

::

    found = rank_contributions(Samples.of([record]), model)
    print(found)
    found.records[0].rows[0].label, found.to_frame(), found.to_json()
"""

from hexdbb.contributions.groups import Group, groups_of
from hexdbb.contributions.knowledge import Combination
from hexdbb.contributions.ranking import rank_contributions
from hexdbb.contributions.result import Contribution, Contributions, Part, RecordContributions

__all__ = [
    "Combination",
    "Contribution",
    "Contributions",
    "Group",
    "Part",
    "RecordContributions",
    "groups_of",
    "rank_contributions",
]
