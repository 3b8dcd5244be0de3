"""Tasks on real processes: each once, the same whatever the number of workers, failures told and nothing lost."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pyarrow as pa
import pytest
from tests import cluster_work as work

from hexdbb.cluster import Cluster, ClusterOptions, connected, content_key, run_tasks, seed_of
from hexdbb.cluster.connection import _unanswered
from hexdbb.errors import InputError, RunError


def test_rows_do_not_depend_on_the_number_of_workers(two_workers: Cluster, tmp_path: Path) -> None:
    tasks = work.tasks(150)
    run = run_tasks(tasks, work.draw, work.results(tmp_path / "two"), two_workers)
    assert (run.done, run.before, run.failed, run.rows) == (150, 0, 0, 300)
    lines: list[str] = []
    run_tasks(tasks, work.draw, work.results(tmp_path / "one"), ClusterOptions(workers=1), tell=lines.append)
    assert lines[0].startswith("1 worker on this computer, at most ")
    assert "dashboard: http://127.0.0.1:" in lines[0]
    files = {
        folder: {path.relative_to(tmp_path / folder): path.read_bytes() for path in (tmp_path / folder).rglob("*.*")}
        for folder in ("one", "two")
    }
    assert files["one"] == files["two"]
    assert len(files["one"]) < 1 + 3 * 64


def test_there_are_as_many_workers_as_cores_where_nothing_is_said() -> None:
    """A process of its own, which may use one core only: Dask counts cores when it is imported."""
    lines = (
        "import os",
        "from hexdbb.cluster import ClusterOptions, connected",
        "if __name__ == '__main__':",
        "    os.sched_setaffinity(0, [min(os.sched_getaffinity(0))])",
        "    with connected(ClusterOptions()) as cluster:",
        "        print(cluster.workers)",
    )
    program = [sys.executable, "-c", "\n".join(lines)]
    done = subprocess.run(program, capture_output=True, text=True, timeout=60, check=False)
    assert done.stdout == "1\n", done.stderr


def test_what_is_done_is_not_done_again(two_workers: Cluster, tmp_path: Path) -> None:
    seen = tmp_path / "seen"
    seen.mkdir()
    results = work.results(tmp_path / "results")
    run_tasks(work.tasks(20, seen=str(seen)), work.draw, results, two_workers)
    more = run_tasks(work.tasks(30, seen=str(seen)), work.draw, results, two_workers)
    assert (more.before, more.done) == (20, 10)
    assert [work.attempts(seen, number) for number in range(30)] == [1] * 30
    none = run_tasks(work.tasks(30), work.draw, results, ClusterOptions(workers=1))
    assert (none.before, none.done, none.rows) == (30, 0, 0)
    assert sorted(set(results.table()["number"].to_pylist())) == list(range(30))


def test_a_task_that_fails_three_times_is_a_row(two_workers: Cluster, tmp_path: Path) -> None:
    seen = tmp_path / "seen"
    seen.mkdir()
    results = work.results(tmp_path / "results")
    tasks = work.tasks(40, seen=str(seen))
    run = run_tasks(tasks, work.draw_or_fail, results, two_workers)
    table = results.table()
    failed = table.filter(pa.compute.is_valid(table["error"])).to_pylist()
    assert {row["number"]: row["error"] for row in failed} == {
        number: f"OSError: no answer for {number}" for number in range(3, 40, 7)
    }
    assert run.failed == len(failed) == len(range(3, 40, 7))
    assert table.num_rows == 2 * (40 - run.failed) + run.failed
    assert run_tasks(tasks, work.draw, results, two_workers).before == 40
    again = run_tasks(tasks, work.draw, results, two_workers, again=True)
    assert (again.before, again.done) == (40 - run.failed, run.failed)
    assert results.table()["error"].null_count == results.table().num_rows == 80


def test_a_task_that_kills_its_worker_is_a_row_and_takes_no_other_with_it(tmp_path: Path) -> None:
    results = work.results(tmp_path)
    run = run_tasks(work.tasks(30, deadly=17), work.draw_or_die, results, ClusterOptions(workers=2), most_in_call=4)
    rows = results.table().to_pylist()
    assert (run.done, run.failed, len(rows)) == (30, 1, 2 * 29 + 1)
    assert [(row["number"], row["error"]) for row in rows if row["error"]] == [
        (17, "its worker died each time (expected a task that fits in its memory)")
    ]


def test_results_of_another_kind_and_a_damaged_part_are_refused(two_workers: Cluster, tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match=r"other: holds other files, as .*notes.txt"):
        run_tasks(work.tasks(1), work.draw, work.results(tmp_path / "other"), two_workers)
    results = work.results(tmp_path / "results")
    run_tasks(work.tasks(9), work.draw, results, two_workers)
    with pytest.raises(InputError, match=r"results of hexdbb.test/1 \(expected hexdbb.other/1"):
        type(results)(results.url, "hexdbb.other/1", work.COLUMNS).begin()
    part = next(iter(sorted((tmp_path / "results").rglob("part-*"))))
    part.write_bytes(part.read_bytes()[:-20])
    with pytest.raises(RunError, match=rf"{part.name}: damaged \(expected a whole part; remove it and run again\)"):
        results.begin()
    part.unlink()
    assert run_tasks(work.tasks(9), work.draw, results, two_workers).done > 0
    assert results.table().num_rows == 18


def test_a_full_disk_ends_the_run_and_leaves_whole_parts(
    two_workers: Cluster, tmp_path: Path, disk_full_after: object
) -> None:
    results = work.results(tmp_path, ())
    tasks = work.tasks(128)
    results.begin()
    with disk_full_after(1100), pytest.raises(RunError, match=r"part-.*: cannot be written: File too large"):  # type: ignore[operator]
        run_tasks(tasks, work.draw, results, two_workers)
    assert not list(tmp_path.rglob("*.part"))
    run_tasks(tasks, work.draw, results, two_workers)
    assert results.table().num_rows == 256


def test_a_function_must_make_rows_in_one_partition(two_workers: Cluster, tmp_path: Path) -> None:
    results = work.results(tmp_path)
    assert run_tasks(work.tasks(2), work.nothing, results, two_workers).failed == 2
    assert results.table().sort_by("number")["error"].to_pylist() == [
        f"ValueError: rows in {count} partitions (expected one row at least, all in one partition)" for count in (0, 2)
    ]


def test_keys_and_seeds_follow_from_content_alone() -> None:
    assert content_key({"a": 1, "b": [2.5]}) == content_key({"b": [2.5], "a": 1}) != content_key({"a": 1, "b": [2.0]})
    assert len({seed_of(content_key(number)) for number in range(100)}) == 100
    assert 0 <= seed_of(content_key("x")) < 2**63


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"workers": 0}, r"--workers 0 \(expected 1 or more\)"),
        ({"workers": 2, "scheduler": "tcp://127.0.0.1:1"}, "--workers 2 together with --scheduler"),
        ({"scheduler": "http://127.0.0.1"}, r'--scheduler "http://127.0.0.1" \(expected tcp://HOST:PORT'),
        ({"scheduler": "tls://127.0.0.1:1"}, "without --tls-ca, --tls-cert, --tls-key"),
        ({"scheduler": "tcp://127.0.0.1:1", "tls_ca": Path("ca.pem")}, "--tls-ca with --scheduler tcp"),
        ({"tls_key": Path("key.pem")}, "--tls-key without --scheduler"),
    ],
)
def test_contradicting_options_are_refused(options: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        ClusterOptions(**options)  # type: ignore[arg-type]


def test_where_no_scheduler_answers_one_line_says_so() -> None:
    options = ClusterOptions(scheduler=f"tcp://127.0.0.1:{work.free_port()}")
    with pytest.raises(RunError, match=r"no scheduler answered within 6 s"), connected(options):
        pass


def test_a_scheduler_that_is_not_there_is_no_matter_of_certificates(tmp_path: Path) -> None:
    files = {name: tmp_path / name for name in ("tls_ca", "tls_cert", "tls_key")}
    for path in files.values():
        path.touch()
    options = ClusterOptions(scheduler="tls://127.0.0.1:1", **files)
    timeout = OSError("Timed out trying to connect to tls://127.0.0.1:1 after 6 s")
    assert isinstance(_unanswered(options, timeout), RunError)
    assert isinstance(_unanswered(options, OSError("in <TLS (closed) Scheduler>: Stream is closed")), InputError)
