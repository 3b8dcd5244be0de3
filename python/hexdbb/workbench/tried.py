"""What the user tries on a model without changing it: effects switched off, values set, a hypothesis previewed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from hexdbb.api import preview_effect
from hexdbb.model import Model, switched_off, with_value
from hexdbb.samples import Samples
from hexdbb.workbench.script import Name, call


@dataclass(frozen=True)
class Tried:
    """Changes to look at; none of them is kept.

    Attributes
    ----------
    preview : tuple of str
        Effects of the hypothesis previewed, as `hexdbb.add_effect` takes them.
    values : dict of str to float
        Values set, by label, in units of output.
    off : tuple of str
        Effects switched off.
    base : Model or None
        The model with the hypothesis, fitted; None where none is previewed.
    """

    preview: tuple[str, ...] = ()
    values: dict[str, float] = field(default_factory=dict)
    off: tuple[str, ...] = ()
    base: Model | None = None

    @property
    def is_nothing(self) -> bool:
        """Whether the model is shown as it was fitted."""
        return not (self.preview or self.values or self.off)

    @property
    def lines(self) -> tuple[str, ...]:
        """Lines of Python that make the model shown of the script's `model`."""
        shown = Name("shown")
        first = call("hx.preview_effect", Name("samples"), Name("model"), *self.preview) if self.preview else "model"
        lines = [f"shown = {first}"]
        lines += [f"shown = {call('hx.with_value', shown, *each)}" for each in self.values.items()]
        lines += [f"shown = {call('hx.switched_off', shown, *self.off)}"] if self.off else []
        return tuple(lines)

    def of(self, model: Model) -> Model:
        """Return the model with the changes."""
        shown = self.base or model
        for label, value in self.values.items():
            shown = with_value(shown, label, value)
        return switched_off(shown, *self.off) if self.off else shown

    def previewing(self, samples: Samples, model: Model, names: tuple[str, ...]) -> Tried:
        """Return the preview of a hypothesis; values set and effects switched off before are the fit's again."""
        return Tried(preview=names, base=preview_effect(samples, model, *names))

    def switching(self, effect: str, on: bool) -> Tried:
        """Return the same with an effect switched on or off."""
        others = tuple(each for each in self.off if each != effect)
        return replace(self, off=others if on else (*others, effect))

    def setting(self, label: str, value: float) -> Tried:
        """Return the same with a value set."""
        return replace(self, values={**self.values, label: value})
