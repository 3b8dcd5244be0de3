"""`hexdbb rig`: the simulated rig as a separate process."""

from __future__ import annotations

import logging
import os
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

import click

from hexdbb.errors import InputError
from hexdbb.files.validation import dump_toml, load_toml
from hexdbb.machine import load_machine, shipped_machine
from hexdbb.rig.bus import Rig
from hexdbb.rig.faults import FAULTS, parse_fault
from hexdbb.rig.socketcand import SocketcandServer
from hexdbb.rig.truth import RANDOM_SEED, TruthFile, random_truth

READY = "hexdbb rig: listening on 127.0.0.1:{port}"
"""The only line on stdout, which programs that start the rig wait for (`hexdbb.capture.simulated`)."""

_FAULT_HELP = "\n".join(f"  {name:<20}{kind.text}" for name, kind in FAULTS.items())
_HELP = f"""Serve a simulated HexGlider with a ball bar as a CAN bus (socketcand on 127.0.0.1).

\b
Nodes 1-6 are CiA 402 drives, node 7 a CiA 404 gauge. SYNC is the only clock of the physics.
Any python-can program can connect: interface socketcand, channel can0, tcp_tune.

\b
Examples:
  hexdbb rig --port 29536
  hexdbb rig --truth truth.toml --fault drive-fault:3@2.5=0x2310
  hexdbb rig --seed 7 --write-truth hidden.toml --no-serve
  hexdbb-run --plan thesis --bus socketcand:127.0.0.1:29536 -o demo.parquet

\b
Faults, KIND[:node][@time_s][=value], time counted from the first moment at which all drives are enabled:
{_FAULT_HELP}
"""


@click.command("rig", help=_HELP)
@click.option(
    "--machine", "machine_path", type=click.Path(path_type=Path), help="Machine file; default: the shipped one."
)
@click.option("--truth", "truth_path", type=click.Path(path_type=Path), help="Truth file; default: a random machine.")
@click.option("--write-truth", type=click.Path(path_type=Path), help="Write the truth in use to this file.")
@click.option("--no-serve", is_flag=True, help="With --write-truth: end once the file is written.")
@click.option("--seed", type=click.IntRange(min=0), help="Seed of the random machine, or of the noise with --truth.")
@click.option(
    "--port", type=click.IntRange(0, 65535), default=0, show_default=True, help="TCP port; 0 selects a free one."
)
@click.option("--fault", "faults", multiple=True, metavar="SPEC", help="Fault to inject; may be repeated.")
@click.option("--once", is_flag=True, help="End when the last client has disconnected.")
@click.option("--exit-with-parent", is_flag=True, help="End when the process that started the rig has ended.")
@click.option(
    "--stall-tolerance",
    "stall_tolerance_s",
    type=click.FloatRange(min=0.0),
    default=1.0,
    show_default=True,
    help="Seconds added to the heartbeat and RPDO timeouts of the drives, for controllers on a desktop system.",
)
@click.option("-v", "--verbose", is_flag=True, help="Log state changes to stderr.")
def command(
    machine_path: Path | None,
    truth_path: Path | None,
    write_truth: Path | None,
    no_serve: bool,
    seed: int | None,
    port: int,
    faults: tuple[str, ...],
    once: bool,
    exit_with_parent: bool,
    stall_tolerance_s: float,
    verbose: bool,
) -> None:
    """Serve the rig until it is stopped."""
    logging.basicConfig(stream=sys.stderr, format="hexdbb rig: %(message)s")
    logging.getLogger("hexdbb").setLevel(logging.DEBUG if verbose else logging.WARNING)
    rig, truth = simulated(machine_path, truth_path, seed, faults, stall_tolerance_s)
    if write_truth is not None:
        _write(write_truth, truth)
    elif no_serve:
        raise InputError("--no-serve: without --write-truth there is nothing to do (expected --write-truth FILE)")
    if no_serve:
        return
    _serve(rig, port, once=once, exit_with_parent=exit_with_parent)


def simulated(
    machine_path: Path | None,
    truth_path: Path | None,
    seed: int | None,
    faults: Sequence[str],
    stall_tolerance_s: float,
) -> tuple[Rig, TruthFile]:
    """Return the rig of a command line, and the truth it hides."""
    machine = load_machine(machine_path) if machine_path is not None else shipped_machine()
    truth = _truth(truth_path, seed)
    return Rig(machine, truth, [parse_fault(spec) for spec in faults], stall_tolerance_s), truth


def _serve(rig: Rig, port: int, *, once: bool, exit_with_parent: bool) -> None:
    parent = os.getppid()

    def poll(now_s: float) -> None:
        rig.poll(now_s)
        if exit_with_parent and os.getppid() != parent:
            server.stop()

    def last_client_gone() -> None:
        rig.controller_gone()
        if once:
            server.stop()

    server = SocketcandServer(port, rig.receive_all, poll, last_client_gone)
    rig.transmit, rig.on_bus_lost = server.transmit, server.disconnect_all
    signal.signal(signal.SIGTERM, lambda *_: server.stop())
    # Ctrl-C also reaches the controller, which needs the bus to stop the axes.
    signal.signal(signal.SIGINT, lambda *_: server.stop_when_alone())
    click.echo(READY.format(port=server.port))
    sys.stdout.flush()
    server.serve()


def _truth(path: Path | None, seed: int | None) -> TruthFile:
    if path is None:
        return random_truth(RANDOM_SEED if seed is None else seed)
    truth = load_toml(path, TruthFile)
    return truth if seed is None else truth.model_copy(update={"seed": seed})


def _write(path: Path, truth: TruthFile) -> None:
    try:
        path.write_text(dump_toml(truth), encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
