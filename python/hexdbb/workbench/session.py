"""What the workbench does, without a page: records, a model, and actions, each a line of Python.

Every action calls the function that the command of the same name calls and appends the lines that do the same to
`Session.script`. Nothing is computed here.

Threads: actions may be called from any thread. One action that changes the model runs at a time; a second one is
refused with the name of the first. Fits and discovery take a table of samples of their own, so that what is shown can
be predicted meanwhile.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TypeVar, cast

from hexdbb import api
from hexdbb.diagnosis import JudgingNoise, Sufficiency, assess_sufficiency, fit_mounts, judging_noise
from hexdbb.discovery import Discovery
from hexdbb.effects import UserEffect, load_effects
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, write_text
from hexdbb.importing import Mapping, read_measured
from hexdbb.ledger import History, history, undo
from hexdbb.model import Model, new_model
from hexdbb.plan import save_plan
from hexdbb.record import Record
from hexdbb.samples import Prediction, Samples, predict
from hexdbb.threads import one_thread
from hexdbb.workbench.model_file import ModelFile
from hexdbb.workbench.own_code import require_ending
from hexdbb.workbench.script import Name, Script, call
from hexdbb.workbench.selection import Selection, selections
from hexdbb.workbench.tried import Tried

Progress = Callable[[str], None]
T = TypeVar("T")


def _nothing(_: str) -> None:
    """Take no notice of progress."""


class Session:
    """Records and a model, what is shown of them, and what was done.

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
        self.busy = ""
        """What is being done; empty where nothing is."""
        self._lock = threading.RLock()
        self._listeners: list[Callable[[], None]] = []
        self._cache: dict[str, object] = {}
        choices = "".join(f", {key}={value!r}" for key, value in self.mapping.choices().items())
        paths = ", ".join(f"hx.read_record({str(path)!r}{choices})" for path in record_paths)
        self.script.add(f"records = [{paths}]", "samples = hx.Samples.of(records)")
        self.selections = selections(self.samples)
        self.selection = self.selections[0]
        self.model = self._opened()

    # --- what is shown ----------------------------------------------------------------------------------------------

    @property
    def shown(self) -> Model:
        """The model that the charts show: as fitted, or with what is tried."""
        return self._kept("shown", lambda: self.tried.of(self.model))

    @property
    def prediction(self) -> Prediction:
        """What the model shown predicts for all readings."""
        if self.tried.is_nothing:
            return self.fitted
        return self._kept("prediction", lambda: predict(self.samples, self.shown))

    @property
    def fitted(self) -> Prediction:
        """What the model as it was fitted predicts."""
        return self._kept("fitted", lambda: predict(self.samples, self.model))

    @property
    def noise(self) -> JudgingNoise:
        """Noise of one reading, by which the model is judged."""
        return self._kept("noise", lambda: judging_noise(self.samples))

    @property
    def sufficiency(self) -> Sufficiency:
        """Whether the model as it was fitted is sufficient."""
        judge = one_thread(assess_sufficiency)
        return self._kept(
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

    # --- actions that change what is shown --------------------------------------------------------------------------

    def select(self, selection: Selection) -> None:
        """Show another circle, feed or direction."""
        rows = Name(f"samples.part({selection.expression})")
        selection.rows(self.samples)
        self.selection = selection
        shown = Name("shown" if not self.tried.is_nothing else "model")
        self.script.add(f"here = {rows}", f"print({call('hx.predict', Name('here'), shown)}.rms_um)", key="select")
        self._changed("*")

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

    # --- actions that change the model ------------------------------------------------------------------------------

    def fit(self) -> None:
        """Fit the model's free values: ``hexdbb diagnose``."""
        with self._doing("fitting the model's values") as table:
            self._commit(api.diagnose(table, self.model).model, "model = hx.diagnose(samples, model).model")

    def ask(self, progress: Progress = _nothing) -> Discovery:
        """Ask what is missing: ``hexdbb discover``."""
        with self._doing("looking for what is missing") as table:
            found = api.discover(table, self.model, progress=progress)
            self.found = found
            self.script.add("found = hx.discover(samples, model)", "print(found.sentence)")
            self._changed("*")
        return found

    def add(self, *names: str) -> None:
        """Add effects, one step each: ``hexdbb add``."""
        with self._doing(f"adding {' and '.join(names)}") as table:
            model, lines = self.model, []
            for name in names:
                model = api.add_effect(table, model, name).model
                lines.append(f"model = {call('hx.add_effect', Name('samples'), Name('model'), name)}.model")
            self._commit(model, *lines)

    def remove(self, name: str) -> None:
        """Remove an effect: ``hexdbb`` has it as `hexdbb.remove_effect`."""
        with self._doing(f"removing {name}") as table:
            line = f"model = {call('hx.remove_effect', Name('samples'), Name('model'), name)}.model"
            self._commit(api.remove_effect(table, self.model, name).model, line)

    def undo(self) -> None:
        """Undo the last step: ``hexdbb undo``."""
        with self._doing("undoing the last step"):
            self._commit(undo(self.model), "model = hx.undo(model)")

    def reload(self) -> None:
        """Read the model file again, after another program wrote it."""
        with self._doing("reading the model again"):
            self.model = self._opened()
            self.tried, self.found = Tried(), None
            self._changed("noise")

    def save_as(self, path: Path) -> None:
        """Write the model to a file of its own; every further step is written there.

        Raises
        ------
        InputError
            The file exists already.
        """
        with self._doing(f"writing {path}"):
            if path.exists():
                raise InputError(f"{path}: exists already (expected a new name)")
            file = ModelFile(path)
            file.save(self.model)
            self.file = file
            self.script.add(call("hx.save_model", Name("model"), str(path)))
            self._changed("*")

    # --- what follows -----------------------------------------------------------------------------------------------

    def write_effects(self, path: Path, source: str) -> list[str]:
        """Write a Python file of effects, try it in a process of its own, and let its effects compete.

        Returns
        -------
        list of str
            Names of the effects.

        Raises
        ------
        InputError
            The file is another one that exists already, does not run, or does not end (`require_ending`).
        """
        with self._doing(f"trying {path}"):
            if path.suffix != ".py" or (path.exists() and path != self.effects_path):
                raise InputError(f"{path}: not written (expected a new name that ends in .py)")
            write_text(path, source)
            self.effects_path = path
            require_ending(
                path, [record.path for record in self.records if record.path is not None], mapping=self.mapping
            )
            effects = load_effects(path)
            self.own_effects, self.found = effects, None
            self.model = self.model.knowing_effects(effects)
            self.script.add(f"model = model.knowing_effects(hx.load_effects({str(path)!r}))")
            self._changed("noise")
        return [each.name for each in effects]

    def drafted(self) -> str:
        """Return the source of what was found, drafted as an effect of the user's own: ``discover --draft``."""
        if self.found is None:
            raise InputError("nothing was asked yet (expected: What is missing?)")
        return api.draft_effect(self.found).source

    def write_compensation(self, path: Path) -> Sequence[tuple[str, str]]:
        """Write the compensation file; return what of the model it leaves out, with the reasons."""
        with self._doing(f"writing {path}"):
            data = api.compensate(self.model, path)
            self.script.add(call("hx.compensate", Name("model"), str(path)))
            return list(data.left_out)

    def write_report(self, path: Path) -> str:
        """Write the report of the records with the model; return its verdict: ``hexdbb report``."""
        with self._doing(f"writing {path}") as table:
            found = api.report(table, self.model, path)
            self.script.add(call("hx.report", Name("samples"), Name("model"), str(path)))
        return found.verdict

    def plan_next(self, path: Path, progress: Progress = _nothing) -> str:
        """Write the plan of the next circle; return what it is for.

        The circle that tells apart what was found, where the verdict is ambiguous; else the one that alone determines
        most of the machine's errors, ``hexdbb plan propose --circles 1``.
        """
        with self._doing("planning the next circle"):
            refuse_existing(path, overwrite=False)
            machine = self.samples.machine
            if self.found is not None and self.found.next_test is not None:
                between = " from ".join(self.found.next_test.between)
                plan, what = api.plan_next_test(self.found), f"tells {between}"
                self.script.add("plan = hx.plan_next_test(found)")
            else:
                plan = api.propose_plan(1, machine=machine, progress=progress)
                what = "determines most of the machine's errors alone"
                self.script.add("plan = hx.propose_plan(1, machine=records[0].machine)")
            save_plan(plan, path, f"The circle that {what}.", machine)
            self.script.add(f"hx.save_plan(plan, {str(path)!r}, machine=records[0].machine)")
        return what

    # --- inside -----------------------------------------------------------------------------------------------------

    def touch(self) -> None:
        """Call the listeners: something that is shown beside the session has changed."""
        self._changed("*")

    def listen(self, heard: Callable[[], None]) -> Callable[[], None]:
        """Call a function after every change; return the function that ends it."""
        self._listeners.append(heard)
        return lambda: self._listeners.remove(heard)

    def _opened(self) -> Model:
        """Read the model, or make a new one; its script starts from what the file held, whatever is saved later."""
        own = "" if self.effects_path is None else f"hx.load_effects({str(self.effects_path)!r})"
        if self.file is None or not self.file.path.exists():
            self.script.add("model = hx.new_model(records[0].machine)" + (f".knowing_effects({own})" if own else ""))
            return new_model(self.samples.machine).knowing_effects(self.own_effects)
        model = self.file.load(self.own_effects)
        steps = len(model.ledger)
        self.script.add(
            f"model = hx.load_model({str(self.file.path)!r}{', ' + own if own else ''})",
            f"while len(model.ledger) > {steps}:  # the file may hold later steps by now",
            "    model = hx.undo(model)",
        )
        known, said = fit_mounts(self.samples, model) if model.mounts else (model, [])
        if said:
            self.script.add("from hexdbb.diagnosis import fit_mounts", "", "model, _ = fit_mounts(samples, model)")
        return known

    @contextmanager
    def _doing(self, what: str) -> Iterator[Samples]:
        """Run one action that changes the model; yield a table of samples of its own."""
        with self._lock:
            if self.busy:
                raise InputError(f"{what}: not now, {self.busy} (expected to wait until it is done)")
            self.busy = what
        self._changed("*")
        try:
            yield Samples.of(self.records)
        finally:
            self.busy = ""
            self._changed("*")

    def _commit(self, model: Model, *lines: str) -> None:
        """Take a model with a step more or less, write it, note the lines; nothing is taken if it cannot be written."""
        saved: tuple[str, ...] = ()
        if self.file is not None:
            self.file.save(model)
            model = replace(model, path=self.file.path)
            saved = (call("hx.save_model", Name("model"), str(self.file.path)),)
        self.script.add(*lines, *saved)
        self.model, self.tried, self.found = model, Tried(), None
        self._changed("noise")

    def _try(self, tried: Tried, key: str = "") -> None:
        tried.of(self.model)  # a name that is not in the model is refused before anything changes
        self.tried = tried
        self.script.add(*tried.lines, "print(hx.predict(samples, shown).rms_um)", key=key)
        self._changed("noise", "fitted", "sufficiency")

    def _changed(self, *kept: str) -> None:
        """Forget what was made but for the parts named (``*``: everything), and call the listeners."""
        if "*" not in kept:
            self._cache = {name: made for name, made in self._cache.items() if name in kept}
        for heard in list(self._listeners):
            heard()

    def _kept(self, name: str, make: Callable[[], T]) -> T:
        """Return what was made before since the last change, or make it."""
        cache = self._cache  # a change while it is made leaves it in the old one
        if name not in cache:
            cache[name] = make()
        return cast(T, cache[name])
