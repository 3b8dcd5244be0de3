"""What is kept between changes of a session, who hears of a change, and what is being done."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar, cast

from hexdbb.errors import InputError

T = TypeVar("T")

EVERYTHING = "*"
"""Keeps all that was made, where what changed is shown beside it."""


class Changes:
    """Values made of a state, forgotten when it changes; listeners; one long action at a time.

    May be used from any thread.
    """

    def __init__(self) -> None:
        self.busy = ""
        """What is being done; empty where nothing is."""
        self._lock = threading.Lock()
        self._listeners: list[Callable[[], None]] = []
        self._made: dict[str, object] = {}

    def listen(self, heard: Callable[[], None]) -> Callable[[], None]:
        """Call a function after every change; return the function that ends it."""
        self._listeners.append(heard)
        return lambda: self._listeners.remove(heard)

    def tell(self, *kept: str) -> None:
        """Forget what was made but for the parts named, or `EVERYTHING`, and call the listeners."""
        if EVERYTHING not in kept:
            self._made = {name: made for name, made in self._made.items() if name in kept}
        for heard in list(self._listeners):
            heard()

    def kept(self, name: str, make: Callable[[], T]) -> T:
        """Return what was made before since the last change, or make it."""
        made = self._made  # a change while it is made leaves it in the old one
        if name not in made:
            made[name] = make()
        return cast(T, made[name])

    @contextmanager
    def doing(self, what: str) -> Iterator[None]:
        """Run one long action.

        Raises
        ------
        InputError
            Another one runs; its name is in the message.
        """
        with self._lock:
            if self.busy:
                raise InputError(f"{what}: not now, {self.busy} (expected to wait until it is done)")
            self.busy = what
        self.tell(EVERYTHING)
        try:
            yield
        finally:
            self.busy = ""
            self.tell(EVERYTHING)
