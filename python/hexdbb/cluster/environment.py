"""Which hexdbb, engine and Python a process has: workers must have those of the command.

Results of another version, or of an engine built otherwise, differ in their last digits or in more; rows of both would
lie in one dataset and nobody could say which is which.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Environment = dict[str, str]
"""Versions by name: ``hexdbb``, ``engine``, ``python``."""


def reporter() -> Callable[[], Environment]:
    """Return a function that finds the versions of the process it is called in.

    It is defined inside, so that Dask sends its code: a worker that has no hexdbb, or one without this module, can
    still say so.
    """

    def report() -> Environment:
        import hashlib
        import platform
        from pathlib import Path

        found = {"hexdbb": "none", "engine": "none", "python": platform.python_version()}
        try:
            import hexdbb
            from hexdbb import _core
        except ImportError:
            return found
        found["hexdbb"] = hexdbb.__version__
        # Its content: builds of one version differ in compiler and flags, and so in rounding.
        found["engine"] = hashlib.sha256(Path(str(_core.__file__)).read_bytes()).hexdigest()[:12]
        return found

    return report


def own_environment() -> Environment:
    """Return the versions of this process."""
    return reporter()()


def difference(worker: str, found: Environment, own: Environment) -> str | None:
    """Return what is wrong with a worker's versions in one sentence; None where nothing is.

    Parameters
    ----------
    worker : str
        Its address.
    found, own : dict
        Versions of the worker and of this process. Pythons may differ in their last number.
    """
    for name in ("hexdbb", "engine", "python"):
        if _compared(name, found) != _compared(name, own):
            what = {"hexdbb": "hexdbb", "engine": "an engine of hexdbb built otherwise,", "python": "Python"}[name]
            version = "no hexdbb" if found[name] == "none" else f"{what} {found[name]}"
            return f"worker {worker} has {version} (expected {own[name]}, as here; install the same there)"
    return None


def _compared(name: str, versions: Environment) -> Any:
    return versions[name].split(".")[:2] if name == "python" else versions[name]
