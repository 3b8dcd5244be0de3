"""The model with which a session begins, and the lines of Python that begin with the same."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from hexdbb.diagnosis import fit_mounts
from hexdbb.effects import UserEffect
from hexdbb.importing import Mapping
from hexdbb.model import Model, new_model
from hexdbb.samples import Samples
from hexdbb.workbench.model_file import ModelFile


def opened_records(paths: Sequence[Path], mapping: Mapping) -> tuple[str, ...]:
    """Return the lines that read the records; a mapping says how those of other programs are read."""
    choices = "".join(f", {key}={value!r}" for key, value in mapping.choices().items())
    read = ", ".join(f"hx.read_record({str(path)!r}{choices})" for path in paths)
    return f"records = [{read}]", "samples = hx.Samples.of(records)"


def opened_model(
    samples: Samples, file: ModelFile | None, effects_path: Path | None, effects: Sequence[UserEffect]
) -> tuple[Model, tuple[str, ...]]:
    """Read the model, or make a new one where there is no file.

    Returns
    -------
    model : Model
        With a cup for every mount of the samples, where it knows any.
    lines : tuple of str
        They start from what the file holds now, whatever is saved later.

    Raises
    ------
    InputError
        A model that cannot be read, or of another machine.
    """
    own = "" if effects_path is None else f"hx.load_effects({str(effects_path)!r})"
    if file is None or not file.path.exists():
        line = "model = hx.new_model(records[0].machine)" + (f".knowing_effects({own})" if own else "")
        return new_model(samples.machine).knowing_effects(effects), (line,)
    model = file.load(effects)
    lines = [
        f"model = hx.load_model({str(file.path)!r}{', ' + own if own else ''})",
        f"while len(model.ledger) > {len(model.ledger)}:  # the file may hold later steps by now",
        "    model = hx.undo(model)",
    ]
    known, said = fit_mounts(samples, model) if model.mounts else (model, [])
    if said:
        lines += ["from hexdbb.diagnosis import fit_mounts", "", "model, _ = fit_mounts(samples, model)"]
    return known, tuple(lines)
