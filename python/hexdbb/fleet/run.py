"""All records of a fleet judged that are not yet: their rows added to the dataset."""

from __future__ import annotations

from collections.abc import Callable

from hexdbb.cluster import Cluster, ClusterOptions, Progress, Results, Summary, run_tasks
from hexdbb.fleet.judging import judge
from hexdbb.fleet.listing import Listing

IN_CALL = {"diagnose": 16, "discover": 1}
"""Records handed to a worker at a time, at most: a diagnosis takes some 20 ms, a discovery seconds."""


def judge_records(
    listing: Listing,
    results: Results,
    where: ClusterOptions | Cluster,
    *,
    again: bool = False,
    tell: Callable[[str], None] = lambda _: None,
    progress: Callable[[Progress], None] = lambda _: None,
) -> Summary:
    """Judge the records of a listing whose content the dataset does not have; see `hexdbb.cluster.run_tasks`.

    Raises
    ------
    InputError, RunError
        Those of `run_tasks`. A record that cannot be judged is a row with its reason.
    """
    most = min((IN_CALL[task.payload["command"]] for task in listing.tasks), default=1)
    return run_tasks(listing.tasks, judge, results, where, tell=tell, progress=progress, again=again, most_in_call=most)
