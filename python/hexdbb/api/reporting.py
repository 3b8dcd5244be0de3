"""What to hand over: contributions to the circular deviation, and the report."""

from __future__ import annotations

from pathlib import Path

from hexdbb import contributions
from hexdbb.api.analysis import Measured, table_of
from hexdbb.contributions import Contributions
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.machine import Tolerance
from hexdbb.model import Model
from hexdbb.reporting import Report, make_report, require_writer, write_page, write_pdf


def rank_contributions(measured: Measured, model: Model) -> Contributions:
    """Rank every error's part in the circular deviation, in µm and per cent.

    Parameters
    ----------
    measured : Record, sequence of Record, or Samples
    model : Model

    Returns
    -------
    Contributions
        One table for each record; `to_frame`, `to_json`.

    Raises
    ------
    InputError
        Records of another machine, or a sample that the machine cannot reach.
    """
    return contributions.rank_contributions(table_of(measured), model)


def report(
    measured: Measured,
    model: Model,
    output: Path | str | None = None,
    *,
    pdf: Path | str | None = None,
    tolerance: Tolerance | None = None,
    find_cause: bool = True,
    overwrite: bool = False,
) -> Report:
    """Make the report of a circular test, and write it where a file is named: what ``hexdbb report`` does.

    Parameters
    ----------
    measured : Record, sequence of Record, or Samples
        Several records, the earliest first, are compared.
    model : Model
        It stays as it is.
    output : path, optional
        Page to write, one HTML file that holds all it shows.
    pdf : path, optional
        The same on A4; needs the extra ``hexdbb[pdf]``.
    tolerance : Tolerance, optional
        What circles are judged by; that of the machine file where not given.
    find_cause : bool
        Whether the likely cause of a residual beyond noise is looked for.
    overwrite : bool
        Replace existing files.

    Returns
    -------
    Report
        `verdict`, `judged`, `contributions`, `next_steps`; `to_json`.

    Raises
    ------
    InputError
        Records of another machine or one of them twice, an existing file, or no program for PDF.
    RunError
        A file cannot be written.
    """
    for path in (output, pdf):
        if path is not None:
            refuse_existing(Path(path), overwrite)
    if pdf is not None:
        require_writer()
    found = make_report(table_of(measured), model, tolerance=tolerance, find_cause=find_cause)
    if output is not None:
        write_page(found, Path(output))
    if pdf is not None:
        write_pdf(found, Path(pdf))
    return found
