"""`hexdbb study`: many simulated machines measured, to answer what a test can do before it is done."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from hexdbb.cli.cluster_options import cluster_options
from hexdbb.cli.study_options import setting_options
from hexdbb.cli.study_run import Asked, report, run_and_report
from hexdbb.studies.kinds import KINDS
from hexdbb.studies.setting import Setting

picture_option: Callable[[Any], Any] = click.option(
    "--picture",
    "picture_path",
    metavar="FILE.png",
    type=click.Path(path_type=Path),
    help="Picture to write, replacing an existing one.  [default: beside the results]",
)
page_option: Callable[[Any], Any] = click.option(
    "--page",
    "page_path",
    metavar="FILE.md",
    type=click.Path(path_type=Path),
    help="Write the result as a page too, its picture in images/ beside it.",
)


@click.group("study")
def command() -> None:
    """Simulate many machines whose errors are known, measure and judge each, and state what comes of it.

    STUDY is a study file (docs/studies.md) or the shipped one, standard; options replace its keys. Every case is kept
    in a Parquet dataset; what is done is not done again, so that a run can be stopped, continued, or made larger.

    \b
    Examples:
      hexdbb study coverage
      hexdbb study power --effect backlash --effect pitch_cyclic --plan my-plan.toml
      hexdbb study tolerance my-study.toml --target 2 --cases 1000 --workers 8
    """


def _common(name: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Return what makes a function the command of a study: its arguments, options and name."""

    def decorated(function: Callable[..., Any]) -> Callable[..., Any]:
        made = click.option("--again", is_flag=True, help="Run cases that failed again.")(cluster_options(function))
        made = page_option(picture_option(made))
        made = click.option(
            "-o",
            "--output",
            metavar="URL",
            default=f"{name}-study",
            show_default=True,
            help="Folder of the cases, local or at any URL of fsspec.",
        )(made)
        return command.command(name, short_help=KINDS[name])(setting_options(made))

    return decorated


@_common("power")
@click.option("--effect", "effects", multiple=True, help="Effect to hide; repeated for several.")
@click.option("--known-only", is_flag=True, help="Search known effects alone: faster, nothing is learned.")
def power(setting: Callable[..., Setting], effects: tuple[str, ...], known_only: bool, **asked: Any) -> None:
    """State which sizes of which effects a plan finds on a machine, and how often a false name is given.

    Faults of known sizes are hidden in random machines, which are measured on the plan and judged as by `hexdbb
    discover`. The size that is named in 50 % and in 95 % of the machines is stated with 95 % bounds.

    \b
    Examples:
      hexdbb study power
      hexdbb study power --plan standard --noise 1.0 --effect backlash --cases 400
    """
    changes: dict[str, Any] = {"effects": list(effects)} if effects else {}
    if known_only:
        changes["learned"] = False
    run_and_report("power", setting(power=changes), _asked(**asked))


@_common("coverage")
def coverage(setting: Callable[..., Setting], **asked: Any) -> None:
    """State in how many machines the 95 % intervals of a diagnosis contain the truth.

    \b
    Examples:
      hexdbb study coverage
      hexdbb study coverage --plan my-plan.toml --cases 1000 --page uncertainty.md
    """
    run_and_report("coverage", setting(), _asked(**asked))


@_common("verdicts")
@click.option("--half", type=click.Choice(["calibrate", "judge"]), help="Half of the forms.")
@click.option(
    "--lines",
    "lines_path",
    metavar="FILE.jsonl",
    type=click.Path(path_type=Path),
    help="Report results that were kept as lines of JSON; nothing is run.",
)
def verdicts(setting: Callable[..., Setting], half: str | None, lines_path: Path | None, **asked: Any) -> None:
    """State how often verdicts are right, on faults whose forms are not the catalogue's.

    What a fault pushes is 0 to 20 % off its formula; faults that the catalogue does not have, pairs, triples and clean
    machines are among the cases, and cases whose true effect is withheld. A case takes 2 to 20 s.

    \b
    Examples:
      hexdbb study verdicts --cases 500
      hexdbb study verdicts --cases 2000 --page discovery-calibration.md --scheduler tcp://10.0.0.5:8786
    """
    options = _asked(**asked)
    if lines_path is None:
        run_and_report("verdicts", setting(verdicts={} if half is None else {"half": half}), options)
        return
    from hexdbb.studies.verdicts.page import page
    from hexdbb.studies.verdicts.result import read_lines, result_of

    lines = read_lines(lines_path)
    report(result_of(lines), options, lambda picture: page(lines, 0, picture, options.command))


@_common("plan")
@click.option("--circles", type=int, multiple=True, help="Number of circles; repeated for several.")
@click.option("--criterion", type=click.Choice(["D", "minmax"]), help="What a search maximises.")
@click.option("--mounts", type=int, help="Largest number of cup positions.")
def plan(
    setting: Callable[..., Setting],
    circles: tuple[int, ...],
    criterion: str | None,
    mounts: int | None,
    **asked: Any,
) -> None:
    """Search for the circles that determine most, from many grids of candidates drawn at random.

    Each case is one search of some hundred circles, as `hexdbb plan propose` does it. The best plan of each number of
    circles is written beside the results, ready for `hexdbb plan check` and `hexdbb-run`.

    \b
    Examples:
      hexdbb study plan --circles 5 --circles 7
      hexdbb study plan --machine mine.toml --plan my-plan.toml --cases 300
    """
    changes = {"circles": list(circles) or None, "criterion": criterion, "mounts": mounts}
    run_and_report("plan", setting(plan_search=_given(changes)), _asked(**asked))


@_common("tolerance")
@click.option("--target", "target_um", type=float, help="Error of the compensated machine that is asked for, µm.")
def tolerance(setting: Callable[..., Setting], target_um: float | None, **asked: Any) -> None:
    """State how good gauge, repeatability and set-up must be for a machine to meet a target once compensated.

    \b
    Examples:
      hexdbb study tolerance --target 1
      hexdbb study tolerance my-study.toml --cases 2000
    """
    run_and_report("tolerance", setting(tolerance=_given({"target_um": target_um})), _asked(**asked))


def _given(changes: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in changes.items() if value is not None}


def _asked(output: str, picture_path: Path | None, page_path: Path | None, **others: Any) -> Asked:
    made_by = shlex.join(["hexdbb", *sys.argv[1:]])
    return Asked(output=output, picture=picture_path, page=page_path, command=made_by, **others)
