"""The page of the fault table, made of trials alone."""

from __future__ import annotations

import platform
from collections.abc import Sequence

from tests.faults.runs import RATE_HZ
from tests.faults.trials import ATTEMPTS, Trial

HEAD = "| fault | when | how often | exit status | time to stop | samples kept | lost | **wrong** | message |"
RULE = "|---|---|---|---|---|---|---|---|---|"

INTRODUCTION = """# Faults and their outcomes

Made by `python -m tests.faults --table docs/fault-table.md{options}`; nothing here is written by hand.
Each fault acts on a circle driven at {rate:g} Hz, in the middle of its capture: between the controller and the
simulated rig, by a proxy that changes frames, or in the rig itself. Every sample that is kept is compared with the same
run without a fault and, where the fault moves the machine itself, with what all seven nodes answered to one SYNC.
**A wrong sample that is kept is a defect**; so is a fault without its name.

- *Time to stop*: from the moment of the fault until all six drives have received a quick stop, in SYNCs and in
  milliseconds (on {computer}, shared with other work). A dash: no quick stop was received, because none was needed or
  the connection was gone.
- *Lost*: samples missing from a complete record, or captured before the fault and not in an incomplete one.
- Real time: rig and proxy are scheduled as the controller is, since real nodes do not wait for other programs. A run
  that this computer stalled is repeated, at most {attempts} times in all.
"""


def page(single: Sequence[Trial], pairs: Sequence[Trial], options: str) -> str:
    """Return the page."""
    parts = [
        INTRODUCTION.format(rate=RATE_HZ, computer=_computer(), attempts=ATTEMPTS, options=options),
        summary([*single, *pairs]),
    ]
    for title, trials in (
        ("Lockstep", [trial for trial in single if trial.lockstep]),
        ("Real time", [trial for trial in single if not trial.lockstep]),
        ("Two faults at once", pairs),
    ):
        if trials:
            parts += [f"\n## {title}\n", "\n".join([HEAD, RULE, *map(row, trials)]), ""]
    return "\n".join(parts)


def summary(trials: Sequence[Trial]) -> str:
    """Return the outcome of all trials in a sentence."""
    wrong, failed = sum(trial.wrong for trial in trials), [trial for trial in trials if trial.unmet]
    lines = [f"{len(trials)} runs, {wrong} wrong samples kept, {len(failed)} runs not as required."]
    return "\n".join(
        [*lines, *(f"- {'; '.join(trial.names)} ({_pace(trial)}): {', '.join(trial.unmet)}" for trial in failed)]
    )


def row(trial: Trial) -> str:
    """Return one row of the table."""
    cells = (
        " and ".join(trial.names),
        trial.when,
        trial.how_often,
        {0: "0, complete", -1: "hung"}.get(trial.exit_status, str(trial.exit_status)),
        "–" if trial.stop_ms is None else f"{trial.stop_cycles:.0f} / {trial.stop_ms:.1f} ms",
        str(trial.kept),
        str(trial.lost),
        f"**{trial.wrong}**",
        (trial.message.splitlines() or [""])[0].replace("|", "\\|"),
    )
    return f"| {' | '.join(cells)} |"


def line(trial: Trial) -> str:
    """Return one line on a trial, for a terminal."""
    verdict = ", ".join(trial.unmet) or "as required"
    outcome = f"exit {trial.exit_status}, {trial.kept} kept, {trial.wrong} wrong"
    if trial.unmet and trial.message:
        verdict += f" [{trial.message}]"
    return f"{' + '.join(trial.names)} ({_pace(trial)}): {outcome}: {verdict}"


def _pace(trial: Trial) -> str:
    return "lockstep" if trial.lockstep else "real time"


def _computer() -> str:
    return f"{platform.machine()}, {platform.system()}"
