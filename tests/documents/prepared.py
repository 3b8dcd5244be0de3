"""What pages take for granted before their first command: records, models, truth files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tests.documents.shown import blocks
from tests.fleet.made import Fleet, write_model
from tests.imports.one_set_up import write_files

from hexdbb.record import write_record
from hexdbb_truth.months import Year

Run = Callable[[str, Path], str]
ROOT = Path(__file__).parents[2]
PLAY = '[[mechanism]]\nkind = "backlash"\nslider = 4\nwidth_um = 15.0\n'
DENT = '[[mechanism]]\nkind = "dent"\nguideway = 1\ndepth_um = 30.0\nat_mm = 250.0\nwidth_mm = 10.0\n'


def _readme(folder: Path, run: Run) -> None:
    """Make the folder that `make demo` makes, with the machine whose commands the page shows in part."""
    (folder / "demo").mkdir()
    _measured(folder, run, DENT, "demo/dent.toml", "demo/dented.parquet")
    run("hexdbb diagnose demo/dented.parquet -m demo/dent-model.toml", folder)


def _measured(folder: Path, run: Run, fault: str, truth: str, record: str) -> None:
    """Measure the random machine of README with a fault: the same commands, hence one measurement for all pages."""
    run(f"hexdbb rig --seed 11 --write-truth {truth} --no-serve", folder)
    with (folder / truth).open("a", encoding="utf-8") as file:
        file.write(f"\n{fault}")
    run(f"hexdbb-run --plan standard --rate 20 --truth {truth} -o {record}", folder)


def _today(folder: Path, run: Run) -> None:
    _measured(folder, run, PLAY, "hidden.toml", "today.parquet")


def _diagnosed(folder: Path, run: Run) -> None:
    _today(folder, run)
    run("hexdbb diagnose today.parquet -m model.toml", folder)


def _discovery(folder: Path, run: Run) -> None:
    """Add the effect that the page shows as a file, and a machine with the fault that it describes."""
    _diagnosed(folder, run)
    (folder / "mine.py").write_text(_block("docs/discovery.md", "python"), encoding="utf-8")
    _measured(folder, run, DENT, "dented.toml", "dent.parquet")
    run("hexdbb diagnose dent.parquet -m dent.toml", folder)


def _compensation(folder: Path, run: Run) -> None:
    """Return the model, the nominal model and a path of two poses."""
    _diagnosed(folder, run)
    run("hexdbb add backlash:4 -m model.toml today.parquet", folder)
    run("hexdbb model new sp120 -o nominal.toml --effects none", folder)
    run("hexdbb-run --plan thesis --rate 20 --truth hidden.toml -o before.parquet", folder)
    poses = "x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg\n0,0,260,0,0,0\n10,0,260,0,0,0\n"
    (folder / "path.csv").write_text(poses, encoding="utf-8")


def _report(folder: Path, run: Run) -> None:
    """Measure a machine, and another in its place; diagnose the first."""
    run("hexdbb-run --plan thesis --rate 10 --seed 11 -o before.parquet", folder)
    run("hexdbb-run --plan thesis --rate 10 --seed 12 -o after.parquet --note 'the other machine'", folder)
    run("hexdbb diagnose before.parquet -m model.toml", folder)


def _planning(folder: Path, run: Run) -> None:
    """Link the pages' plans, which commands name from the project's folder."""
    (folder / "docs").symlink_to(ROOT / "docs")


def _measuring(folder: Path, run: Run) -> None:
    """Put the shipped EDS files where the page supposes the reader's."""
    for name, source in (("drive.eds", "hexglider_drive.eds"), ("gauge.eds", "ballbar_gauge.eds")):
        (folder / name).write_bytes((ROOT / "firmware_interfaces" / source).read_bytes())


def _logbook(folder: Path, run: Run) -> None:
    """Write a year's records, and the limits that the page shows."""
    for number, record in enumerate(Year(5).records(), start=1):
        write_record(record, folder / f"2025-{number:02}.parquet")
    (folder / "watch.toml").write_text(f"\n{_block('docs/logbook.md', 'toml')}", encoding="utf-8")


def _fleet(folder: Path, run: Run) -> None:
    """Write the records of nine machines, and the model that the page fits to them."""
    fleet = Fleet(machines=9, records=54)
    for number in range(fleet.records):
        fleet.write(folder / "records", number)
    write_model(folder / "model.toml")


def _how_to_embed(folder: Path, run: Run) -> None:
    run("hexdbb model new sp120 -o model.toml --effects leg_length", folder)


def _how_to_judge(folder: Path, run: Run) -> None:
    """Write a measurement in text form, as another program would."""
    run("hexdbb-run --plan thesis --rate 10 --seed 11 -o measured.parquet", folder)
    run("hexdbb convert measured.parquet my-readings.csv", folder)


def _simulated_rig(folder: Path, run: Run) -> None:
    """Write the truth file that the page shows."""
    (folder / "truth.toml").write_text(_block("docs/simulated-rig.md", "toml"), encoding="utf-8")


def _import(folder: Path, run: Run) -> None:
    """Put the files of other programs where the page supposes the reader's."""
    files = {
        "messung.csv": "german.csv",
        "tests.xlsx": "dates.xlsx",
        "test.b5r": "test.b5r",
        "export.csv": "mm_as_um.csv",
    }
    for name, source in files.items():
        (folder / name).write_bytes((ROOT / "tests" / "data" / "imports" / source).read_bytes())
    write_files(folder, with_mapping=True)


def _thesis_tables(folder: Path, run: Run) -> None:
    run("hexdbb-run --plan thesis -o demo.parquet", folder)


def _block(page: str, language: str) -> str:
    """Return the first block of a page in some language."""
    return blocks(ROOT / page, language)[0]


PREPARED: dict[str, Callable[[Path, Run], None]] = {
    "README.md": _readme,
    "docs/compensation.md": _compensation,
    "docs/discovery.md": _discovery,
    "docs/import.md": _import,
    "docs/how-to-embed.md": _how_to_embed,
    "docs/how-to-judge.md": _how_to_judge,
    "docs/how-to-measure.md": _measuring,
    "docs/ledger.md": _today,
    "docs/fleet.md": _fleet,
    "docs/logbook.md": _logbook,
    "docs/planning.md": _planning,
    "docs/measuring.md": _measuring,
    "docs/report.md": _report,
    "docs/simulated-rig.md": _simulated_rig,
    "docs/thesis-tables.md": _thesis_tables,
}
