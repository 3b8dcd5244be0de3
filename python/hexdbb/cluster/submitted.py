"""Calls handed to Dask, a limited number at a time, and taken back as they end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from queue import Empty, SimpleQueue
from types import TracebackType
from typing import Any, TypeVar

from hexdbb.cluster.options import require
from hexdbb.cluster.part import OtherVersionError
from hexdbb.errors import RunError

C = TypeVar("C")
Arguments = tuple[Any, ...]
"""A function and what it is called with."""
NOT_ENDED = ("lost", "pending")
"""States of a call whose worker died before its result was fetched: Dask computes it anew."""


class Submitted:
    """Calls handed to a client; those that have not ended when the block is left are cancelled.

    Parameters
    ----------
    client : distributed.Client
    lost_s : float
        Time without any worker after which it gives up.
    tick_s : float
        Time between two calls of `report`.
    report : callable
        Called while it waits.
    """

    def __init__(self, client: Any, lost_s: float, tick_s: float, report: Callable[[], None]) -> None:
        self._client, self._lost_s, self._tick_s, self._report = client, lost_s, tick_s, report
        self._ended: SimpleQueue[Any] = SimpleQueue()
        self._pending: dict[Any, Any] = {}
        self._reported = self._seen_worker = time.monotonic()

    def __enter__(self) -> Submitted:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._pending and self._client.status == "running":
            self._client.cancel(list(self._pending), asynchronous=False)

    def is_death(self, error: object) -> bool:
        """Return whether an error says that workers died of a call."""
        return isinstance(error, require("distributed").scheduler.KilledWorker)

    def each(
        self, calls: Iterable[C], arguments: Callable[[C], Arguments], window: int, retries: int = 0
    ) -> Iterator[tuple[C, Any]]:
        """Yield every call with what it returned, or the exception that it ended with, in the order of their ends.

        Parameters
        ----------
        calls : iterable
        arguments : callable
            Function and arguments of a call.
        window : int
            Calls that Dask knows of at a time.
        retries : int
            Times that Dask tries a call again that raises.

        Raises
        ------
        RunError
            The scheduler is gone, or has had no worker for a while.
        OtherVersionError
            A worker has another hexdbb.
        """
        waiting = iter(calls)
        while True:
            while len(self._pending) < window and (call := next(waiting, None)) is not None:
                future = self._client.submit(*arguments(call), retries=retries, pure=False)
                self._pending[future] = call
                future.add_done_callback(self._ended.put)
            if not self._pending:
                return
            future = self._next()
            if future.status in NOT_ENDED:
                future.add_done_callback(self._ended.put)
                continue
            call = self._pending.pop(future)
            yield call, self._outcome(future)

    def _next(self) -> Any:
        """Wait for the end of a call; report, and look whether there are workers, while it waits."""
        while True:
            now = time.monotonic()
            if now - self._reported >= self._tick_s:
                self._reported = now
                self._report()
            try:
                future = self._ended.get(timeout=self._tick_s)
            except Empty:
                self._require_workers()
            else:
                self._seen_worker = time.monotonic()
                return future

    def _require_workers(self) -> None:
        if self._client.status != "running":
            raise self._gone()
        if self._client.scheduler_info(n_workers=1)["workers"]:
            self._seen_worker = time.monotonic()
        elif time.monotonic() - self._seen_worker > self._lost_s:
            raise RunError(
                f"no worker for {self._lost_s:g} s (expected one at least); what is done is kept: run it again"
            )

    def _outcome(self, future: Any) -> Any:
        try:
            return future.result()
        except (require("distributed").client.FutureCancelledError, OtherVersionError) as error:
            raise error if isinstance(error, OtherVersionError) else self._gone() from None
        except Exception as error:  # what the call raised, or Dask in its place
            return error

    def _gone(self) -> RunError:
        return RunError(
            "the scheduler is gone, or has forgotten its tasks (it was ended or restarted); what is done is kept: run"
            " it again"
        )
