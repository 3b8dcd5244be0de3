"""Why does the machine err? Prediction, diagnosis, comparison and discovery of records."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from hexdbb import comparison, discovery, ledger
from hexdbb.comparison import Comparison
from hexdbb.diagnosis import Diagnosis
from hexdbb.discovery import AutoStep, Discovery, Draft
from hexdbb.files.atomic_file import write_text
from hexdbb.model import Model
from hexdbb.record import Record
from hexdbb.samples import Prediction, Samples
from hexdbb.samples import predict as predict_samples

Measured = Record | Sequence[Record] | Samples
"""One record, several of one machine, or the table made of them."""


def table_of(measured: Measured) -> Samples:
    """Return the table of samples of one or several records; a table is returned as it is.

    Raises
    ------
    InputError
        No record, or records of different machines.
    """
    if isinstance(measured, Samples):
        return measured
    return Samples.of([measured] if isinstance(measured, Record) else list(measured))


def predict(measured: Measured, model: Model) -> Prediction:
    """Compute the readings a model predicts.

    Parameters
    ----------
    measured : Record, sequence of Record, or Samples
        Of the model's machine; the model knows their mounts (`diagnose` makes it so), or none at all.
    model : Model

    Returns
    -------
    Prediction
        `reading_mm` and `residual_mm` of shape (n,), `rms_um`.

    Raises
    ------
    InputError
        Another machine, an unknown mount, or a sample that the machine cannot reach.
    """
    return predict_samples(table_of(measured), model)


def diagnose(measured: Measured, model: Model, *, robust: bool = False) -> Diagnosis:
    """Fit a model's free values to measured readings.

    Parameters
    ----------
    measured : Record, sequence of Record, or Samples
    model : Model
        `hexdbb.new_model(record.machine)` has the thesis' 33 geometric errors and the set-up free.
    robust : bool
        Weight outliers of the gauge down.

    Returns
    -------
    Diagnosis
        `model` with values, uncertainties and one more step in its ledger; errors before and after; sentences on what
        cannot be identified.

    Raises
    ------
    InputError
        Another machine, or nothing free to fit.
    RunError
        The fit did not end in a usable solution.
    """
    return ledger.fit_model(table_of(measured), model, robust=robust)


def compare(measured: Measured, model: Model | None = None, *, find_cause: bool = True) -> Comparison:
    """Compare measured readings with those a model predicts: all that ``hexdbb compare`` prints.

    Without a model they are compared with the commanded circles.

    Parameters
    ----------
    measured : Record, sequence of Record, or Samples
        The cup of a mount that the model does not know is fitted first, which is stated.
    model : Model, optional
    find_cause : bool
        Whether the likely cause of the residual is looked for, where that is more than noise: two or three seconds for
        20,000 readings.

    Returns
    -------
    Comparison
        Likely cause of the residual, ISO 230-4 quantities for each circle, feed and direction, worst places, predictors
        of the residual.
    """
    if model is None:
        return comparison.compare_commanded(table_of(measured))
    return comparison.compare(table_of(measured), model, find_cause=find_cause)


def discover(
    measured: Measured,
    model: Model,
    candidates: Sequence[str] | None = None,
    progress: Callable[[str], None] = lambda _: None,
    *,
    matters_um: float | None = None,
    known_only: bool = False,
) -> Discovery:
    """Decide whether anything is missing from a model, and which physical effect it is.

    Parameters
    ----------
    measured : Record, sequence of Record, or Samples
    model : Model
    candidates : sequence of str, optional
        Known effects to try, beside what is learned from the readings; all that are not in the model where not given.
    progress : callable
        Called with what is being done.
    matters_um : float, optional
        Unexplained RMS, µm, below which nothing is missing that matters; a quarter of the noise, or a thousandth of
        the reading error that the model explains, where not given.
    known_only : bool
        Try known effects alone, in a fraction of the time: what none of them explains is not learned.

    Returns
    -------
    Discovery
        `verdict`, `sentence`, `causes`, `candidates`; `best.choice` is what `add_effect` takes.

    Raises
    ------
    InputError
        Too few readings or sweeps.
    RunError
        The model itself cannot be fitted.
    """
    samples = table_of(measured)
    return discovery.discover(samples, model, candidates, progress, matters_um=matters_um, known_only=known_only)


def discover_all(
    measured: Measured,
    model: Model,
    progress: Callable[[str], None] = lambda _: None,
    *,
    matters_um: float | None = None,
    forms: bool = False,
) -> Iterator[AutoStep | Discovery]:
    """Add missing effects one by one until nothing is missing; yield every step, last of all the final verdict.

    With `forms`, functions that describe how the machine's forms differ from the effects' are added as well.
    """
    return discovery.discover_all(table_of(measured), model, progress=progress, matters_um=matters_um, forms=forms)


def draft_effect(found: Discovery, output: Path | str | None = None, *, overwrite: bool = False) -> Draft:
    """Write the main cause of a discovery, if it is learned, as an effect of your own, ready to be given its physics.

    Parameters
    ----------
    found : Discovery
        As `discover` returns it. Where its main cause is a known effect, the best learned function that was tried takes
        its place, which `Draft.sentence` states.
    output : path, optional
        File to write, ``NAME.py``, as `load_effects` and ``--effects`` take it; none where not given.
    overwrite : bool
        Replace an existing file.

    Returns
    -------
    Draft
        `source` is the file's text, `name` the learned effect.

    Raises
    ------
    InputError
        The file exists already, or has another suffix.
    RunError
        Nothing is missing, or no learned function was tried.
    """
    if output is not None:
        discovery.require_draftable(Path(output), overwrite)
    drafted = discovery.draft_effect(found)
    if output is not None:
        write_text(Path(output), drafted.source)
    return drafted


def add_effect(measured: Measured, model: Model, choice: str, *, robust: bool = False) -> Diagnosis:
    """Add an effect to a model and fit everything that is free.

    Parameters
    ----------
    measured : Record, sequence of Record, or Samples
    model : Model
    choice : str
        ``pitch_cyclic``, ``backlash:4``, ``backlash:2:4``: an effect, or some of its elements.
    robust : bool
        Weight outliers of the gauge down.

    Returns
    -------
    Diagnosis
        `model` has the effect and one more step in its ledger; `undo` takes it back.

    Raises
    ------
    InputError
        An effect or element that is not known, or is in the model.
    RunError
        The fit did not end in a usable solution.
    """
    return ledger.add_effect(table_of(measured), model, choice, robust=robust)


def remove_effect(measured: Measured, model: Model, choice: str, *, robust: bool = False) -> Diagnosis:
    """Remove an effect, or some of its elements, from a model and fit the rest; see `add_effect`."""
    return ledger.remove_effect(table_of(measured), model, choice, robust=robust)


def preview_effect(measured: Measured, model: Model, *choices: str) -> Model:
    """Return a model with some effects more, fitted, to be looked at before any is added; the ledger stays as it is.

    Parameters
    ----------
    measured : Record, sequence of Record, or Samples
    model : Model
    choices : str
        As `add_effect` takes them, together.

    Raises
    ------
    InputError
        As `add_effect`.
    RunError
        The fit did not end in a usable solution.
    """
    return ledger.preview_effect(table_of(measured), model, *choices)
