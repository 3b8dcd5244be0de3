"""`hexdbb demo`: the main jobs of hexdbb on simulated machines, by the commands a user types."""

from __future__ import annotations

import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import click

from hexdbb.cli.consoles import say
from hexdbb.cli.demo_story import CHAPTERS, HIDDEN, Fault
from hexdbb.errors import InputError, RunError
from hexdbb_start import INTERRUPTED

PROGRAMS = {"hexdbb": "hexdbb", "hexdbb-run": "hexdbb_run"}
"""The commands of the story, and the functions of `hexdbb_start` behind them: they need not be on the PATH."""
ENDS_WITHIN_S = 3.0
"""Time for a command that has received Ctrl-C itself to stop its axes, keep its record and end."""


@click.command("demo")
@click.argument("folder", metavar="[FOLDER]", default="hexdbb-demo", type=click.Path(path_type=Path))
@click.option("--all", "every", is_flag=True, help="Two machines more: the thesis' circle, a fault without a formula.")
@click.option(
    "--rate",
    "rate_hz",
    type=click.FloatRange(min=10.0, max=100.0),
    default=10.0,
    show_default=True,
    help="Readings per second of machine time; fewer take less time.",
)
def command(folder: Path, every: bool, rate_hz: float) -> None:
    """Find a fault hidden in a simulated machine, step by step: some 20 s of processor time.

    Each command is printed before it runs, as it can be typed again. Records, models, pictures and the report stay in
    FOLDER, which must be empty or new.

    \b
    Examples:
      hexdbb demo
      hexdbb demo there --all --rate 20
    """
    if folder.exists() and not (folder.is_dir() and not any(folder.iterdir())):
        raise InputError(f"{folder}: exists already (expected a folder that is empty or new)")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: cannot be made: {error.strerror}") from None
    started_s = time.monotonic()
    chapters = CHAPTERS if every else (HIDDEN,)
    stages = [stage for chapter in chapters for stage in chapter.stages.items()]
    for number, (title, steps) in enumerate(stages, 1):
        _print(f"\n== {number}/{len(stages)}  {title}")
        for step in steps:
            if isinstance(step, Fault):
                _append(step, folder)
            else:
                _run(arguments_of(step, folder, rate_hz))
    _print(f"\nDone in {time.monotonic() - started_s:.0f} s. In {folder}:")
    for path in sorted(folder.iterdir()):
        _print(f"  {path.name}")
    _print("By hand, in the browser (needs: pip install 'hexdbb[workbench]'):")
    for line in (each for chapter in chapters for each in chapter.by_hand):
        _print(f"  {shlex.join(arguments_of(line, folder, rate_hz))}")


def arguments_of(line: str, folder: Path, rate_hz: float) -> list[str]:
    """Return the words of a command of the story, with its folder and rate."""
    return [word.format(folder=folder, rate=f"{rate_hz:g}") for word in shlex.split(line)]


def _append(fault: Fault, folder: Path) -> None:
    path = folder / fault.file
    _print(f"\n$ cat >> {shlex.quote(str(path))}\n{fault.toml}", nl=False)
    with path.open("a", encoding="utf-8") as file:
        file.write(f"\n{fault.toml}")


def _run(arguments: list[str]) -> None:
    """Run a command as a process of its own, as a user does: it prints for itself."""
    _print(f"\n$ {shlex.join(arguments)}")
    program = f"from hexdbb_start import {PROGRAMS[arguments[0]]} as run; run()"
    process = subprocess.Popen([sys.executable, "-P", "-c", program, *arguments[1:]], stdin=subprocess.DEVNULL)
    try:
        status = process.wait()
    except KeyboardInterrupt:
        raise click.exceptions.Exit(_interrupted(process)) from None
    if status != 0:
        raise RunError(f"the demo ends here: {arguments[0]} {arguments[1]} ended with exit status {status}")


def _interrupted(process: subprocess.Popen[bytes]) -> int:
    """Wait for a command to end, which the terminal has told of Ctrl-C too; return the exit status."""
    try:
        process.wait(ENDS_WITHIN_S)
    except subprocess.TimeoutExpired:  # the signal was for this process alone
        process.send_signal(signal.SIGINT)
        process.wait()
    return INTERRUPTED


def _print(text: str, nl: bool = True) -> None:
    """Print at once: the commands write to the same stream."""
    say(text, nl=nl)
    sys.stdout.flush()
