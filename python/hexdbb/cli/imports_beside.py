"""Libraries imported beside an analysis: the engine computes without Python's lock, and one core imports meanwhile."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from threading import Thread

DRAWING = ("matplotlib.figure", "matplotlib.backends.backend_agg")
"""What every picture is drawn with; it takes a third of a second to import."""


@contextmanager
def imported_beside(libraries: tuple[str, ...]) -> Iterator[None]:
    """Import libraries in a thread while the block runs; they are there when it ends.

    Parameters
    ----------
    libraries : tuple of str
        Modules of which the block imports none: two threads that import parts of one package wait for one another. A
        library that cannot be imported raises where it is used, as it would without this.
    """
    thread = Thread(target=_import_all, args=(libraries,), name="imports")
    thread.start()
    try:
        yield
    finally:
        thread.join()


def _import_all(libraries: tuple[str, ...]) -> None:
    for name in libraries:
        with suppress(Exception):  # raised again by the import where it is used
            import_module(name)
