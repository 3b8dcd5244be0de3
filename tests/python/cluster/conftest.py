"""One cluster of two processes for all tests of a session that only need one."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from hexdbb.cluster import Cluster, ClusterOptions, connected


@pytest.fixture(scope="session")
def two_workers() -> Iterator[Cluster]:
    with connected(ClusterOptions(workers=2)) as cluster:
        yield cluster
