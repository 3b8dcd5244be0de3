"""What a session shows: records, a model, a circle of them, and what is tried on the model without changing it.

Every action appends the lines that do the same to `Showing.script`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from hexdbb.diagnosis import JudgingNoise, Sufficiency, assess_sufficiency, judging_noise
from hexdbb.discovery import Discovery
from hexdbb.effects import UserEffect, load_effects
from hexdbb.importing import Mapping, read_measured
from hexdbb.ledger import History, history
from hexdbb.model import Model
from hexdbb.record import Record
from hexdbb.samples import Prediction, Samples, predict
from hexdbb.threads import one_thread
from hexdbb.workbench.changes import EVERYTHING, Changes
from hexdbb.workbench.model_file import ModelFile
from hexdbb.workbench.opening import opened_model, opened_records
from hexdbb.workbench.script import Name, Script, call
from hexdbb.workbench.selection import Selection, selections
from hexdbb.workbench.tried import Tried


class Showing:
    """Records and a model, what is shown of them, and what is tried on the model without changing it.

    Parameters
    ----------
    record_paths : sequence of Path
    model_path : Path, optional
        A file that is there is read, and written after every step; one that is not is made by the first step. Without
        a path the model is in memory only, until `save_as`.
    effects_path : Path, optional
        Python file that declares effects of the user's own; it is run.
    mapping : Mapping, optional
        How records of other programs are read.
    tell : callable
        Is told in one line what was detected in a record of another program.

    Raises
    ------
    InputError
        A record or model that cannot be read, or of different machines.
    """

    def __init__(
        self,
        record_paths: Sequence[Path],
        model_path: Path | None = None,
        effects_path: Path | None = None,
        *,
        mapping: Mapping | None = None,
        tell: Callable[[str], None] = lambda _: None,
    ) -> None:
        self.mapping = mapping or Mapping()
        self.records: list[Record] = [read_measured(path, self.mapping, tell) for path in record_paths]
        self.samples = Samples.of(self.records)
        self.file = None if model_path is None else ModelFile(model_path)
        self.script = Script()
        self.tried = Tried()
        self.found: Discovery | None = None
        self.effects_path = effects_path
        self.own_effects: list[UserEffect] = [] if effects_path is None else load_effects(effects_path)
        self.changes = Changes()
        self.script.add(*opened_records(record_paths, self.mapping))
        self.selections = selections(self.samples)
        self.selection = self.selections[0]
        self.model = self._open()

    @property
    def shown(self) -> Model:
        """The model that the charts show: as fitted, or with what is tried."""
        return self.changes.kept("shown", lambda: self.tried.of(self.model))

    @property
    def prediction(self) -> Prediction:
        """What the model shown predicts for all readings."""
        if self.tried.is_nothing:
            return self.fitted
        return self.changes.kept("prediction", lambda: predict(self.samples, self.shown))

    @property
    def fitted(self) -> Prediction:
        """What the model as it was fitted predicts."""
        return self.changes.kept("fitted", lambda: predict(self.samples, self.model))

    @property
    def noise(self) -> JudgingNoise:
        """Noise of one reading, by which the model is judged."""
        return self.changes.kept("noise", lambda: judging_noise(self.samples))

    @property
    def sufficiency(self) -> Sufficiency:
        """Whether the model as it was fitted is sufficient."""
        judge = one_thread(assess_sufficiency)
        return self.changes.kept(
            "sufficiency",
            lambda: judge(self.samples, self.model, self.fitted.residual_mm, noise=self.noise),
        )

    @property
    def history(self) -> History:
        """Steps of the model's ledger."""
        return history(self.model)

    @property
    def is_fitted(self) -> bool:
        """Whether anything was ever fitted."""
        return bool(self.model.ledger)

    def missing_records(self) -> list[str]:
        """Return the records whose files are gone; their readings are in memory."""
        return [record.name for record in self.records if record.path is not None and not record.path.exists()]

    # --- what is tried ----------------------------------------------------------------------------------------------

    def select(self, selection: Selection) -> None:
        """Show another circle, feed or direction."""
        rows = Name(f"samples.part({selection.expression})")
        selection.rows(self.samples)
        self.selection = selection
        shown = Name("shown" if not self.tried.is_nothing else "model")
        self.script.add(f"here = {rows}", f"print({call('hx.predict', Name('here'), shown)}.rms_um)", key="select")
        self.changes.tell(EVERYTHING)

    def switch(self, effect: str, on: bool) -> None:
        """Switch an effect on or off."""
        self._try(self.tried.switching(effect, on))

    def set_value(self, label: str, value: float) -> None:
        """Set one value, in its unit of output."""
        self._try(self.tried.setting(label, value), key=f"value {label}")

    def preview(self, *names: str) -> None:
        """Show the model with a hypothesis, before it is added."""
        if names != self.tried.preview:
            self._try(Tried().previewing(self.samples, self.model, names))

    def back_to_fit(self) -> None:
        """Show the model as it was fitted."""
        if not self.tried.is_nothing:
            self._try(Tried())

    def _open(self) -> Model:
        model, lines = opened_model(self.samples, self.file, self.effects_path, self.own_effects)
        self.script.add(*lines)
        return model

    def _try(self, tried: Tried, key: str = "") -> None:
        tried.of(self.model)  # a name that is not in the model is refused before anything changes
        self.tried = tried
        self.script.add(*tried.lines, "print(hx.predict(samples, shown).rms_um)", key=key)
        self.changes.tell("noise", "fitted", "sufficiency")
