"""Pictures of a diagnosis and of a discovery: the residual circle by circle, and the form of every cause."""

from __future__ import annotations

from functools import partial

from matplotlib.figure import Figure

from hexdbb.comparison import UM_PER_MM
from hexdbb.diagnosis import Diagnosis
from hexdbb.discovery import Cause, Discovery, form_of
from hexdbb.discovery.likely import subjects_of
from hexdbb.discovery.words import SMALLEST_DEVIATION, percent
from hexdbb.files.plain_text import capital
from hexdbb.plots.learned import learned_figure
from hexdbb.plots.residual_circles import residual_figure
from hexdbb.plots.saving import Page
from hexdbb.samples import predict


def discovery_pages(found: Discovery) -> list[Page]:
    """List the pictures of a discovery: each cause that is a function of a variable, then the residual."""
    pages = []
    for cause in found.causes:
        form = form_of(found, cause)
        if form is not None:
            title = _form_title(found, cause) if form.formula else ""
            drawn = partial(learned_figure, form.model, form.name, form.formula, title)
            pages.append(Page(f"cause-{_in_a_file_name(cause.choice)}", drawn))
    return [*pages, Page("residual", partial(_residual, found))]


def diagnosis_pages(found: Diagnosis) -> list[Page]:
    """List the pictures of a diagnosis: the residual of the fitted model, and its learned effects."""
    noise_um = UM_PER_MM * found.noise.sigma_mm
    title = f"Residual of the fitted model: {found.rms_after_um:.2f} µm RMS, noise {noise_um:.2f} µm"
    residual = Page("residual", partial(residual_figure, found.samples, found.residual_mm, title=title))
    names = [term.effect for term in found.model.learned]
    return [residual, *(Page(_in_a_file_name(each), partial(learned_figure, found.model, each)) for each in names)]


def _form_title(found: Discovery, cause: Cause) -> str:
    """Return a known cause in words, and how far its form is off where the readings show that it is."""
    shows = found.remaining is not None and found.remaining.is_significant
    off = f"; its form differs from the formula by {percent(cause.form_deviation)} of its size"
    return capital(cause.clause) + (off if shows and cause.form_deviation >= SMALLEST_DEVIATION else "")


def _residual(found: Discovery) -> Figure:
    before_mm = predict(found.samples, found.base).residual_mm
    if not found.causes:
        return residual_figure(found.samples, before_mm, title="Residual of the model")
    with_all = found.learned or found.model
    after_mm = None if with_all is found.base else predict(found.samples, with_all).residual_mm
    meant = [each for cause in found.causes for each in subjects_of(cause, with_all)]
    return residual_figure(found.samples, before_mm, after_mm, _title(found.causes), meant)


def _title(causes: tuple[Cause, ...]) -> str:
    return f"Residual before and after {' + '.join(each.choice for each in causes)}"


def _in_a_file_name(effect: str) -> str:
    """Return an effect's name as a part of a file's: numbers of instants, or of two states, are parted by slashes."""
    return effect.replace(":", "-").replace("/", "-")
