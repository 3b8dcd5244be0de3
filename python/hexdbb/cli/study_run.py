"""A study run and reported: progress, tables, picture, plans found, page."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from hexdbb.cli.cluster_options import shown_progress, summary_text
from hexdbb.cli.consoles import message_console, say
from hexdbb.cli.plan_tables import print_table
from hexdbb.cluster import ClusterOptions
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import write_text
from hexdbb.machine import SHIPPED_MACHINE, MachineFile, shipped
from hexdbb.plan import Plan, save_plan
from hexdbb.studies.kinds import study_named
from hexdbb.studies.page import study_page
from hexdbb.studies.running import run_study
from hexdbb.studies.setting import Setting
from hexdbb.studies.study import Result


@dataclass(frozen=True)
class Asked:
    """Options of every study.

    Attributes
    ----------
    output : str
        Folder of the cases, local or a URL.
    picture, page : Path or None
        Files to write.
    command : str
        The command line.
    cluster : ClusterOptions
    again : bool
        Whether cases that failed are run again.
    """

    output: str
    picture: Path | None
    page: Path | None
    command: str
    cluster: ClusterOptions
    again: bool

    @property
    def stem(self) -> Path:
        """Where files beside the results begin: the folder's name, in its own folder, here where it is a URL."""
        if "://" in self.output:
            return Path(self.output.rstrip("/").rpartition("/")[2])
        return Path(os.path.relpath(self.output))

    @property
    def picture_path(self) -> Path:
        """The picture: as asked for, else in the page's folder of pictures, else beside the results."""
        if self.picture is not None:
            return self.picture
        if self.page is not None:
            return self.page.parent / "images" / f"{self.page.stem}.png"
        return _added(self.stem, ".png")


def run_and_report(name: str, setting: Setting, asked: Asked) -> None:
    """Run a study, print what it says, and write picture, plans and page.

    Raises
    ------
    InputError, RunError
        As `run_study`; a folder to write to is not there.
    """
    _require_places(asked)
    study, messages = study_named(name), message_console()
    say(f"{study.question} {setting.file.cases} cases", err=True)

    def tell(line: str) -> None:
        messages.print(line, markup=False, soft_wrap=True)

    with shown_progress(messages) as progress:
        ran = run_study(study, setting, asked.output, asked.cluster, tell=tell, progress=progress, again=asked.again)
    say(summary_text(ran.summary), err=True)
    for error, count in ran.failed.items():
        say(f"{count} cases failed: {error} (--again runs them again)", err=True)
    say(f"cases: {asked.output}", err=True)

    def page(picture: str) -> str:
        if study.page is not None:
            return study.page(ran.rows, sum(ran.failed.values()), picture, asked.command)
        return study_page(study.question, setting, ran.result, picture, asked.command)

    report(ran.result, asked, page)
    _write_plans(ran.result, setting.machine, asked)


def report(result: Result, asked: Asked, page: Callable[[str], str]) -> None:
    """Print a result, draw it, and write its page where one is asked for; `page` makes it of the picture's link."""
    from hexdbb.plots import save_figure  # matplotlib takes a second to import

    _require_places(asked)
    for sheet in result.sheets:
        print_table(sheet.head, sheet.rows, title=sheet.title, names=sheet.names)
    for sentence in result.answer:
        say(sentence)
    path = asked.picture_path
    path.parent.mkdir(exist_ok=True)
    save_figure(result.draw(), path.with_suffix(""), (".png",))
    say(f"picture: {path}", err=True)
    if asked.page is not None:
        write_text(asked.page, page(Path(os.path.relpath(path, asked.page.parent)).as_posix()))
        say(f"page: {asked.page}", err=True)


def _write_plans(result: Result, machine: MachineFile, asked: Asked) -> None:
    for name, plan in result.plans.items():
        path = _added(asked.stem, f"-{name}.toml")
        save_plan(_beside(plan, machine, path), path, f"The best of {name}; found by {asked.command}.")
        say(f"plan: {path}", err=True)


def _added(stem: Path, ending: str) -> Path:
    """Return a path with an ending; that of the folder one is in lies beside it."""
    named = stem if stem.name else stem.absolute()
    return named.with_name(f"{named.name}{ending}")


def _beside(plan: Plan, machine: MachineFile, path: Path) -> Plan:
    """Return a plan that refers to its machine as a file at a path does."""
    if machine.path is None or machine.path == shipped(f"{SHIPPED_MACHINE}.toml"):
        return plan.model_copy(update={"machine": SHIPPED_MACHINE})
    relative = Path(os.path.relpath(machine.path, path.parent)).as_posix()
    return plan.model_copy(update={"machine": relative})


def _require_places(asked: Asked) -> None:
    """Check before the work that what is written afterwards can be: no case is to be run in vain."""
    if asked.picture_path.suffix != ".png":
        raise InputError(f"--picture {asked.picture_path}: no PNG (expected a name that ends in .png)")
    # The folder of a page's pictures is made beside it.
    for path in (asked.page, asked.picture if asked.picture or asked.page else asked.picture_path):
        if path is not None and not path.parent.is_dir():
            raise InputError(f"{path}: no such directory {path.parent} (expected one that exists)")
