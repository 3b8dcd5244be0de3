"""Cases with forms: a machine, one or more faults of stated size and form deviation, a plan; told by their names.

    backlash-d10-x3-judge-s7          play, 10 % off the catalogue's form, 3 times the noise remaining, judging half
    backlash+bar_drift-d10-x3-judge-s7   a pair; three and more in the same way
    backlash+bar_drift-d10-x30,3-judge-s7   the same, each of a size of its own
    dent-d0-x10-judge-s2              a fault outside the catalogue (it has no form to deviate from)
    none-judge-s4                     a machine without a fault
    ...@varied                        on another plan than the kind's own

The seed draws the machine (geometry, set-up, noise) and what a fault has besides its size. The same seed in the other
half is another machine with another fault.
"""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.record import SLIDER_COLUMNS, Record, write_record
from hexdbb.rig.geometry import Array
from hexdbb.rig.truth import Spread, TruthFile, random_truth
from hexdbb_truth.forms import measuring_forms, plans, reversal_forms, slider_forms, structure_forms
from hexdbb_truth.forms.deviation import Formed, measured_deviation
from hexdbb_truth.forms.family import Family
from hexdbb_truth.forms.history import History
from hexdbb_truth.forms.labels import VARIABLES, Label, equivalents
from hexdbb_truth.forms.measure import Measured
from hexdbb_truth.forms.outside import EVERY_OUTSIDE, Outside
from hexdbb_truth.forms.ports import Action
from hexdbb_truth.forms.sizes import shown_deviation, size_of

HALVES = ("calibrate", "judge")
TIMES_NOISE = (1.5, 3.0, 10.0, 30.0, 100.0)
DEVIATIONS = (0.0, 0.05, 0.1, 0.2)
FAMILIES: dict[str, Family] = {
    **reversal_forms.FAMILIES,
    **slider_forms.FAMILIES,
    **structure_forms.FAMILIES,
    **measuring_forms.FAMILIES,
}
CATALOGUED = tuple(FAMILIES)
WARMING = frozenset({"leg_thermal", "screw_thermal"})
ROOM_C, RISE_C, SENSOR_NOISE_C = 20.0, 2.0, 0.02
TIMES = r"\d+(?:\.\d+)?"
NAME = re.compile(
    rf"(?:(?P<kinds>[a-z_0-9]+(?:\+[a-z_0-9]+)*)-d(?P<percent>\d+)-x(?P<times>{TIMES}(?:,{TIMES})*)|none)"
    r"-(?P<half>calibrate|judge)-s(?P<seed>\d+)(?:@(?P<plan>[a-z_]+))?"
)


@dataclass(frozen=True)
class Hidden:
    """One fault of a case.

    Attributes
    ----------
    label : Label
        What is true of it.
    action : Action
    size : float
        In `unit`.
    unit : str
    form : str
        What its form is.
    formed : Formed or None
        Where the catalogue has a formula for it.
    """

    label: Label
    action: Action
    size: float
    unit: str
    form: str
    formed: Formed | None


@dataclass(frozen=True)
class Case:
    """One test of discovery; computed when asked.

    Attributes
    ----------
    kinds : tuple of str
        Faults; none in a clean machine.
    form_deviation : float
        Share of each catalogued fault at its port that is not the catalogue's formula.
    times_noise : float
        RMS that each leaves when geometry and set-up have been fitted, over the noise.
    half : str
        ``calibrate`` or ``judge``.
    seed : int
    plan_name : str or None
        The kind's own where none is given.
    temperature : bool or None
        Whether a thermometer is read; every second seed where nothing is said.
    driven : History or None
        What is driven in place of a plan of a name.
    spread : Spread or None
        Of the errors of geometry and set-up, where it is not the usual one.
    noise_um : float or None
        Of the gauge, where it is not the usual one.
    times_each : tuple of float
        The same as `times_noise` fault by fault, where they differ; that is then the largest.
    """

    kinds: tuple[str, ...]
    form_deviation: float
    times_noise: float
    half: str
    seed: int
    plan_name: str | None = None
    temperature: bool | None = None
    driven: History | None = None
    spread: Spread | None = None
    noise_um: float | None = None
    times_each: tuple[float, ...] = ()

    @property
    def name(self) -> str:
        """The name that `case` understands."""
        times = ",".join(f"{each:g}" for each in self.times_each or (self.times_noise,))
        fault = f"{'+'.join(self.kinds)}-d{100.0 * self.form_deviation:.0f}-x{times}"
        plan = f"@{self.plan_name}" if self.plan_name is not None else ""
        return f"{fault if self.kinds else 'none'}-{self.half}-s{self.seed}{plan}"

    @property
    def catalogued(self) -> bool:
        """Whether the catalogue has an effect for every fault."""
        return all(kind in CATALOGUED for kind in self.kinds)

    @cached_property
    def history(self) -> History:
        """What is driven."""
        if self.driven is not None:
            return self.driven
        own = [FAMILIES[kind].plan if kind in FAMILIES else EVERY_OUTSIDE[kind].plan for kind in self.kinds]
        special = [name for name in own if name != "standard"]
        return plans.history(self.plan_name or (special[0] if special else "standard"))

    @cached_property
    def truth(self) -> TruthFile:
        """Geometry, set-up and gauge of the machine."""
        machine = random_truth(self._number("machine"), self.spread)
        noise_um = machine.gauge.noise_um if self.noise_um is None else self.noise_um
        gauge = machine.gauge.model_copy(update={"range_um": plans.RANGE_UM, "noise_um": noise_um})
        return machine.model_copy(update={"gauge": gauge})

    @cached_property
    def measured(self) -> Measured:
        """The machine on its plan."""
        return Measured(self.truth, self.history)

    @cached_property
    def hidden(self) -> tuple[Hidden, ...]:
        """What is to be found.

        Raises
        ------
        UnreachableSizeError
            No machine in use has a fault so large.
        """
        times = self.times_each or (self.times_noise,) * len(self.kinds)
        return tuple(self._hidden(*each) for each in zip(self.kinds, times, strict=True))

    @property
    def labels(self) -> tuple[Label, ...]:
        """What is true of each fault."""
        return tuple(each.label for each in self.hidden)

    def readings_mm(self) -> Array:
        """Return the readings before noise and rounding."""
        return self.measured.readings_mm([(each.action, each.size) for each in self.hidden])

    def deviations(self) -> tuple[float | None, ...]:
        """Return the form deviation of each fault as measured at its port; None where there is no formula."""
        scene = self.measured.scene(self.history.samples)
        return tuple(
            None if each.formed is None else measured_deviation(each.formed, scene, each.size) for each in self.hidden
        )

    def shown_deviation(self) -> tuple[float | None, ...]:
        """Return the share of what each fault leaves in the readings that its formula does not explain."""
        return tuple(
            None if each.formed is None else shown_deviation(each.formed, self.measured, each.size)
            for each in self.hidden
        )

    def record(self) -> Record:
        """Return what `hexdbb-run` would have written.

        Raises
        ------
        InputError
            A reading is beyond the gauge's range.
        """
        draw = np.random.default_rng([self._number("noise")])
        gauge, n = self.truth.gauge, len(self.history.samples)
        noisy_um = self.readings_mm() * 1e3 + draw.normal(0.0, gauge.noise_um, n)
        largest = float(np.abs(noisy_um).max())
        if largest > gauge.range_um:
            raise InputError(f"case {self.name}: reading of {largest:.0f} µm (expected within {gauge.range_um:g} µm)")
        columns = self._columns()
        columns["reading_um"] = np.round(noisy_um / gauge.resolution_um) * gauge.resolution_um
        if self.temperature if self.temperature is not None else bool(self.seed % 2):
            columns["temperature_c"] = self._temperature_c() + draw.normal(0.0, SENSOR_NOISE_C, n)
        plan = self.history.plan
        return Record(columns, plan.gauge, plan.mounts, plan.circles, self.history.machine)

    def write(self, folder: Path, suffix: str = ".csv") -> Path:
        """Write the record, the text form where the suffix is ``.csv``; return its path."""
        path = folder / f"{self.name}{suffix}"
        write_record(self.record(), path, overwrite=True)
        return path

    def _columns(self) -> dict[str, NDArray[np.generic]]:
        history = self.history
        rows, runs = history.samples, history.run[history.samples]
        counts = history.machine.can_setup.counts_per_mm
        turned = np.abs(history.angle_rad[rows]) / (2.0 * np.pi)
        encoders_mm = np.round(history.drive_mm[rows] * counts) / counts
        return {
            "t_s": history.time_s[rows],
            "circle": np.array([run.circle.id for run in history.runs])[runs],
            "sweep": runs,
            "direction": history.direction(rows).astype(int),
            "lap": np.floor(turned + 1e-9).astype(np.int64),
            "angle_deg": np.degrees(history.angle_rad[rows]) % 360.0 % 360.0,
            "feed_mm_min": np.array([run.feed_mm_min for run in history.runs])[runs],
            **dict(zip(SLIDER_COLUMNS, encoders_mm.T, strict=True)),
        }

    def _temperature_c(self) -> Array:
        """Return the temperature of the machine's parts: what warms follows it, other machines keep the room's."""
        rows = self.history.samples
        warm = [each.formed for each in self.hidden if each.label.kind in WARMING]
        if not warm:
            return np.full(len(rows), ROOM_C)
        tau_s = self._drawn(next(kind for kind in self.kinds if kind in WARMING))[1]
        return np.asarray(ROOM_C - RISE_C * np.expm1(-self.history.time_s[rows] / tau_s))

    def _hidden(self, kind: str, times_noise: float) -> Hidden:
        if kind in EVERY_OUTSIDE:
            return self._outside(kind, EVERY_OUTSIDE[kind], times_noise)
        family = FAMILIES[kind]
        formed, _, form = self._drawn(kind)
        action = formed.action()
        size = size_of(action, self.measured, times_noise, family.start, family.limit)
        alike = len(formed.elements) == 6
        elements = () if alike else tuple(each + 1 for each in formed.elements)
        port = {"compliance": "leg", "delay": "slider"}.get(formed.port, formed.port)
        label = Label(kind, kind in CATALOGUED, port, elements, VARIABLES[kind], equivalents(kind, elements))
        return Hidden(label, action, size, family.unit, form, formed)

    def _outside(self, kind: str, outside: Outside, times_noise: float) -> Hidden:
        fault = outside.drawn(self._draw(kind))
        size = size_of(fault.action, self.measured, times_noise, outside.start, outside.limit)
        every = 3 if fault.action.port == "guideway" else 6
        elements = () if len(fault.action.elements) == every else tuple(each + 1 for each in fault.action.elements)
        label = Label(kind, False, fault.action.port, elements, outside.variables, fault.equivalents)
        return Hidden(label, fault.action, size, outside.unit, kind, None)

    def _drawn(self, kind: str) -> tuple[Formed, float, str]:
        """Return a fault with its form, the time constant of what warms, and the form's name."""
        draw, family = self._draw(kind), FAMILIES[kind]
        exact = family.exact(draw)
        forms = family.calibrate if self.half == "calibrate" else family.judge
        form = forms[int(draw.integers(len(forms)))]
        formed = Formed(exact.port, exact.elements, exact.formula, exact.others, form(draw, exact), self.form_deviation)
        tau_s = (exact.known or {}).get("warm_s", 0.0)
        return formed, tau_s, form.__name__.strip("_") if self.form_deviation else "exact"

    def _draw(self, kind: str) -> np.random.Generator:
        return np.random.default_rng([self._number(kind)])

    def _number(self, purpose: str) -> int:
        """Return a seed of its own for each purpose in each half: a fault is drawn alike whatever else is hidden."""
        return zlib.crc32(f"{self.half}/{purpose}/{self.seed}".encode())


def case(name: str) -> Case:
    """Return the case of a name.

    Raises
    ------
    InputError
        No case is called so.
    """
    match = NAME.fullmatch(name)
    if match is None:
        raise InputError(
            f'case "{name}" (expected KIND[+KIND]-dPERCENT-xTIMES-HALF-sSEED[@PLAN] or none-HALF-sSEED[@PLAN])'
        )
    plan = match["plan"]
    if plan is not None and plan not in plans.PLANS:
        raise InputError(f'case "{name}": plan "{plan}" (expected one of {", ".join(plans.PLANS)})')
    if match["kinds"] is None:
        return Case((), 0.0, 0.0, match["half"], int(match["seed"]), plan)
    kinds = tuple(match["kinds"].split("+"))
    for kind in kinds:
        if kind not in FAMILIES and kind not in EVERY_OUTSIDE:
            known = ", ".join([*FAMILIES, *EVERY_OUTSIDE])
            raise InputError(f'case "{name}": kind "{kind}" (expected one of {known})')
    times = tuple(map(float, match["times"].split(",")))
    if len(times) not in (1, len(kinds)):
        raise InputError(f'case "{name}": {len(times)} sizes (expected one, or one for each of {len(kinds)} kinds)')
    deviation, seed = int(match["percent"]) / 100.0, int(match["seed"])
    return Case(kinds, deviation, max(times), match["half"], seed, plan, times_each=times if len(times) > 1 else ())
