"""What the workbench does, without a page: records, a model, and actions, each a line of Python.

Every action calls the function that the command of the same name calls and appends the lines that do the same to
`Session.script`. Nothing is computed here. `outputs` has the actions that write files beside the model.

Threads: actions may be called from any thread. One action that changes the model runs at a time; a second one is
refused with the name of the first. Fits and discovery take a table of samples of their own, so that what is shown can
be predicted meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from hexdbb import api
from hexdbb.discovery import Discovery
from hexdbb.effects import UserEffect
from hexdbb.errors import InputError
from hexdbb.ledger import undo
from hexdbb.model import Model
from hexdbb.samples import Samples
from hexdbb.workbench.changes import EVERYTHING
from hexdbb.workbench.model_file import ModelFile
from hexdbb.workbench.script import Name, call
from hexdbb.workbench.showing import Showing
from hexdbb.workbench.tried import Tried

Progress = Callable[[str], None]


class Session(Showing):
    """Records and a model, what is shown of them, and actions that change the model."""

    def fit(self) -> None:
        """Fit the model's free values: ``hexdbb diagnose``."""
        with self.doing("fitting the model's values") as table:
            self._commit(api.diagnose(table, self.model).model, "model = hx.diagnose(samples, model).model")

    def ask(self, progress: Progress = lambda _: None) -> Discovery:
        """Ask what is missing: ``hexdbb discover``."""
        with self.doing("looking for what is missing") as table:
            found = api.discover(table, self.model, progress=progress)
            self.found = found
            self.script.add("found = hx.discover(samples, model)", "print(found.sentence)")
            self.changes.tell(EVERYTHING)
        return found

    def add(self, *names: str) -> None:
        """Add effects, one step each: ``hexdbb add``."""
        with self.doing(f"adding {' and '.join(names)}") as table:
            model, lines = self.model, []
            for name in names:
                model = api.add_effect(table, model, name).model
                lines.append(f"model = {call('hx.add_effect', Name('samples'), Name('model'), name)}.model")
            self._commit(model, *lines)

    def remove(self, name: str) -> None:
        """Remove an effect: ``hexdbb`` has it as `hexdbb.remove_effect`."""
        with self.doing(f"removing {name}") as table:
            line = f"model = {call('hx.remove_effect', Name('samples'), Name('model'), name)}.model"
            self._commit(api.remove_effect(table, self.model, name).model, line)

    def undo(self) -> None:
        """Undo the last step: ``hexdbb undo``."""
        with self.doing("undoing the last step"):
            self._commit(undo(self.model), "model = hx.undo(model)")

    def reload(self) -> None:
        """Read the model file again, after another program wrote it."""
        with self.doing("reading the model again"):
            self.model = self._open()
            self.tried, self.found = Tried(), None
            self.changes.tell("noise")

    def save_as(self, path: Path) -> None:
        """Write the model to a file of its own; every further step is written there.

        Raises
        ------
        InputError
            The file exists already.
        """
        with self.doing(f"writing {path}"):
            if path.exists():
                raise InputError(f"{path}: exists already (expected a new name)")
            file = ModelFile(path)
            file.save(self.model)
            self.file = file
            self.script.add(call("hx.save_model", Name("model"), str(path)))
            self.changes.tell(EVERYTHING)

    def know_effects(self, effects: list[UserEffect]) -> None:
        """Let effects of the user's own, of the file `effects_path`, compete from now on."""
        self.own_effects, self.found = effects, None
        self.model = self.model.knowing_effects(effects)
        self.script.add(f"model = model.knowing_effects(hx.load_effects({str(self.effects_path)!r}))")
        self.changes.tell("noise")

    def drafted(self) -> str:
        """Return the source of what was found, drafted as an effect of the user's own: ``discover --draft``."""
        if self.found is None:
            raise InputError("nothing was asked yet (expected: What is missing?)")
        return api.draft_effect(self.found).source

    @contextmanager
    def doing(self, what: str) -> Iterator[Samples]:
        """Run one long action, none beside it; yield a table of samples of its own."""
        with self.changes.doing(what):
            yield Samples.of(self.records)

    def _commit(self, model: Model, *lines: str) -> None:
        """Take a model with a step more or less, write it, note the lines; nothing is taken if it cannot be written."""
        saved: tuple[str, ...] = ()
        if self.file is not None:
            self.file.save(model)
            model = replace(model, path=self.file.path)
            saved = (call("hx.save_model", Name("model"), str(self.file.path)),)
        self.script.add(*lines, *saved)
        self.model, self.tried, self.found = model, Tried(), None
        self.changes.tell("noise")
