"""Steps of a ledger in words: what was done, how large it was found to be, what it did to the error."""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.model import LedgerStep, Size
from hexdbb.units import readable_unit

PLACES = {"um": ".2f", "urad": ".2f"}
"""Format of values by unit; others have four significant digits."""


def sentence(step: LedgerStep) -> str:
    """Return a step in one sentence."""
    records = ", ".join(step.records)
    return f"step {step.step}: {deed(step)}; {fall_words(step)}" + (f"; fitted to {records}" if records else "")


def deed(step: LedgerStep) -> str:
    """Return what a step did: ``added backlash of slider 4 (play 10.02 ± 0.11 µm)``."""
    if not step.effect:
        return {"diagnose": "fitted the values"}.get(step.what, step.what)
    done = {"add": "added", "remove": "removed"}.get(step.what, step.what)
    name = name_words(step.effect, step.element_kind, step.elements)
    return f"{done} {name}" + (f" ({sizes_words(step.sizes)})" if step.sizes else "")


def name_words(effect: str, kind: str, elements: Sequence[str]) -> str:
    """Return which elements of an effect are meant: ``backlash of sliders 2 and 4``; the effect alone where all are."""
    if not elements or kind == "machine":
        return effect
    return f"{effect} of {kind or 'element'}{'s' if len(elements) > 1 else ''} {_and(elements)}"


def sizes_words(sizes: Sequence[Size]) -> str:
    """Return values with their uncertainties; the element is named where there are several."""
    several = len({size.element for size in sizes}) > 1
    return "; ".join(_size(size, several) for size in sizes)


def fall_words(step: LedgerStep) -> str:
    """Return what a step did to the error, on the circles fitted and on those held out."""
    words = f"reading error {arrow(step.rms_before_um, step.rms_after_um)} µm RMS"
    words += _peak(step.peak_to_valley_before_um, step.peak_to_valley_after_um)
    if step.heldout_before_um is None or step.heldout_after_um is None:
        return words
    words += f"; held-out circles {arrow(step.heldout_before_um, step.heldout_after_um)} µm RMS"
    return words + _peak(step.heldout_peak_to_valley_before_um, step.heldout_peak_to_valley_after_um)


def arrow(before_um: float, after_um: float) -> str:
    """Return a fall as numbers: ``6.83 -> 0.61``."""
    return f"{before_um:.2f} -> {after_um:.2f}"


def _peak(before_um: float | None, after_um: float | None) -> str:
    if before_um is None or after_um is None:
        return ""
    return f" (peak to valley {before_um:.1f} -> {after_um:.1f} µm)"


def _size(size: Size, several: bool) -> str:
    element = f"{size.element} " if several else ""
    places = PLACES.get(size.unit, ".4g")
    unit = readable_unit(size.unit)
    if size.sigma is None:
        return f"{element}{size.name} {size.value:{places}} {unit}, known only in combination with others"
    return f"{element}{size.name} {size.value:{places}} ± {size.sigma:{places}} {unit}"


def _and(words: Sequence[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
