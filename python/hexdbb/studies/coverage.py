"""Whether stated intervals contain the truth: random machines are measured, diagnosed, compared with what they are.

Every value that a diagnosis states an uncertainty of is compared with the truth in stated standard deviations: 95 % of
them should lie within 1.96. Values of one machine are fitted together, so that bounds take machines as clusters.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from scipy import stats

from hexdbb.studies.measured import diagnosed, place_errors, true_values
from hexdbb.studies.rates import Bounded, clustered_share, quantile
from hexdbb.studies.setting import Setting
from hexdbb.studies.study import Case, Result, Row, Sheet, Study, number, percent

LEVEL = 0.95
"""Level of the intervals that a diagnosis is judged by."""
NOTES = (
    "Positions are those of the ball over the workspace, compared after removal of a rigid motion of the base, which a"
    " ball bar cannot measure while the position of the cup is unknown.",
    "The readings of horizontal circles depend on the cup's height to second order only, so that its sign is often not"
    " determined; it then does not count as identifiable.",
)
"""What a reader of the tables must know."""
COLUMNS = pa.schema(
    [
        ("case", pa.int64()),
        ("machine", pa.int64()),
        ("rank", pa.int64()),
        ("effect", pa.list_(pa.string())),
        ("error_sigmas", pa.list_(pa.float64())),
        ("residual_over_noise", pa.float64()),
        ("before_um", pa.float64()),
        ("after_um", pa.float64()),
        ("stated_um", pa.float64()),
    ]
)


def cases(setting: Setting) -> list[Case]:
    """Return one machine a case."""
    return [{"case": case, "machine": setting.number(case)} for case in range(setting.file.cases)]


def row(setting: Setting, case: Case) -> Row:
    """Return how far one machine's values and places are from the truth."""
    truth = setting.machine_of(case["machine"])
    found = diagnosed(truth, setting)
    model, places = found.model, place_errors(truth, setting, found)
    known = ~np.isnan(model.sigma)
    sigmas = (model.values - true_values(truth, model))[known] / model.sigma[known]
    effects = [each.effect for each, is_known in zip(model.parameters(), known, strict=True) if is_known]
    return {
        **case,
        "rank": found.rank,
        "effect": effects,
        "error_sigmas": sigmas.tolist(),
        "residual_over_noise": found.rms_after_um / (found.noise.sigma_mm * 1e3),
        **vars(places),
    }


def covered(rows: Sequence[Row], level: float, effect: str | None = None) -> Bounded:
    """Return the share of intervals of a level that contain the truth, of one effect or of all."""
    within = stats.norm.ppf(0.5 + 0.5 * level)
    of_cases = [_sigmas(each, effect) for each in rows]
    return clustered_share([int(np.sum(np.abs(each) < within)) for each in of_cases], [len(each) for each in of_cases])


def result(setting: Setting, rows: Sequence[Row]) -> Result:
    """Return how often intervals contain the truth, by level and by effect, and what became of places."""
    from hexdbb.studies.coverage_picture import coverage_figure

    levels = sorted({LEVEL, *setting.file.coverage.levels})
    by_level = {level: covered(rows, level) for level in levels}
    effects = sorted({effect for each in rows for effect in each["effect"]})
    by_effect = {effect: covered(rows, LEVEL, effect) for effect in effects}
    answer = (_sentence(by_level[LEVEL], len(rows)),)
    sheets = (
        Sheet(
            "intervals that contain the truth",
            ("interval %", "contain it %", "95 % bounds", "values"),
            tuple((f"{100 * level:g}", *percent(each), str(each.number)) for level, each in by_level.items()),
            names=0,
        ),
        Sheet(
            "95 % intervals by effect",
            ("effect", "contain it %", "95 % bounds", "values"),
            tuple((effect, *percent(each), str(each.number)) for effect, each in by_effect.items()),
        ),
        Sheet("machines, medians", ("quantity", "median", "95 % bounds"), _medians(rows)),
    )
    return Result(
        answer, tuple(each for each in sheets if each.rows), lambda: coverage_figure(by_level, by_effect), NOTES
    )


def _sentence(found: Bounded, machines: int) -> str:
    if not found.number:
        return f"this plan determines no value on its own: no interval to judge on {machines} machines"
    held = "more often than" if found.low > LEVEL else "less often than" if found.high < LEVEL else "as"
    value, bounds = percent(found)
    return (
        f"{value} % of the 95 % intervals contain the truth ({bounds} %), {held} stated:"
        f" {found.number} values of {machines} machines"
    )


def _medians(rows: Sequence[Row]) -> tuple[tuple[str, ...], ...]:
    def median(of: Sequence[float] | NDArray[np.float64]) -> tuple[str, str]:
        return number(quantile(of, 0.5))

    before, after, stated = (np.array([each[key] for each in rows]) for key in ("before_um", "after_um", "stated_um"))
    ranks = ", ".join(str(each) for each in sorted({each["rank"] for each in rows}))
    return (
        ("rank", ranks, "-"),
        ("values with an uncertainty", *median([len(each["effect"]) for each in rows])),
        (
            "largest error, stated standard deviations",
            *median([float(np.abs(_sigmas(each)).max(initial=0.0)) for each in rows]),
        ),
        ("residual over noise", *median([each["residual_over_noise"] for each in rows])),
        ("error of the ball's position, nominal machine, µm", *median(before)),
        ("the same, diagnosed, µm", *median(after)),
        ("the same over its stated standard deviation", *median(after / stated)),
        ("improvement, nominal over diagnosed", *median(before / after)),
    )


def _sigmas(each: Row, effect: str | None = None) -> NDArray[np.float64]:
    sigmas = np.array(each["error_sigmas"], dtype=float)
    return sigmas if effect is None else sigmas[np.array(each["effect"], dtype=object) == effect]


STUDY = Study("coverage", "Do the stated uncertainties cover the truth?", COLUMNS, cases, row, result)
