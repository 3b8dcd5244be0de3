"""`hexdbb check-realtime`: is a cycle rate safe on this computer, and what to change where it is not."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import click
from rich.progress import Progress

from hexdbb.capture.real_time_check import advice, judged
from hexdbb.capture.realtime import real_time_process
from hexdbb.capture.round_trips import measured_latency
from hexdbb.capture.transport import open_bus
from hexdbb.cli.consoles import message_console, say
from hexdbb.errors import RunError
from hexdbb.machine import load_machine, shipped_machine


@click.command("check-realtime")
@click.option(
    "--machine", "machine_path", type=click.Path(path_type=Path), help="Machine file; default: the shipped one."
)
@click.option(
    "--rate", "rate_hz", type=click.FloatRange(min=1.0), help="Cycles per second; default: that of the machine file."
)
@click.option(
    "--seconds",
    type=click.FloatRange(min=1.0, max=86400.0),
    default=60.0,
    show_default=True,
    help="How long to measure.",
)
@click.option("--bus", "bus_spec", help="CAN bus as interface:channel: its nodes are asked too. Nothing moves.")
def command(machine_path: Path | None, rate_hz: float | None, seconds: float, bus_spec: str | None) -> None:
    """Measure whether this computer can send a SYNC at every deadline.

    A program as privileged as hexdbb-run sleeps until every deadline of the rate and measures how late it wakes; with
    --bus, one node a cycle is asked for its device type (object 1000h), and the time to its answer is measured. Nothing
    moves and nothing is configured. Measure while the computer does what it will do during a run: what is measured on
    an idle computer holds for an idle computer.

    Exit status 0 where the rate is safe, 1 where it is not, with what to change.

    \b
    Examples:
      hexdbb check-realtime
      hexdbb check-realtime --rate 250 --seconds 10
      hexdbb check-realtime --machine sp120.toml --bus socketcan:can0
    """
    machine = load_machine(machine_path) if machine_path is not None else shipped_machine()
    can_setup = machine.can_setup
    rate_hz = rate_hz or can_setup.cycle_rate_hz
    nodes = () if bus_spec is None else (*can_setup.drive_nodes, can_setup.gauge_node)
    opened = nullcontext() if bus_spec is None else open_bus(bus_spec, can_setup.bitrate_bit_s)
    with opened as bus, Progress(console=message_console(), transient=True) as bar:
        task = bar.add_task(f"measuring for {seconds:g} s at {rate_hz:g} Hz", total=1.0)
        with real_time_process() as refused:
            latency, unanswered = measured_latency(
                rate_hz, seconds, bus, nodes, lambda share: bar.update(task, completed=share)
            )
    say(f"{latency.late.count} wake-ups at {rate_hz:g} Hz, late by {latency.late.words()}")
    if nodes:
        say(f"{latency.answered.count} SDO answers, after {latency.answered.words()}")
    for node, count in unanswered.items():
        if count:
            say(f"node {node}: {count} questions without an answer within {750.0 / rate_hz:.1f} ms")
    for each in refused:
        say(f"note: {each}")
    verdict = judged(latency, rate_hz, can_setup.rpdo_timeout_ms / 1000.0)
    if verdict.safe:
        say(verdict.said if nodes else f"{verdict.said} for this computer; of the bus, --bus measures the answers")
        return
    interface = bus_spec.partition(":")[2] if bus_spec is not None and bus_spec.startswith("socketcan:") else None
    say("To change, what counts most first:")
    for each in advice(refused, interface):
        say(f"- {each}")
    raise RunError(verdict.said)
