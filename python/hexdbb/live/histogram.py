"""Counts of cycle times as bars of a chart, and in one line of text."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

BARS = 40
"""Largest number of bars: as many as can be told apart on a third of a page."""
SHARES = {0.5: "half", 0.999: "99.9 %"}
"""Shares of the cycles, each with its name: the usual cycle, and one in a thousand."""

Counted = Sequence[Sequence[int]]
"""Pairs of bin and count."""


def bars(counted: Counted, bin_ms: float) -> list[tuple[float, int]]:
    """Return the lower edge (ms) and count of at most `BARS` bars of one width, gaps included."""
    if not counted:
        return []
    bins, counts = np.array(counted).T
    first, last = int(bins.min()), int(bins.max())
    width = -(-(last - first + 1) // (BARS - 1))
    first -= first % width
    heights = np.bincount((bins - first) // width, weights=counts)
    return [(round((first + index * width) * bin_ms, 4), int(height)) for index, height in enumerate(heights)]


def in_words(counted: Counted, bin_ms: float, longest_ms: float) -> str:
    """Return below which times shares of the cycles lie, and the longest one."""
    if not counted:
        return "no cycle yet"
    bins, counts = np.array(sorted(map(tuple, counted))).T
    cumulated = np.cumsum(counts)
    # The last bin may hold any time beyond the others.
    limits_ms = np.append((bins[:-1] + 1) * bin_ms, longest_ms)
    said = [
        f"{name} within {limits_ms[np.searchsorted(cumulated, share * cumulated[-1])]:.1f} ms"
        for share, name in SHARES.items()
    ]
    return f"{cumulated[-1]:,} cycles: {', '.join(said)}, the longest {longest_ms:.1f} ms"
