"""A client of Dask: of a local cluster that lives as long as it is used, or of a scheduler; its workers checked."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any

from hexdbb.cluster.environment import Environment, difference, own_environment, reporter
from hexdbb.cluster.options import ClusterOptions, require
from hexdbb.errors import InputError, RunError

Tell = Callable[[str], None]

LOOPBACK = "127.0.0.1"
CONNECT_S = 6.0
"""Time for a scheduler to answer: one on another continent does within a second, and a wrong address is to be said
within ten, the end of the program included."""
WORKERS_S = 30.0
"""Time for a scheduler's first worker to appear: those of a batch system start with it, and import for some seconds."""
FAILURES_ALLOWED = 2
"""Deaths of a worker after which Dask tries a task again, in a local cluster: the third gives it up."""
MEMORY_SHARE = 0.9
"""Part of this computer's memory that workers of a local cluster may use together; this process needs the rest."""
GIB = 2.0**30


@dataclass(frozen=True)
class Cluster:
    """A client of Dask, and what is known of its workers.

    Attributes
    ----------
    client : distributed.Client
    environment : dict of str
        Versions that workers must have (`hexdbb.cluster.environment`).
    workers : int
        Threads of all workers when the client was made; an existing scheduler may gain and lose some.
    memory_bytes : int
        Least memory that a worker may use for each of its threads; 0 where it is not limited.
    """

    client: Any
    environment: Environment
    workers: int
    memory_bytes: int


@contextmanager
def connected(options: ClusterOptions, tell: Tell = lambda _: None) -> Iterator[Cluster]:
    """Yield a client of a cluster whose workers have this hexdbb; a local cluster ends with the block.

    Parameters
    ----------
    options : ClusterOptions
    tell : callable
        Is told in a line what the cluster is, its memory, and where its dashboard is.

    Raises
    ------
    InputError
        Dask is not installed, a certificate is refused, or a worker has another hexdbb.
    RunError
        No scheduler answers, or it has no worker.
    """
    distributed = require("distributed")
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what matters is an error of ours
    with ExitStack() as stack:
        if options.scheduler is None:
            client = stack.enter_context(_local_client(distributed, options.workers))
        else:
            client = stack.enter_context(_client_of(distributed, options))
        workers = _workers(client, options)
        own = own_environment()
        for address, found in client.run(reporter(), on_error="return").items():
            wrong = _refusal(address, found, own)
            if wrong is not None:
                raise InputError(wrong)
        threads = sum(each["nthreads"] for each in workers.values())
        memory = min(int(each["memory_limit"] or 0) // each["nthreads"] for each in workers.values())
        tell(_told(client, options, threads, memory))
        yield Cluster(client, own, threads, memory)


@contextmanager
def _local_client(distributed: Any, workers: int | None) -> Iterator[Any]:
    """Yield the client of a cluster of processes of one thread each, reached from this computer only."""
    # Cores and memory that this process may use, not those that the computer has.
    count = workers or require("dask.system").cpu_count()
    limit = int(MEMORY_SHARE * require("distributed.system").MEMORY_LIMIT / count)
    settings = {
        "distributed.scheduler.allowed-failures": FAILURES_ALLOWED,
        # Nothing is spilled to disk: a task's data are small, and one that is not is to be seen.
        "distributed.worker.memory.spill": False,
        "distributed.worker.memory.target": False,
        # Dask's own measurements: samples of every task's stack, each 10 ms, nobody looks at; the load of the computer
        # shows as well every 2 s as every 0.5 s.
        "distributed.worker.profile.enabled": False,
        "distributed.admin.system-monitor.interval": "2s",
    }
    with ExitStack() as stack:
        stack.enter_context(require("dask").config.set(settings))
        try:
            cluster = distributed.LocalCluster(
                n_workers=count,
                threads_per_worker=1,
                processes=True,
                host=LOOPBACK,
                dashboard_address=f"{LOOPBACK}:0",
                memory_limit=limit,
                silence_logs=logging.CRITICAL,
            )
        except (OSError, RuntimeError) as error:
            raise RunError(f"--workers {count}: workers did not start: {error}") from error
        stack.enter_context(cluster)
        yield stack.enter_context(distributed.Client(cluster, timeout=CONNECT_S))


@contextmanager
def _client_of(distributed: Any, options: ClusterOptions) -> Iterator[Any]:
    """Yield the client of an existing scheduler; its errors in one line."""
    address, security = options.scheduler, None
    if options.tls_ca is not None:
        security = distributed.Security(
            tls_ca_file=str(options.tls_ca),
            tls_client_cert=str(options.tls_cert),
            tls_client_key=str(options.tls_key),
            require_encryption=True,
        )
    try:
        client = distributed.Client(address, timeout=CONNECT_S, security=security)
    except (OSError, ValueError, RuntimeError) as error:
        raise _unanswered(options, error) from None
    try:
        yield client
    finally:
        # A scheduler that is gone does not answer to a farewell.
        client.close(timeout=1.0)


def _unanswered(options: ClusterOptions, error: BaseException) -> InputError | RunError:
    # The address stands in the text of a scheduler that is not there as well.
    reasons = " ".join(_reasons(error)).lower().replace("tls://", "")
    if options.tls_ca is not None and ("certificate" in reasons or "ssl" in reasons or "tls" in reasons):
        return InputError(
            f"--scheduler {options.scheduler}: a certificate is refused (expected certificates of scheduler and command"
            f" signed by the authority in {options.tls_ca})"
        )
    return RunError(
        f"--scheduler {options.scheduler}: no scheduler answered within {CONNECT_S:g} s (expected the address that"
        " `dask scheduler` printed)"
    )


def _reasons(error: BaseException | None) -> Iterator[str]:
    """Yield the texts of an error and of those that led to it, their class names too."""
    while error is not None:
        yield f"{type(error).__name__} {error}"
        error = error.__cause__ or error.__context__


def _workers(client: Any, options: ClusterOptions) -> dict[str, Any]:
    """Return what the scheduler knows of its workers, by address; waits for the first."""
    try:
        client.wait_for_workers(1, timeout=WORKERS_S)
    except TimeoutError:
        raise RunError(
            f"--scheduler {options.scheduler}: no worker within {WORKERS_S:g} s"
            f" (expected one at least: dask worker {options.scheduler})"
        ) from None
    workers: dict[str, Any] = client.scheduler_info(n_workers=-1)["workers"]
    return workers


def _refusal(address: str, found: Environment | BaseException, own: Environment) -> str | None:
    if isinstance(found, BaseException):
        reason = next(iter(str(found).splitlines()), type(found).__name__)
        return f"worker {address} does not say which hexdbb it has: {reason} (expected {own['hexdbb']}, as here)"
    return difference(address, found, own)


def _told(client: Any, options: ClusterOptions, threads: int, memory: int) -> str:
    where = f"at {options.scheduler}" if options.scheduler is not None else "on this computer"
    limit = f"at most {memory / GIB:.1f} GiB a task" if memory else "memory not limited"
    return f"{threads} worker{'s' if threads != 1 else ''} {where}, {limit}; dashboard: {client.dashboard_link}"
