"""Write cases as the text form that any program can read: `python -m hexdbb_truth.write CASE... -o FOLDER`.

Each case becomes NAME.csv and NAME.toml with its machine, as a stranger's program would write them, and
NAME.truth.toml, which `hexdbb rig --truth` takes as well: the same machine on the bus. What is hidden is printed.
"""

from __future__ import annotations

from pathlib import Path

import click

from hexdbb.errors import InputError
from hexdbb.files.validation import dump_toml
from hexdbb.record import write_record
from hexdbb_truth.cases import Case, case, every


@click.command(help=__doc__)
@click.argument("names", metavar="CASE...", nargs=-1)
@click.option("-o", "--output", type=click.Path(path_type=Path, file_okay=False), help="Folder.")
@click.option("--temperature/--no-temperature", default=None, help="Record a thermometer. [in every second seed]")
@click.option("--suffix", type=click.Choice([".csv", ".parquet"]), default=".csv", help="Form of the records.")
@click.option("--list", "listed", is_flag=True, help="Name all cases and write nothing.")
def main(names: tuple[str, ...], output: Path | None, temperature: bool | None, suffix: str, listed: bool) -> None:
    """Write the records and the truth files of cases."""
    if listed:
        click.echo("\n".join(each.name for each in every()))
        return
    if not names or output is None:
        raise click.UsageError("give cases and -o FOLDER, or --list")
    try:
        cases = [case(name) for name in names]
    except InputError as error:
        raise click.UsageError(str(error)) from None
    output.mkdir(parents=True, exist_ok=True)
    for each in cases:
        write_case(each, output, temperature, suffix)
        click.echo(f"{output / each.name}{suffix}: {described(each)}")


def write_case(each: Case, folder: Path, temperature: bool | None = None, suffix: str = ".csv") -> Path:
    """Write a case's record and its truth; give the record's path."""
    path = folder / f"{each.name}{suffix}"
    write_record(each.record(temperature), path, overwrite=True)
    path.with_suffix(".truth.toml").write_text(dump_toml(each.truth), encoding="utf-8")
    return path


def described(each: Case) -> str:
    """Say what a case hides."""
    return "; ".join(dump_toml(hidden.mechanism).replace("\n", " ").strip() for hidden in each.hidden) or "nothing"


if __name__ == "__main__":
    main()
