"""Where in a user's file an error arose, so that it can be named with its line."""

from __future__ import annotations

import traceback


def line_of(path: str, error: Exception) -> int:
    """Last line of a file that an exception passed through; 0 where it did not."""
    return next((f.lineno or 0 for f in reversed(traceback.extract_tb(error.__traceback__)) if f.filename == path), 0)
