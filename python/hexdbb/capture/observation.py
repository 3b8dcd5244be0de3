"""What a page is told of a running measurement, as messages of plain values.

Everything is read from another thread than the loop's, from what the loop holds anyway; nothing here waits for it.

=========  =============================================================================================================
``begin``  once: plan, record, machine, cycle, limits
``state``  five times a second: stage, place, counts, histograms, every node
``rows``   samples on disk: angle and reading of one sweep, largest following error of each axis among them
``end``    once: how it ended
=========  =============================================================================================================
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from typing import Any

import numpy as np

from hexdbb.capture.cia402 import HOMED, state_of
from hexdbb.capture.cycle_times import BIN_S
from hexdbb.capture.display import ProgressText
from hexdbb.capture.exchange import GAUGE_SLOT
from hexdbb.capture.request import Request, RunProgress
from hexdbb.capture.watch import Watch
from hexdbb.record import SLIDER_COLUMNS, TARGET_COLUMNS
from hexdbb.record.columns import Columns

Message = dict[str, Any]

NMT_NAMES = {0x00: "boot-up", 0x04: "stopped", 0x05: "operational", 0x7F: "pre-operational"}
"""States as a heartbeat carries them (CiA 301)."""
ANGLE_DIGITS, READING_DIGITS = 2, 2
"""Digits of degrees and µm that a page is told: a hundredth of a gauge's resolution is seen by nobody."""


def begin(request: Request) -> Message:
    """Return what does not change during a run."""
    machine = request.machine
    return {
        "kind": "begin",
        "plan": request.origin,
        "record": request.record.name,
        "machine": machine.name,
        "cycle_ms": 1e3 * request.cycle_s,
        "pace": request.metadata.get("pace", ""),
        "limit_mm": machine.can_setup.limits.following_error_mm,
        "bin_ms": 1e3 * BIN_S,
        "circles": {str(circle.id): circle.radius_mm for circle in request.plan.circles},
    }


class States:
    """Returns the state of a run at the moment.

    Parameters
    ----------
    progress : RunProgress
    """

    def __init__(self, progress: RunProgress) -> None:
        self._progress, self._text = progress, ProgressText(progress)

    def now(self) -> Message:
        """Return the message."""
        progress = self._progress
        watch, times = progress.watch, progress.times
        return {
            "kind": "state",
            "stage": progress.stage,
            "place": self._text.place(),
            "asked": progress.paused,
            "row": progress.row,
            "rows": progress.rows,
            "samples": progress.samples,
            "missed": progress.missed,
            "reading_um": None if math.isnan(progress.reading_um) else round(progress.reading_um, READING_DIGITS),
            "notes": list(progress.notes),
            "times": [] if times is None else _counted(times.times),
            "longest_ms": 0.0 if times is None else round(1e3 * times.longest_s, 1),
            "gaps": [] if times is None else _counted(times.gaps),
            "nodes": [] if watch is None else _nodes(watch),
        }


def rows(columns: Columns) -> Iterator[Message]:
    """Yield a message for each sweep among samples that were written."""
    sweep = columns["sweep"]
    starts = np.flatnonzero(np.r_[True, sweep[1:] != sweep[:-1]])
    for start, end in zip(starts, [*starts[1:], len(sweep)], strict=True):
        part = {name: column[start:end] for name, column in columns.items()}
        targets, sliders = (np.column_stack([part[name] for name in each]) for each in (TARGET_COLUMNS, SLIDER_COLUMNS))
        yield {
            "kind": "rows",
            "sweep": int(sweep[start]),
            "circle": int(part["circle"][0]),
            "direction": int(part["direction"][0]),
            "feed_mm_min": float(part["feed_mm_min"][0]),
            "angle_deg": np.round(part["angle_deg"], ANGLE_DIGITS).tolist(),
            "reading_um": np.round(part["reading_um"], READING_DIGITS).tolist(),
            "following_mm": np.round(np.abs(targets - sliders).max(axis=0), 4).tolist(),
        }


def end(outcome: str | None) -> Message:
    """Return how a run ended: None where the record is complete, else why not."""
    return {"kind": "end", "error": outcome}


def _counted(counts: list[int]) -> list[tuple[int, int]]:
    """Return what was counted as pairs of index and count."""
    return [(index, count) for index, count in enumerate(counts) if count]


def _nodes(watch: Watch) -> list[Message]:
    """Return the state of every node: drives 1 to 6, gauge."""
    supervision, feedback, now_s = watch.supervision, watch.feedback, time.monotonic()
    nodes: list[Message] = []
    for slot, (label, node) in enumerate(zip(watch.labels, supervision.nodes, strict=True)):
        heard_s, emergency = supervision.heard_s.get(node), supervision.emergencies.get(node)
        nmt = supervision.nmt_states.get(node)
        told: Message = {
            "label": label,
            "nmt": "no heartbeat yet" if nmt is None else NMT_NAMES.get(nmt, f"state {nmt:02X}h"),
            "heartbeat_ms": None if heard_s is None else round(1e3 * (now_s - heard_s)),
            "unanswered": supervision.unanswered[slot],
            "emergency": None if emergency is None else str(emergency),
        }
        if slot == GAUGE_SLOT:
            told["state"] = f"status {feedback.gauge_status:02X}h" if feedback.gauge_status else "valid"
        else:
            word = feedback.statusword[slot]
            told["state"] = state_of(word).label + ("" if word & HOMED else ", not homed")
        nodes.append(told)
    return nodes
