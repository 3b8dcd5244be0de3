"""Pictures of diagnoses and discoveries: panels in rank order, reversals named, a hue for each direction, causes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.text import Text
from tests.python.comparison.made_up import MakeRecord, compared

from hexdbb.charts.colours import MEASURED_COLOURS, PREDICTED_COLOURS
from hexdbb.diagnosis import diagnose
from hexdbb.discovery import Discovery, discover
from hexdbb.errors import InputError
from hexdbb.model import new_model
from hexdbb.plots import comparison_pages, diagnosis_pages, discovery_pages, residual_figure, save_pages
from hexdbb.plots.labels import Labels
from hexdbb.record import Record
from hexdbb.samples import Samples
from hexdbb_truth.cases import case


def play(angle_rad: np.ndarray, direction: int) -> np.ndarray:
    return 0.003 * direction * np.sign(np.sin(angle_rad))


def reversing(record: Record) -> Record:
    """Let all sliders reverse twice a turn, each at angles of its own."""
    angle = np.radians(record.columns["angle_deg"])
    for k in range(1, 7):
        record.columns[f"s{k}_mm"] = 300.0 + 100.0 * np.sin(angle + 0.5 * k)
    return record


def texts(figure: Figure) -> list[str]:
    return [each.get_text() for each in figure.findobj(Text)]


@pytest.fixture(scope="module")
def found() -> Discovery:
    """Look at a machine whose slider 4 has play."""
    record = case("backlash-x3-s1").record()
    return discover(Samples.of([record]), new_model(record.machine))


def test_panels_stand_in_the_order_of_their_residual(make_record: MakeRecord) -> None:
    samples = Samples.of([reversing(make_record(play, circles=3))])
    residual_mm = 0.001 * (1.0 + samples["circle"] % 2 + 0.1 * samples["circle"])
    figure = residual_figure(samples, residual_mm, title="Residual")
    titles = [axes.get_title() for axes in figure.axes if axes.get_title()]
    assert [each.partition(",")[0] for each in titles] == ["circle 1", "circle 2", "circle 0"]
    limits = [axes.get_ylim() for axes in figure.axes if axes.get_title()]
    assert len(set(limits)) == 3


def test_reversals_bear_the_sliders_numbers(make_record: MakeRecord) -> None:
    samples = Samples.of([reversing(make_record(play))])
    figure = residual_figure(samples, samples.reading_mm, meant=["slider 4"])
    (panel,) = (axes for axes in figure.axes if axes.get_title())
    names = [each for each in panel.get_children() if isinstance(each, Labels)]
    assert {text for each in names for text in each.texts} == {str(k) for k in range(1, 7)}
    assert {text for each in names if each.font.get_weight() == "bold" for text in each.texts} == {"4"}


def test_names_do_not_stand_on_lines_and_nothing_is_cut_off(make_record: MakeRecord) -> None:
    samples = Samples.of([reversing(make_record(play, circles=2))])
    figure = residual_figure(samples, samples.reading_mm, 0.1 * samples.reading_mm)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    width, height = canvas.get_width_height()
    for axes in figure.axes:
        highest = max((float(np.nanmax(line.get_ydata())) for line in axes.lines[:5]), default=0.0)
        top = axes.transData.transform((0.0, highest))[1]
        names = [each for each in axes.get_children() if isinstance(each, Labels)]
        assert bool(names) == bool(axes.get_title())
        for box in (box for each in names for box in each.boxes()):
            assert box.y0 > top and box.x0 >= 0.0 and box.x1 <= width and box.y1 <= height


def test_the_hues_of_the_directions_stand_for_nothing_else(make_record: MakeRecord) -> None:
    record = reversing(make_record(play, laps=2))
    pages = comparison_pages(compared([record], [0.0 * record.reading_mm]))
    hues = {to_hex(each) for each in (*MEASURED_COLOURS.values(), *PREDICTED_COLOURS.values())}
    state, directions = pages[-3].draw(), pages[-2].draw()
    for axes in (*state.axes, *directions.axes):
        named = [line for line in axes.lines if to_hex(line.get_color()) in hues]
        assert {str(line.get_label()) for line in named} <= {"cw", "ccw"}
    panel = next(axes for axes in state.axes if axes.get_title().startswith("angle, each direction"))
    colours = {str(line.get_label()): to_hex(line.get_color()) for line in panel.lines}
    assert colours["ccw"] == to_hex(PREDICTED_COLOURS[1]) and colours["cw"] == to_hex(PREDICTED_COLOURS[-1])


def test_a_discovery_draws_its_cause_and_the_fall_of_the_residual(found: Discovery, tmp_path: Path) -> None:
    pages = discovery_pages(found)
    assert [each.suffix for each in pages] == ["cause-backlash-4", "residual"]
    written = save_pages(pages, tmp_path / "pictures")
    assert {each.name for each in written} == {
        f"{name}{suffix}" for name in ("cause-backlash-4", "residual") for suffix in (".png", ".svg")
    }
    cause, residual = (page.draw() for page in pages)
    assert any(each.startswith("Slider 4 has ") for each in texts(cause))
    function, formula = (line for line in cause.axes[0].lines if len(line.get_xdata()) > 2)
    late = np.asarray(function.get_xdata()) > 1.0
    assert np.asarray(formula.get_ydata())[late] == pytest.approx(np.asarray(function.get_ydata())[late], abs=0.5)
    assert any(each.startswith("Residual before and after backlash:4") for each in texts(residual))


def test_a_diagnosis_draws_its_residual(found: Discovery) -> None:
    pages = diagnosis_pages(diagnose(found.samples, found.base, check_held_out=False))
    assert [each.suffix for each in pages] == ["residual"]
    assert any(each.startswith("Residual of the fitted model: ") for each in texts(pages[0].draw()))


def test_a_folder_that_cannot_be_made_is_refused(found: Discovery, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"absent/pictures: no such directory"):
        save_pages([], tmp_path / "absent" / "pictures")
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match=r"file: is a file \(expected the name of a folder\)"):
        save_pages([], tmp_path / "file")
