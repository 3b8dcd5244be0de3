"""Polar plots: the magnification is what is drawn, nothing is cut off, files are whole and repeatable."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.text import Text
from tests.python.comparison.made_up import MakeRecord, compared

from hexdbb.charts import choose_scale
from hexdbb.charts.lines import curve, drawn_paths, largest_drawn_mm
from hexdbb.charts.magnification import LARGEST_SHARE_OF_RADIUS, SERIES
from hexdbb.comparison import Comparison
from hexdbb.comparison.iso230 import even_angles, make_path
from hexdbb.errors import RunError
from hexdbb.plots import comparison_pages, save_figure, save_pdf
from hexdbb.plots.labels import Labels
from hexdbb.plots.polar import draw_polar
from hexdbb.plots.style import PAGE_IN, TEXT_PT

RESIDUAL = ["-state", "-directions", "-harmonics"]
"""Pages of the residual, after those of the circles."""


def backlash_off_centre(angle_rad: np.ndarray, direction: int) -> np.ndarray:
    return 0.05 * np.cos(angle_rad) + 0.004 * np.cos(2 * angle_rad) + 0.003 * direction * np.sign(np.sin(angle_rad))


@pytest.fixture
def comparison(make_record: MakeRecord) -> Comparison:
    record = make_record(backlash_off_centre)
    return compared([record], [record.reading_mm - 0.001 * np.sin(np.radians(5.0 * record.columns["angle_deg"]))])


@pytest.fixture
def seven_circles(make_record: MakeRecord) -> Comparison:
    record = make_record(backlash_off_centre, circles=7, feeds=(753.98, 3000.0), laps=2)
    return compared([record], [record.reading_mm - 0.001])


@given(st.floats(20.0, 500.0), st.floats(1e-4, 1.0))
def test_magnification_is_the_largest_of_its_series_that_fits(radius_mm: float, deviation_mm: float) -> None:
    scale = choose_scale(radius_mm, deviation_mm)
    for value in (scale.magnification, scale.division_um):
        mantissa = value / 10.0 ** np.floor(np.log10(value) + 1e-9)
        assert min(abs(mantissa - step) for step in SERIES) < 1e-9
    share = scale.magnification * deviation_mm / radius_mm
    assert share * (1 + 1e-9) > LARGEST_SHARE_OF_RADIUS / 2.5
    assert share <= LARGEST_SHARE_OF_RADIUS * (1 + 1e-9)
    assert scale.divisions * scale.division_um >= 1000.0 * deviation_mm * (1 - 1e-6)
    assert 2 <= scale.divisions <= 5


def test_label_states_division_and_magnification() -> None:
    assert choose_scale(100.0, 0.019).label == "1 division = 5 µm, magnification 2000x"


def test_a_perfect_circle_can_be_drawn() -> None:
    assert np.isfinite(choose_scale(100.0, 0.0).magnification)


def test_one_division_is_drawn_as_long_as_the_magnification_says(comparison: Comparison) -> None:
    (circle,) = comparison.circles
    scale = choose_scale(100.0, largest_drawn_mm([circle]))
    figure = Figure(figsize=(6, 6))
    axes = figure.add_subplot()
    dial = draw_polar(axes, circle, scale, fine=True)
    FigureCanvasAgg(figure).draw()
    up_rad = np.pi / 2.0
    centre, nominal, division = axes.transData.transform(
        dial.places([0.0, 0.0, up_rad], [scale.centre_um, 0.0, scale.division_um])
    )
    division = centre + (division - centre)[::-1]  # as long upwards as to the right
    pixels_per_mm = np.hypot(*(nominal - centre)) / circle.circle.radius_mm
    pixels_per_um = np.hypot(*(division - nominal)) / scale.division_um
    assert 1000.0 * pixels_per_um / pixels_per_mm == pytest.approx(scale.magnification, rel=1e-6)


def test_the_measured_centre_offset_is_removed_from_both_paths(comparison: Comparison) -> None:
    (circle,) = comparison.circles
    assert circle.set_up_centre_mm == pytest.approx([0.05, 0.0], abs=1e-3)
    assert largest_drawn_mm([circle]) < 0.011
    for (_, measured, predicted), part in zip(drawn_paths(circle), circle.directions, strict=True):
        drawn = measured.deviation_mm - predicted.deviation_mm
        assert drawn == pytest.approx(part.measured.deviation_mm - part.predicted.deviation_mm, abs=1e-6)


def test_a_line_closes_a_full_circle_and_breaks_at_a_gap() -> None:
    angles = even_angles(360)
    angle, deviation_um = curve(make_path(angles, 0.001 * np.sin(angles), 100.0))
    assert angle[-1] - angle[0] == pytest.approx(2.0 * np.pi)
    assert deviation_um[-1] == deviation_um[0]
    part = angles[(angles < 1.0) | (angles > 2.0)]
    angle, deviation_um = curve(make_path(part, np.zeros_like(part), 100.0))
    assert np.flatnonzero(np.isnan(deviation_um)) == pytest.approx([np.sum(part < 1.0)])


def test_one_circle_makes_one_page_and_several_a_summary_an_overview_and_each(
    comparison: Comparison, seven_circles: Comparison
) -> None:
    assert [page.suffix for page in comparison_pages(comparison)] == ["", *RESIDUAL]
    assert [page.suffix for page in comparison_pages(seven_circles)] == [
        "",
        "-overview",
        *(f"-circle{k}" for k in range(7)),
        *RESIDUAL,
    ]


def test_pages_of_several_records_do_not_overwrite_each_other(make_record: MakeRecord) -> None:
    records = [make_record(backlash_off_centre, path=Path(name)) for name in ("monday.parquet", "tuesday.csv")]
    pages = comparison_pages(compared(records, [record.reading_mm for record in records]))
    assert [page.suffix for page in pages] == ["", "-overview", "-1-monday-circle0", "-2-tuesday-circle0", *RESIDUAL]
    same = [replace(record, path=Path(day) / "demo.csv") for record, day in zip(records, "ab", strict=True)]
    suffixes = [page.suffix for page in comparison_pages(compared(same, [record.reading_mm for record in same]))]
    assert len(set(suffixes)) == 4 + len(RESIDUAL)


@pytest.mark.parametrize("page", [0, 1, 4, -3, -2, -1])
def test_nothing_is_cut_off(seven_circles: Comparison, page: int) -> None:
    require_all_is_seen(comparison_pages(seven_circles)[page].draw())


def test_long_names_of_variables_fit_above_their_panels(seven_circles: Comparison) -> None:
    named = "guideway 1 position (vertical), growing with time"
    long = [replace(each, variable=named, share=0.5) for each in seven_circles.predictors if each.profiles]
    figure = comparison_pages(replace(seven_circles, predictors=tuple(long)))[-3].draw()
    require_all_is_seen(figure)
    titles = [axes.title.get_window_extent() for axes in figure.axes if axes.get_title()]
    assert len(titles) > 4
    assert not any(one.overlaps(other) for one, other in itertools.combinations(titles, 2))


def test_classes_are_named_below_their_panels(make_record: MakeRecord) -> None:
    record = make_record(backlash_off_centre)
    page = comparison_pages(compared([record], [record.reading_mm - 0.002 * record.columns["direction"]]))[-3].draw()
    FigureCanvasAgg(page).draw()
    panel = next(axes for axes in page.axes if axes.get_title().startswith("direction:"))
    assert [label.get_text() for label in panel.get_xticklabels()] == ["cw", "ccw"]


def not_drawn(figure: Figure) -> set[int]:
    """Return the labels of ticks outside their panel, which matplotlib keeps but does not draw."""
    found = set()
    for axis in (axis for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)):
        low, high = sorted(axis.get_view_interval())
        found |= {id(tick.label1) for tick in axis.get_major_ticks() if not low <= tick.get_loc() <= high}
    return found


def require_all_is_seen(figure: Figure) -> None:
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    width, height = canvas.get_width_height()
    hidden = not_drawn(figure)
    texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    texts = [text for text in texts if id(text) not in hidden]
    every = figure.findobj(Labels)
    labels = [(box, said) for each in every for box, said in zip(each.boxes(), each.texts, strict=True)]
    assert len(texts) + len(labels) > 30  # of fourteen circles each its title and 0°
    for text in texts:
        box = text.get_window_extent()
        assert box.x0 >= 0.0 and box.y0 >= 0.0 and box.x1 <= width and box.y1 <= height, text.get_text()
        assert text.get_fontsize() >= TEXT_PT, text.get_text()
    for box, said in labels:
        assert box.x0 >= 0.0 and box.y0 >= 0.0 and box.x1 <= width and box.y1 <= height, said
    assert all(each.font.get_size() >= TEXT_PT for each in every)
    assert all(has <= most for has, most in zip(figure.get_size_inches(), PAGE_IN, strict=True))


@pytest.mark.parametrize("upright", [False, True])
@pytest.mark.parametrize("ha", ["left", "center", "right"])
@pytest.mark.parametrize("va", ["bottom", "center", "top"])
def test_labels_stand_where_texts_of_matplotlib_would(ha: str, va: str, upright: bool) -> None:
    figure = Figure(dpi=150)
    axes, said = figure.add_subplot(), "-206.41"
    labels = Labels(axes, [(0.4, 0.6)], [said], color="black", ha=ha, va=va, upright=upright)
    text = axes.text(0.4, 0.6, said, ha=ha, va=va, rotation=90.0 if upright else 0.0, size=labels.font.get_size())
    FigureCanvasAgg(figure).draw()
    (box,), other = labels.boxes(), text.get_window_extent()
    # Across the line matplotlib counts the height of its highest and lowest letters, which a number has not.
    along = "y" if upright else "x"
    for end in (f"{along}0", f"{along}1"):
        assert getattr(box, end) == pytest.approx(getattr(other, end), abs=2.0)
    assert other.padded(2.0).contains(*box.min) and other.padded(2.0).contains(*box.max)


def test_files_are_whole_stated_and_repeatable(comparison: Comparison, tmp_path: Path) -> None:
    page = comparison_pages(comparison)[0]
    first, second = (save_figure(page.draw(), tmp_path / name) for name in ("one", "two.v2"))
    assert [path.name for path in first + second] == ["one.png", "one.svg", "two.v2.png", "two.v2.svg"]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(path.name for path in first + second)
    for one, two in zip(first, second, strict=True):
        assert one.read_bytes() == two.read_bytes()
    assert first[0].read_bytes().startswith(b"\x89PNG")
    words = " ".join(ElementTree.parse(first[1]).getroot().itertext())
    for stated in (
        "magnification 5000x",
        "1 division = 2 µm",
        "753.98 mm/min",
        "ISO 230-4:2005",
        "measured, clockwise",
    ):
        assert stated in words


def test_all_pages_make_one_pdf_the_same_each_time(comparison: Comparison, tmp_path: Path) -> None:
    pages = comparison_pages(comparison)
    one, two = (save_pdf((page.draw() for page in pages), tmp_path / name) for name in ("one.pdf", "two.pdf"))
    assert one.read_bytes() == two.read_bytes()
    assert one.read_bytes().startswith(b"%PDF")
    assert len(re.findall(rb"/Type /Page\b", one.read_bytes())) == len(pages) == 1 + len(RESIDUAL)


def test_a_figure_is_laid_out_and_drawn_once(
    seven_circles: Comparison, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Count what takes the time: layouts and drawings of whole figures."""
    counted = {"draw": 0, "layout": 0}

    def counting(name: str, whole: Callable[..., object]) -> Callable[..., object]:
        def called(*args: object, **kwargs: object) -> object:
            counted[name] += 1
            return whole(*args, **kwargs)

        return called

    monkeypatch.setattr(Figure, "draw", counting("draw", Figure.draw))
    monkeypatch.setattr(ConstrainedLayoutEngine, "execute", counting("layout", ConstrainedLayoutEngine.execute))
    figure = comparison_pages(seven_circles)[0].draw()
    save_figure(figure, tmp_path / "a", [".png"])
    save_pdf([figure], tmp_path / "a.pdf")
    assert counted == {"draw": 2, "layout": 0}  # its panels stand in rooms that are known beforehand


def test_long_names_of_records_are_cut_where_bars_need_the_room(make_record: MakeRecord) -> None:
    records = [make_record(backlash_off_centre, path=Path(f"{name * 20}.csv")) for name in ("monday-", "tuesday-")]
    figure = comparison_pages(compared(records, [record.reading_mm for record in records]))[0].draw()
    FigureCanvasAgg(figure).draw()
    bars = max(figure.axes, key=lambda axes: len(axes.patches)).get_window_extent()
    assert bars.width > 0.4 * figure.bbox.width


def test_more_than_a_sheet_holds_goes_on_the_next(make_record: MakeRecord) -> None:
    record = make_record(backlash_off_centre, circles=8, feeds=(500.0, 753.98, 3000.0))
    suffixes = [page.suffix for page in comparison_pages(compared([record], [record.reading_mm]))]
    assert {"-overview", "-overview-2", "-circle7-2", "-directions-2", "-harmonics-2"} <= set(suffixes)
    assert len(set(suffixes)) == len(suffixes)


def test_a_place_that_cannot_be_written_is_named(comparison: Comparison, tmp_path: Path) -> None:
    page = comparison_pages(comparison)[0]
    with pytest.raises(RunError, match=r"absent/demo\.png: cannot be written"):
        save_figure(page.draw(), tmp_path / "absent" / "demo")
