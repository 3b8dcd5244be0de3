"""Clusters of two processes and of one, for all studies of the tests."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from hexdbb.cluster import Cluster, ClusterOptions, connected


@pytest.fixture(scope="session")
def two_workers() -> Iterator[Cluster]:
    with connected(ClusterOptions(workers=2)) as cluster:
        yield cluster


@pytest.fixture(scope="session")
def one_worker() -> Iterator[Cluster]:
    with connected(ClusterOptions(workers=1)) as cluster:
        yield cluster
