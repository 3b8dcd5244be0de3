"""`hexdbb log`: the logbook of a machine: add files, list and show them, check the folder."""

from __future__ import annotations

import json
from pathlib import Path

import click
from rich.table import Table

from hexdbb.cli.consoles import message_console, output_console, say
from hexdbb.cli.import_options import OF_RECORDS, import_options, pointing_to_convert, wanted_mapping
from hexdbb.cli.shared_options import json_option
from hexdbb.cli.trend import command as trend_command
from hexdbb.errors import RunError
from hexdbb.importing import Mapping, read_measured
from hexdbb.logbook import FOLDERS, SHORT, Entry, Logbook, check, content_of
from hexdbb.logbook.json_form import log_json
from hexdbb.record import Record, read_record

folder_argument = click.argument("folder", metavar="FOLDER", type=click.Path(path_type=Path))


@click.group("log")
def command() -> None:
    """Keep the logbook of a machine: records, models, verdicts and compensation files in one folder.

    Every file is kept once, under the hash of its content; FOLDER/machine.toml holds the machine and the limits of its
    trend, FOLDER/logbook.sqlite the index.

    \b
    Examples:
      hexdbb log add glider monday.parquet model.toml
      hexdbb log list glider
      hexdbb log show glider 4f1c
      hexdbb log trend glider
      hexdbb log check glider
    """


@command.command("add")
@folder_argument
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=click.Path(path_type=Path))
@import_options(OF_RECORDS)
@click.option("--date", help="When FILE was measured or made, where it does not say: 2026-03-01 or 2026-03-01T08:30.")
def add(folder: Path, files: tuple[Path, ...], date: str | None) -> None:
    """Add FILE... to the logbook in FOLDER, which is made where there is none, for the machine of the first FILE.

    A file is a record, readings of another program (as of hexdbb convert), a model, what a command printed with --json,
    or a compensation file. The same content added twice is one entry. A file of another machine is refused.

    \b
    Examples:
      hexdbb log add glider monday.parquet
      hexdbb log add glider old.csv --date 2025-03-01
      hexdbb log add glider front.csv side.csv --plan plan.toml --mount march --date 2026-03-01
      hexdbb discover monday.parquet -m model.toml --json > verdict.json; hexdbb log add glider verdict.json
    """
    messages = message_console()
    wanted = wanted_mapping() or Mapping()

    def tell(line: str) -> None:
        messages.print(line, markup=False, highlight=False, soft_wrap=True)

    def read(path: Path) -> Record:
        with pointing_to_convert(path):
            return read_measured(path, wanted, tell)

    for path in files:
        with messages.status(f"reading {path}"):
            # Without a name of the set-up a Parquet record is kept as it is, byte by byte.
            own = path.suffix == ".parquet" and wanted.mount is None
            content = content_of(path) if own else content_of(path, read=read)
            if content.machine is not None:
                logbook = Logbook.of(folder, content.machine)
            else:
                logbook = Logbook(folder)
                content = content_of(path, logbook.machine)
            added = logbook.add_content(content, date)
        entry = added.entry
        where = f"{entry.kind} {entry.sha256[:SHORT]}, {entry.measured[:10]}"
        if added.is_new:
            say(f"{path}: added to {folder}: {where}")
        elif added.is_back:
            say(f"{path}: in {folder} already, its missing file is back: {where}")
        else:
            say(f"{path}: in {folder} already, added as {entry.name} on {entry.added[:10]}: {where}")
        if wanted.mount is not None and not added.is_new and content.record is not None:
            _say_kept_set_up(path, read_record(logbook.path_of(entry)), wanted.mount)


def _say_kept_set_up(path: Path, kept: Record, given: str) -> None:
    """Print a note where a record in the logbook has another set-up than the one given now: it keeps its own."""
    names = {mount.fixing for mount in kept.mounts}
    if names != {given}:
        name = ", ".join(f'"{each}"' for each in names if each is not None) or "a set-up of its own"
        kept_as = f"keeps {name} (--mount {given}: nothing in a logbook is written twice)"
        message_console().print(f"note: {path}: {kept_as}", markup=False, highlight=False, soft_wrap=True)


@command.command("list")
@folder_argument
@click.option("--kind", type=click.Choice(list(FOLDERS)), help="Entries of one kind only.")
@json_option
def list_entries(folder: Path, kind: str | None, as_json: bool) -> None:
    """List the entries of the logbook in FOLDER, in the order of their times.

    \b
    Examples:
      hexdbb log list glider
      hexdbb log list glider --kind record --json
    """
    logbook = Logbook(folder)
    entries = logbook.entries(kind)
    loose = logbook.loose()
    if loose:
        message_console().print(f"note: {loose[0]}: not in the index ({len(loose)} such): hexdbb log check {folder}")
    if as_json:
        say(json.dumps(log_json(logbook, entries).to_json(), indent=2, allow_nan=False))
        return
    if not entries:
        say(f"{folder}: no entry yet")
        return
    table = Table(box=None, header_style="", pad_edge=False)
    for heading in ("measured", "kind", "hash", "name", "what"):
        table.add_column(heading)
    for each in entries:
        missing = "" if logbook.path_of(each).is_file() else " (file missing: hexdbb log check)"
        table.add_row(
            each.measured[:16].replace("T", " "), each.kind, each.sha256[:SHORT], each.name, _what(each) + missing
        )
    output_console().print(table)


@command.command("show")
@folder_argument
@click.argument("entry", metavar="ENTRY")
@json_option
def show(folder: Path, entry: str, as_json: bool) -> None:
    """Show one entry of the logbook in FOLDER: ENTRY is the beginning of its hash, or the name of the file added.

    \b
    Examples:
      hexdbb log show glider 4f1c
      hexdbb diagnose "$(hexdbb log show glider 4f1c --json | jq -r '.entries[0].path')" -m model.toml
    """
    logbook = Logbook(folder)
    found = logbook.entry(entry)
    if as_json:
        say(json.dumps(log_json(logbook, [found]).to_json(), indent=2, allow_nan=False))
        return
    facts = {
        key: ", ".join(map(str, value)) if isinstance(value, list) else value for key, value in found.facts.items()
    }
    rows = {"kind": found.kind, "name": found.name, "sha256": found.sha256, "measured": found.measured}
    for key, value in {**rows, "added": found.added, "file": logbook.path_of(found), **facts}.items():
        say(f"{key:12} {value}")


@command.command("check")
@folder_argument
def check_folder(folder: Path) -> None:
    """Check the logbook in FOLDER and repair what can be: every file is read.

    Files that the index does not name are entered; an index that is missing or damaged is made anew; entries whose file
    is missing are named and stay. Exit status 1 where something is left to do.

    \b
    Example:
      hexdbb log check glider
    """
    logbook = Logbook(folder)
    messages = message_console()
    with messages.status("checking") as status:
        findings = check(logbook, lambda name: status.update(f"checking {name}"))
    for each in findings:
        say(f"{'repaired' if each.repaired else 'LEFT'}: {each.what}")
    left = sum(not each.repaired for each in findings)
    if left:
        raise RunError(f"{folder}: {left} of {len(findings)} findings cannot be repaired (see above)")
    say(f"{folder}: {len(logbook.entries())} entries, all whole")


command.add_command(trend_command, "trend")


def _what(entry: Entry) -> str:
    facts = entry.facts
    if entry.kind == "record":
        plan = f"plan {facts['plan']}, " if facts.get("plan") else ""
        return f"{plan}{facts.get('samples', 0)} samples" + ("" if facts.get("complete", True) else ", incomplete")
    if entry.kind == "model":
        return f"{len(facts.get('effects', ()))} effects, {facts.get('steps', 0)} steps"
    return str(facts.get("sentence") or facts.get("verdict") or facts.get("schema") or facts.get("name") or "")
