"""What a discovery found: a verdict, the causes, the evidence behind them, what remains, and what to do next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any, Literal

from hexdbb.diagnosis import Diagnosis, LackOfFit, Noise, Sufficiency
from hexdbb.model import Model, Size
from hexdbb.plan import Circle
from hexdbb.samples import Samples

if TYPE_CHECKING:
    from hexdbb.discovery.json_form import CandidateJson, CauseJson, NextTestJson, StructureJson

Grouping = Literal["circle", "feed", "direction", "lap"]
GROUPINGS: tuple[Grouping, ...] = ("circle", "feed", "direction", "lap")
Verdict = Literal["effect", "ambiguous", "none", "unknown"]


@dataclass(frozen=True)
class GroupError:
    """RMS error where a grouping's groups were left out in turn, without and with the hypotheses, µm."""

    before_um: float
    after_um: float
    share: float
    """Explained part of what is beyond the noise."""


@dataclass(frozen=True)
class Candidate:
    """A set of hypotheses, mostly one, that was fitted.

    Attributes
    ----------
    names : tuple of str
        Each as `hexdbb add` takes it.
    log_evidence : float
        Natural logarithm of its evidence over that of the model as it is, multiplicity included.
    rms_after_um : float
        Residual with it, its form's deviation explained.
    share : float
        Part of the unexplained mean square that it explains where fitted.
    heldout : mapping of str to GroupError
        By what was left out: circle, feed, direction, lap.
    refused : tuple of str
        Why it is not admissible.
    """

    names: tuple[str, ...]
    log_evidence: float
    rms_after_um: float
    share: float
    heldout: Mapping[Grouping, GroupError]
    refused: tuple[str, ...]

    @property
    def choice(self) -> str:
        """All names, joined."""
        return " + ".join(self.names)

    def to_json(self) -> CandidateJson:
        """Return one entry of `candidates`."""
        from hexdbb.discovery.json_form import CandidateJson, HeldOutJson  # only --json needs them

        return CandidateJson(
            names=self.names,
            log_evidence=self.log_evidence,
            rms_after_um=self.rms_after_um,
            share=self.share,
            heldout=tuple(HeldOutJson(left_out=name, **vars(each)) for name, each in self.heldout.items()),
            refused=self.refused,
        )


@dataclass(frozen=True)
class Cause:
    """One cause of what is missing.

    Attributes
    ----------
    choice : str
        As `hexdbb add` takes it.
    effect : str
        Name of the effect; of a learned one the same as `choice`.
    elements : tuple of str
    verdict : str
        On this cause alone: `effect`, `ambiguous`, or `unknown` where it is learned and has no known name.
    share : float
        Part of the unexplained mean square that is left where it is taken out.
    margin : float
        Log evidence over the best explanation of another kind.
    form_deviation : float
        How far the machine's form is from the effect's, as a part of its size.
    refinements : tuple of str
        Learned functions at its place that describe the deviation.
    function : str or None
        The learned function that is this cause without its formula, as `hexdbb add` takes it; None where none is.
    alike : tuple of str
        The same effect at other elements, which explains the readings as well.
    rivals : tuple of str
        Of another kind, that explain the readings as well.
    values : tuple of Size
    clause : str
        It in words.
    """

    choice: str
    effect: str
    elements: tuple[str, ...]
    verdict: Verdict
    share: float
    margin: float
    form_deviation: float
    refinements: tuple[str, ...]
    function: str | None
    alike: tuple[str, ...]
    rivals: tuple[str, ...]
    values: tuple[Size, ...]
    clause: str

    def to_json(self) -> CauseJson:
        """Return one entry of `causes`."""
        from hexdbb.discovery.json_form import CauseJson  # only --json needs them
        from hexdbb.ledger.json_form import SizeJson

        keys = {name: value for name, value in vars(self).items() if name not in ("values", "elements")}
        elements = tuple(int(each) if each.isdecimal() else each for each in self.elements)
        return CauseJson(**keys, elements=elements, parameters=tuple(SizeJson(**vars(each)) for each in self.values))


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
        from hexdbb.discovery.json_form import StructureJson  # only --json needs it

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
        from hexdbb.discovery.json_form import NextTestJson  # only --json needs it

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
    """Outcome of one look for what is missing.

    Attributes
    ----------
    verdict : str
        `none`, `effect`, `ambiguous` or `unknown`.
    sentence : str
        The answer for whoever fits the machine.
    sufficiency : Sufficiency
        Of the model as it is.
    causes : tuple of Cause
        What is missing, the largest first; none where the verdict is `none`, or where nothing tried explains it.
    candidates : tuple of Candidate
        Hypotheses fitted: those of the verdict first, then by evidence.
    samples : Samples
        What was looked at.
    noise : Noise
        Of one reading, by which the model was judged.
    base, model : Model
        As it is, its values fitted; with the known causes, fitted.
    remaining : Sufficiency or None
        Of that model: what remains; None where no known cause was found.
    rms_before_um, rms_after_um : float
        Residual of the model as it is, and with the known causes in their exact form.
    next_test : NextTest or None
        The circle that tells the first cause from its first rival, where the verdict is `ambiguous`.
    structure : tuple of Structure
        Predictors of the residual that remains.
    remarks : tuple of str
        Sentences.
    likely : str
        The likely cause in one sentence; empty where nothing is missing.
    learned : Model or None
        With the learned causes too, fitted; None where no cause is learned, or none that a model can hold.
    refinements : tuple of str
        Learned functions that describe the forms of effects which the model has, where nothing else is missing.
    calibrated : tuple of str
        Effects that the model holds, as its bar's length is calibrated, and `base` fits: the readings contradict it.
    """

    verdict: Verdict
    sentence: str
    sufficiency: Sufficiency
    causes: tuple[Cause, ...]
    candidates: tuple[Candidate, ...]
    samples: Samples
    noise: Noise
    base: Model
    model: Model
    remaining: Sufficiency | None
    rms_before_um: float
    rms_after_um: float
    next_test: NextTest | None = None
    structure: tuple[Structure, ...] = ()
    remarks: tuple[str, ...] = ()
    likely: str = ""
    learned: Model | None = None
    refinements: tuple[str, ...] = ()
    calibrated: tuple[str, ...] = ()

    @property
    def best(self) -> Cause | None:
        """The cause the verdict is about, where it is a known one."""
        return self.causes[0] if self.verdict in ("effect", "ambiguous") else None

    @property
    def lack_of_fit(self) -> LackOfFit:
        """Lack of fit of the model as it is."""
        return self.sufficiency.lack_of_fit

    @property
    def ambiguous_with(self) -> tuple[str, ...]:
        """What else explains the readings as well as the first cause."""
        return self.causes[0].rivals if self.verdict == "ambiguous" else ()

    @property
    def heldout(self) -> Mapping[Grouping, GroupError]:
        """How the causes predict what was left out."""
        return self.candidates[0].heldout if self.causes and self.candidates else {}

    @property
    def heldout_before_um(self) -> float | None:
        """RMS error on held-out circles without the causes; None with one circle, or without causes."""
        return self.heldout["circle"].before_um if "circle" in self.heldout else None

    @property
    def heldout_after_um(self) -> float | None:
        """RMS error on held-out circles with the causes."""
        return self.heldout["circle"].after_um if "circle" in self.heldout else None

    def __repr__(self) -> str:
        lack = self.lack_of_fit
        return (
            f"<Discovery: {self.verdict}: {self.sentence}; residual {lack.rms_um:.2f} µm RMS,"
            f" noise {lack.noise_um:.2f} µm>"
        )

    def to_json(self, steps: Sequence[Diagnosis] = (), closing: str | None = None) -> dict[str, Any]:
        """Return the object that ``hexdbb discover --json`` prints; `steps` and `closing` are those of ``--auto``."""
        from hexdbb.discovery.json_form import DiscoveryJson  # only --json needs them
        from hexdbb.ledger.json_form import added_json

        return DiscoveryJson(
            verdict=self.verdict,
            sentence=self.sentence,
            noise_um=self.lack_of_fit.noise_um,
            rms_before_um=self.rms_before_um,
            rms_after_um=self.rms_after_um,
            heldout_before_um=self.heldout_before_um,
            heldout_after_um=self.heldout_after_um,
            sufficiency=self.sufficiency.to_json(),
            causes=tuple(each.to_json() for each in self.causes),
            candidates=tuple(each.to_json() for each in self.candidates),
            remaining=None if self.remaining is None else self.remaining.to_json(),
            ambiguous_with=self.ambiguous_with,
            next_test=None if self.next_test is None else self.next_test.to_json(),
            structure=tuple(each.to_json() for each in self.structure),
            remarks=self.remarks,
            refinements=self.refinements,
            calibrated=self.calibrated,
            steps=tuple(added_json(each) for each in steps),
            closing=closing,
        ).to_json()

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{escape(each.choice)}</td><td>{each.log_evidence:,.0f}</td><td>{each.share:.0%}</td>"
            f"<td>{each.rms_after_um:.2f}</td><td>{escape('; '.join(each.refused))}</td></tr>"
            for each in self.candidates
        )
        head = (
            "<tr><th>hypothesis</th><th>log evidence</th><th>explains</th><th>RMS after, µm</th><th>refused</th></tr>"
        )
        return f"<p><b>{escape(self.sentence)}</b></p><table>{head}{rows}</table>"
