"""The command `hexdbb-run`: drive the circles of a plan and record them, on a real bus or on a simulated rig."""

from __future__ import annotations

import logging
import sys
import time
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import click
from rich.console import Console

from hexdbb import __version__
from hexdbb.capture import Interrupts
from hexdbb.capture.buses import SimulatedRig, opened_bus, running_clock
from hexdbb.capture.display import LIVE_PERIOD_S, display
from hexdbb.capture.request import Request, RunProgress, prepare
from hexdbb.capture.session import measure
from hexdbb.capture.setup import Confirm
from hexdbb.cli.consoles import drop, run_console
from hexdbb.cli.exits import Program, reports_errors, unwritable
from hexdbb.cli.run_conditions import conditions_asked, conditions_options, numbered
from hexdbb.cli.run_logged import filing_in, log_option
from hexdbb.cli.run_watched import refuse_without_page, watch_options, watched
from hexdbb.errors import InputError, RunError
from hexdbb.files.atomic_file import refuse_existing
from hexdbb.plan import load_plan
from hexdbb.record import Record, conditions_metadata
from hexdbb.trajectory import Programme

SIMULATED_SILENT_AFTER = 25
"""Consecutive unanswered SYNCs allowed to a simulated rig in real time (100 ms at 250 Hz): a busy desktop stalls it
longer than a real node, and it can damage nothing."""

HELP = """Drive the circles of a plan and record slider positions and ball-bar readings.

\b
Without --bus a simulated rig is started as a separate process and ended afterwards.
Nothing moves before the plan, the bus load and the settings of every node have been checked.
Any fault stops all six axes together; the captured samples are kept.

\b
Examples:
  hexdbb-run --plan thesis -o demo.parquet
  hexdbb-run --plan my-plan.toml --bus socketcan:can0 -o monday.parquet --operator "J. Doe" --note "after the crash"
  hexdbb-run --plan standard --truth truth.toml --seed 3 -o simulated.parquet
  hexdbb-run --plan standard --compensation sp120.hexcomp -o after.parquet
  hexdbb-run --plan thesis --fault drive-fault:3@20 -o fault.parquet
  hexdbb-run --plan my-plan.toml --bus socketcan:can0 --watch -o monday.parquet
  hexdbb-run --plan my-plan.toml --bus socketcan:can0 --log glider -o monday.parquet

\b
Buses (any interface of python-can):
  socketcan:can0   pcan:PCAN_USBBUS1   kvaser:0@1000000   socketcand:127.0.0.1:29536
"""


@click.command("hexdbb-run", cls=Program, help=HELP, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="hexdbb-run")
@click.option(
    "--plan", "plan_name", default="thesis", show_default=True, help="Plan file, or the name of a shipped plan."
)
@click.option(
    "-o", "--output", "record", required=True, type=click.Path(path_type=Path), help="Record to write (.parquet)."
)
@click.option("--bus", "bus_spec", help="CAN bus as interface:channel; default: a simulated rig.")
@click.option(
    "--lockstep/--realtime",
    "lockstep",
    default=None,
    help="Next SYNC when all nodes have answered (default when simulated), or at the cycle rate.",
)
@click.option(
    "--rate",
    "rate_hz",
    type=click.FloatRange(min=1.0),
    help="Cycles per second; default: cycle_rate_hz of the machine file.",
)
@click.option(
    "--compensation",
    "compensation_path",
    type=click.Path(path_type=Path),
    help="Compensation file (hexdbb compensate): slider targets of the diagnosed machine instead of the nominal one.",
)
@click.option(
    "--temperature-c",
    type=float,
    help="Temperature of the machine, kept in the record; with --compensation, thermal growth is corrected by it.",
)
@conditions_options
@click.option("--truth", type=click.Path(path_type=Path), help="Simulated rig: truth file.")
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    help="Simulated rig: seed of the random machine, or of the noise with --truth.",
)
@click.option(
    "--fault", "faults", multiple=True, metavar="SPEC", help="Simulated rig: fault to inject; see hexdbb rig --help."
)
@watch_options
@log_option
@click.option("--yes", is_flag=True, help="Do not ask whether the bar is mounted.")
@click.option("--overwrite", is_flag=True, help="Replace an existing record.")
def command(
    plan_name: str,
    record: Path,
    bus_spec: str | None,
    lockstep: bool | None,
    rate_hz: float | None,
    compensation_path: Path | None,
    temperature_c: float | None,
    operator: str | None,
    notes: tuple[str, ...],
    machine_serial: str | None,
    gauge_serial: str | None,
    gauge_calibrated: datetime | None,
    truth: Path | None,
    seed: int | None,
    faults: tuple[str, ...],
    watch: bool,
    no_browser: bool,
    log: Path | None,
    yes: bool,
    overwrite: bool,
) -> None:
    """Measure."""
    # Their warnings about silent nodes and torn frames duplicate the messages of hexdbb.
    for library in ("can", "canopen"):
        logging.getLogger(library).setLevel(logging.CRITICAL)
    console, interrupts = run_console(), Interrupts()
    simulated = bus_spec is None
    rig = SimulatedRig(truth, seed, faults)
    if rig.options and not simulated:
        raise InputError(f"{rig.options[0]}: option of the simulated rig (expected without --bus)")
    refuse_existing(record, overwrite)
    refuse_without_page(watch)
    lockstep = simulated if lockstep is None else lockstep
    request, progress = _request(plan_name, record, rate_hz, overwrite), RunProgress()
    request = numbered(request, machine_serial, gauge_serial, gauge_calibrated)
    filing = None if log is None else filing_in(log, request.machine)
    asked = conditions_asked(operator, notes, temperature_c)
    request.metadata.update(conditions_metadata(request.plan.conditions, asked))
    if compensation_path is not None:
        from hexdbb.cli.run_compensated import compensated  # models take half a second to import

        request = compensated(request, compensation_path, temperature_c, progress)
    request.metadata.update(
        bus=bus_spec or "simulated rig",
        pace="lockstep" if lockstep else "real time",
        started=datetime.now(UTC).isoformat(timespec="seconds"),
    )
    if simulated:
        request = request if lockstep else replace(request, silent_after=SIMULATED_SILENT_AFTER, nodes_here=True)
    elif not yes and (sys.stdin is None or not sys.stdin.isatty()):
        progress.notes.append("stdin is not a terminal: no confirmation that the bar is mounted")
    elif not yes:
        request = replace(request, confirm=_ask(console, progress))
    with console.status("computing and checking all targets"):
        programme = prepare(request)
    with (
        interrupts.watched(),
        watched(request, progress, console, watch, no_browser),
        opened_bus(rig if bus_spec is None else bus_spec, request.machine) as bus,
        running_clock(lockstep, request.cycle_s, progress) as clock,
    ):
        console.print(_announcement(programme, lockstep, request), highlight=False, soft_wrap=True)
        with display(progress, console):
            recorded = measure(request, programme, bus, clock, progress, interrupts)
    try:
        _print_summary(recorded, programme, progress)
    except OSError as error:  # the record is what the command is for, and it is safe
        drop(sys.stdout)
        console.print(f"note: stdout: {unwritable(error)}; {recorded.path} is whole", highlight=False, soft_wrap=True)
    if filing is not None:
        click.echo(filing(recorded))


def main() -> None:
    """Run the command line; errors of hexdbb become one line on stderr and an exit status."""
    reports_errors(command)


def _request(plan_name: str, record: Path, rate_hz: float | None, overwrite: bool) -> Request:
    plan = load_plan(plan_name)
    machine = plan.machine_file()
    if record.suffix != ".parquet":
        raise InputError(f"{record}: suffix {record.suffix!r} (expected .parquet)")
    rate_hz = rate_hz or machine.can_setup.cycle_rate_hz
    metadata: dict[str, object] = {"plan": plan_name, "cycle_rate_hz": rate_hz}
    origin = str(plan.path) if plan.path is not None and Path(plan_name).exists() else plan_name
    return Request(plan, machine, origin, 1.0 / rate_hz, record, overwrite, metadata=metadata)


def _ask(console: Console, progress: RunProgress) -> Confirm:
    """Return the function that waits for the operator's confirmation."""

    def confirm(text: str) -> None:
        progress.paused = True
        time.sleep(2 * LIVE_PERIOD_S)  # until the display is out of the way
        try:
            console.input(f"{text}, then press Enter ")
        except (EOFError, OSError):  # the latter from a terminal that was closed
            raise RunError("stdin closed: the operator has not confirmed that the bar is mounted") from None
        finally:
            progress.paused = False

    return confirm


def _announcement(programme: Programme, lockstep: bool, request: Request) -> str:
    captured = int(programme.captured.sum())
    pace = "in lockstep" if lockstep else "in real time"
    driven = request.metadata.get("compensation")
    pace += f", compensated by {driven['file']}" if isinstance(driven, dict) else ""
    return (
        f"plan {request.origin}: {len(programme.runs)} runs, {captured} samples at {1.0 / programme.cycle_s:g} Hz, "
        f"{programme.duration_s:.0f} s of machine time, {pace}"
    )


def _print_summary(record: Record, programme: Programme, progress: RunProgress) -> None:
    """Print the summary of the record and the next command."""
    reading, planned = record.columns["reading_um"], programme.captured.sum()
    click.echo(
        f"recorded {record.path}: {len(record)} of {planned} samples, {len(record.sweeps())} sweeps, "
        f"readings {reading.min():+.1f} to {reading.max():+.1f} µm, {progress.missed} missed cycles"
    )
    name = record.path.with_suffix("") if record.path is not None else Path("record")
    if "compensation" in record.metadata:
        click.echo(f"next: hexdbb compare {record.path} -m MODEL")
    else:
        click.echo(f"next: hexdbb diagnose {record.path} -m {name}-model.toml")
    if progress.times is not None and "latency" in record.metadata:
        click.echo(f"real time: {progress.times.latency.words()}")
