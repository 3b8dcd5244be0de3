"""The model file under a session: what another program wrote meanwhile is never overwritten."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

from hexdbb.errors import InputError
from hexdbb.model import Model, OwnEffect, load_model, save_model


class ModelFile:
    """A model file, and what it held when it was last read or written here."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._digest = _digest(path)

    @property
    def exists(self) -> bool:
        """Whether the file was there when it was last read or written here."""
        return self._digest is not None

    @property
    def is_changed(self) -> bool:
        """Whether it holds something else now: another program, or another workbench, has written it."""
        return _digest(self.path) != self._digest

    def load(self, effects: Iterable[OwnEffect] = ()) -> Model:
        """Read it, as `hexdbb.model.load_model` does."""
        self._digest = _digest(self.path)
        return load_model(self.path, effects)

    def require_unchanged(self) -> None:
        """Check that the file holds what it held.

        Raises
        ------
        InputError
            It does not.
        """
        if self.is_changed:
            what = "was changed" if self.path.exists() else "was removed"
            raise InputError(
                f"{self.path}: {what} since it was opened, by another program or workbench; nothing was overwritten"
                " (expected to open it again: Reload)"
            )

    def save(self, model: Model) -> None:
        """Write it, if nobody else did.

        Raises
        ------
        InputError
            As `require_unchanged`.
        RunError
            It cannot be written.
        """
        self.require_unchanged()
        save_model(model, self.path)
        self._digest = _digest(self.path)


def _digest(path: Path) -> str | None:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None
