"""Learned effects of a fitted model as text: a sentence and a table each, in place of their coefficients."""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import RenderableType
from rich.table import Table
from rich.text import Text

from hexdbb.learned.shown import rows, sentence
from hexdbb.model import Term


def learned_parts(term: Term) -> Iterator[RenderableType]:
    """Yield a learned effect's name, its functions in words, and their tables."""
    effect = term.learned
    assert effect is not None
    yield f"\n{effect.name}"
    for function, curve in enumerate(effect.curves(term.values)):
        yield Text(f"  {sentence(effect.space.hypothesis, curve, effect.space.period, function)}")
        if len(curve.at) < 2:
            continue
        table = Table(box=None, header_style="bold", pad_edge=False)
        for heading in (f"  {curve.variable}", "value, µm", "± 1 sigma"):
            table.add_column(heading, justify="right")
        for row in rows(curve):
            table.add_row(*row)
        yield table
