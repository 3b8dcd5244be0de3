"""What a page keeps of what it is told, the pipe that is never waited for, cycle times as bars and words."""

from __future__ import annotations

import json
import os
from typing import Any

import pytest

from hexdbb.capture.cycle_times import BINS, GAPS, CycleTimes
from hexdbb.capture.page_feed import PagePipe
from hexdbb.live.histogram import BARS, bars, in_words
from hexdbb.live.seen import KEPT, SeenRun


def samples(count: int, **changed: Any) -> dict[str, Any]:
    told = {"kind": "rows", "sweep": 0, "circle": 0, "direction": 1, "feed_mm_min": 500.0}
    told |= {"angle_deg": [1.0] * count, "reading_um": [-2.0] * count, "following_mm": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]}
    return told | changed


def test_sweeps_of_one_circle_are_drawn_together_and_another_begins_anew() -> None:
    run = SeenRun()
    run.take({"kind": "begin", "circles": {"0": 80.0, "1": 120.0}})
    run.take(samples(3))
    run.take(samples(2, following_mm=[0.2, 0.1, 0, 0, 0, 0]))
    run.take(samples(4, sweep=1, direction=-1, reading_um=[7.0] * 4))
    ring = run.ring
    assert ring is not None
    assert [(each.direction, len(each.points)) for each in ring.traces] == [(1, 5), (-1, 4)]
    assert (ring.largest_um, ring.radius_mm) == (7.0, 80.0)
    assert run.largest_following_mm == [0.2, 0.2, 0.3, 0.4, 0.5, 0.6]
    run.take(samples(1, sweep=2, circle=1))
    assert run.ring is not None
    assert (run.ring.epoch, run.ring.radius_mm, len(run.ring.traces)) == (ring.epoch + 1, 120.0, 1)


def test_what_a_page_keeps_of_a_sweep_is_bounded() -> None:
    run = SeenRun()
    for _ in range(5):
        run.take(samples(KEPT // 2 + 1))
        assert run.ring is not None
        assert len(run.ring.traces[0].points) <= KEPT


def test_a_run_that_ends_without_a_word_is_said_so_and_an_end_is_kept() -> None:
    run = SeenRun()
    run.lose()
    assert run.failed
    assert "hexdbb recover" in str(run.ended)
    run = SeenRun()
    run.take({"kind": "end", "error": None})
    run.lose()
    assert (run.failed, run.ended) == (False, "The run is complete")


def test_a_pipe_that_nobody_reads_is_not_waited_for_and_no_line_is_torn() -> None:
    reading, writing = os.pipe()
    pipe, message = PagePipe(writing), {"text": "x" * 5000}
    sent = 0
    while pipe.send(message):
        sent += 1
    assert not pipe.is_free
    told = b""
    while not pipe.send():
        told += os.read(reading, 1 << 16)
    assert pipe.is_free
    os.close(writing)
    while more := os.read(reading, 1 << 16):
        told += more
    os.close(reading)
    assert [json.loads(line) for line in told.splitlines()] == [message] * (sent + 1)


def test_a_pipe_without_a_reader_says_so() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    with pytest.raises(BrokenPipeError):
        PagePipe(writing).send({})
    os.close(writing)


def test_cycles_and_gaps_are_counted_but_no_pause() -> None:
    times = CycleTimes()
    for sync_s, missed in ((1.0, 0), (1.00405, 0), (1.0201, 3), (1.5, 99)):
        times.take(sync_s, missed)
    times.pause()
    times.take(9.0, 0)
    assert {index: count for index, count in enumerate(times.times) if count} == {40: 1, 160: 1, BINS - 1: 1}
    assert {index: count for index, count in enumerate(times.gaps) if count} == {3: 1, GAPS - 1: 1}
    assert times.longest_s == pytest.approx(0.4799)
    times.clear()
    assert (sum(times.times), sum(times.gaps), times.longest_s) == (0, 0, 0.0)


def test_bars_hold_every_cycle_and_words_name_the_shares() -> None:
    counted = [(40, 998), (47, 1), (BINS - 1, 1)]
    drawn = bars(counted, 0.1)
    assert len(drawn) <= BARS
    assert sum(count for _, count in drawn) == 1000
    assert (
        in_words(counted, 0.1, 230.0) == "1,000 cycles: half within 4.1 ms, 99.9 % within 4.8 ms, the longest 230.0 ms"
    )
    beyond = "1 cycles: half within 230.0 ms, 99.9 % within 230.0 ms, the longest 230.0 ms"
    assert in_words([(BINS - 1, 1)], 0.1, 230.0) == beyond
    assert bars([], 0.1) == []
    assert in_words([], 0.1, 0.0) == "no cycle yet"
