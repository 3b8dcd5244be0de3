"""What a discovery found: a verdict, the candidates behind it, and what to do next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any, Literal

from hexdbb.diagnosis import Diagnosis
from hexdbb.discovery.json_form import CandidateJson, DiscoveryJson, NextTestJson, StructureJson
from hexdbb.discovery.lack_of_fit import LackOfFit
from hexdbb.ledger.json_form import SizeJson, added_json
from hexdbb.model import Model, Size
from hexdbb.plan import Circle

Verdict = Literal["effect", "ambiguous", "none", "unknown"]

MEANING: dict[Verdict, str] = {
    "effect": "an effect is missing, and it is known which",
    "ambiguous": "an effect is missing; several explain these readings alike",
    "none": "nothing is missing: what is left is noise",
    "unknown": "something is missing that no known effect explains",
}


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
    values: tuple[Size, ...]
    model: Model

    @property
    def choice(self) -> str:
        """The words for `hexdbb add`."""
        whole = self.elements == tuple(self.model.info(self.effect).elements)
        return self.effect if whole else ":".join((self.effect, *self.elements))

    def to_json(self) -> CandidateJson:
        """Return one entry of `candidates`."""
        return CandidateJson(
            effect=self.effect,
            elements=tuple(int(each) if each.isdecimal() else each for each in self.elements),
            rms_after_um=self.rms_after_um,
            bic_drop=self.bic_drop,
            p_value=self.p_value,
            share=self.share,
            parameters=tuple(SizeJson(**vars(each)) for each in self.values),
        )


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

    def to_json(self) -> StructureJson:
        """Return one entry of `structure`."""
        return StructureJson(**vars(self))


@dataclass(frozen=True)
class NextTest:
    """The circle that would tell two candidates apart best, and how well: their difference in standard deviations."""

    circle: Circle
    feed_mm_min: float
    expected_sigmas: float
    between: tuple[str, str]

    def to_json(self) -> NextTestJson:
        """Return `next_test`: a circle as in a plan."""
        circle = self.circle
        return NextTestJson(
            id=circle.id,
            mount=circle.mount,
            radius_mm=circle.radius_mm,
            ball_offset_mm=circle.ball_offset_mm,
            plane_rpy_deg=circle.plane_rpy_deg,
            platform_rpy_deg=circle.platform_rpy_deg,
            feeds_mm_min=(self.feed_mm_min,),
            expected_sigmas=self.expected_sigmas,
            between=self.between,
        )


@dataclass(frozen=True, repr=False)
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

    def __repr__(self) -> str:
        lack = self.lack_of_fit
        return f"<Discovery: {self.sentence}; residual {lack.rms_um:.2f} µm RMS, noise {lack.noise_um:.2f} µm>"

    def to_json(self, steps: Sequence[Diagnosis] = ()) -> dict[str, Any]:
        """Return the object that ``hexdbb discover --json`` prints; `steps` are those of ``--auto``."""
        return DiscoveryJson(
            verdict=self.verdict,
            noise_um=self.lack_of_fit.noise_um,
            rms_before_um=self.rms_before_um,
            rms_after_um=self.rms_after_um,
            heldout_before_um=self.heldout_before_um,
            heldout_after_um=self.heldout_after_um,
            candidates=tuple(each.to_json() for each in self.candidates),
            ambiguous_with=self.ambiguous_with,
            next_test=None if self.next_test is None else self.next_test.to_json(),
            structure=tuple(each.to_json() for each in self.structure),
            remarks=self.remarks,
            steps=tuple(added_json(each) for each in steps),
        ).to_json()

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{escape(each.choice)}</td><td>{each.rms_after_um:.2f}</td><td>{each.bic_drop:,.0f}</td>"
            f"<td>{each.share:.0%}</td><td>{each.p_value:.1g}</td></tr>"
            for each in self.candidates
        )
        head = "<tr><th>effect</th><th>RMS after, µm</th><th>BIC drop</th><th>share</th><th>p</th></tr>"
        return f"<p><b>{escape(self.sentence)}</b></p><table>{head}{rows}</table>"
