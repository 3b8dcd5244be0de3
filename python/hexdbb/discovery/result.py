"""What a discovery found: a verdict, the candidates behind it, and what to do next."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import Any, Literal

from hexdbb.discovery.lack_of_fit import LackOfFit
from hexdbb.model import Model

Verdict = Literal["effect", "ambiguous", "none", "unknown"]

MEANING: dict[Verdict, str] = {
    "effect": "an effect is missing, and it is known which",
    "ambiguous": "an effect is missing; several explain these readings alike",
    "none": "nothing is missing: what is left is noise",
    "unknown": "something is missing that no known effect explains",
}


@dataclass(frozen=True)
class FittedParameter:
    """One value of a candidate, in the unit it names."""

    element: str
    name: str
    value: float
    sigma: float | None
    unit: str


@dataclass(frozen=True)
class Candidate:
    """An effect tried by a fit of its own.

    `share` is the part of what the model leaves unexplained that it explains; `model` the fitted model with the
    effect in it; `p_value` is corrected for all candidates tried (Holm 1979).
    """

    effect: str
    elements: tuple[str, ...]
    rms_after_um: float
    chi_square_drop: float
    bic_drop: float
    p_value: float
    share: float
    values: tuple[FittedParameter, ...]
    model: Model

    @property
    def choice(self) -> str:
        """The words for `hexdbb add`."""
        whole = self.elements == tuple(self.model.info(self.effect).elements)
        return self.effect if whole else ":".join((self.effect, *self.elements))

    def to_json(self) -> dict[str, Any]:
        """Give one entry of `candidates`."""
        return {
            "effect": self.effect,
            "elements": [int(each) if each.isdecimal() else each for each in self.elements],
            "rms_after_um": self.rms_after_um,
            "bic_drop": self.bic_drop,
            "p_value": self.p_value,
            "share": self.share,
            "parameters": [
                {
                    "element": each.element,
                    "name": each.name,
                    "value": each.value,
                    "sigma": each.sigma,
                    "unit": each.unit,
                }
                for each in self.values
            ],
        }


@dataclass(frozen=True)
class Structure:
    """A variable that carries part of what is unexplained.

    `period` where it is periodic in it; `place` from where to where, where it sits at one place, or the samples between
    which something shifts; both in `unit`. `size_um` is the amplitude, the shift, or the largest push at the
    place. `sentence` says all of it.
    """

    variable: str
    share: float
    period: float | None
    unit: str
    sentence: str
    place: tuple[float, float] | None = None
    size_um: float | None = None

    def to_json(self) -> dict[str, Any]:
        """Give one entry of `structure`."""
        return {
            "variable": self.variable,
            "share": self.share,
            "period": self.period,
            "unit": self.unit,
            "place": None if self.place is None else list(self.place),
            "size_um": self.size_um,
            "sentence": self.sentence,
        }


@dataclass(frozen=True)
class NextTest:
    """The circle that would tell two candidates apart best, and how well: their difference in standard deviations."""

    circle: dict[str, Any]
    feed_mm_min: float
    expected_sigmas: float
    between: tuple[str, str]

    def to_json(self) -> dict[str, Any]:
        """Give `next_test`: a circle as in a plan."""
        return {
            **self.circle,
            "feeds_mm_min": [self.feed_mm_min],
            "expected_sigmas": self.expected_sigmas,
            "between": list(self.between),
        }


@dataclass(frozen=True)
class Discovery:
    """Outcome of one look for a missing effect; `candidates` best first, the first the one to add."""

    verdict: Verdict
    lack_of_fit: LackOfFit
    rms_before_um: float
    rms_after_um: float
    heldout_before_um: float | None
    heldout_after_um: float | None
    candidates: tuple[Candidate, ...]
    ambiguous_with: tuple[str, ...]
    next_test: NextTest | None
    structure: tuple[Structure, ...]
    remarks: tuple[str, ...] = ()

    @property
    def best(self) -> Candidate | None:
        """The candidate the verdict is about."""
        return self.candidates[0] if self.verdict in ("effect", "ambiguous") else None

    @property
    def sentence(self) -> str:
        """The verdict in words."""
        best = self.best
        named = f": {best.choice}" if best is not None else ""
        others = f" (or {', '.join(self.ambiguous_with)})" if self.ambiguous_with else ""
        return f"{MEANING[self.verdict]}{named}{others}"

    def to_json(self) -> dict[str, Any]:
        """Give the object that `hexdbb discover --json` prints."""
        return {
            "verdict": self.verdict,
            "noise_um": self.lack_of_fit.noise_um,
            "rms_before_um": self.rms_before_um,
            "rms_after_um": self.rms_after_um,
            "heldout_before_um": self.heldout_before_um,
            "heldout_after_um": self.heldout_after_um,
            "candidates": [each.to_json() for each in self.candidates],
            "ambiguous_with": list(self.ambiguous_with),
            "next_test": None if self.next_test is None else self.next_test.to_json(),
            "structure": [each.to_json() for each in self.structure],
            "remarks": list(self.remarks),
        }

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{escape(each.choice)}</td><td>{each.rms_after_um:.2f}</td><td>{each.bic_drop:,.0f}</td>"
            f"<td>{each.share:.0%}</td><td>{each.p_value:.1g}</td></tr>"
            for each in self.candidates
        )
        head = "<tr><th>effect</th><th>RMS after, µm</th><th>BIC drop</th><th>share</th><th>p</th></tr>"
        return f"<p><b>{escape(self.sentence)}</b></p><table>{head}{rows}</table>"
