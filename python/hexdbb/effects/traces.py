"""Lines of a user's file in which errors arose."""

from __future__ import annotations

import traceback


def line_of(path: str, error: Exception) -> int:
    """Return the last line of a file that an exception passed through; 0 where it did not."""
    return next((f.lineno or 0 for f in reversed(traceback.extract_tb(error.__traceback__)) if f.filename == path), 0)
