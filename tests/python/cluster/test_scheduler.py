"""An existing scheduler: real processes of `dask scheduler` and `dask worker` on 127.0.0.1, killed and restarted."""

from __future__ import annotations

import datetime
import os
import shutil
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID
from distributed import Client
from tests import cluster_work as work

import hexdbb
from hexdbb.cluster import ClusterOptions, Progress, connected, run_tasks
from hexdbb.cluster.submitted import Submitted
from hexdbb.errors import InputError, RunError

WAIT_S = 0.02
"""Time of a task: so that a run is long enough to be disturbed in its middle."""


@pytest.fixture
def running() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


def test_a_worker_killed_in_the_middle_loses_nothing_and_doubles_nothing(running: ExitStack, tmp_path: Path) -> None:
    port = work.free_port()
    address = f"tcp://127.0.0.1:{port}"
    running.enter_context(work.scheduler(port))
    first, _ = (running.enter_context(work.worker(address)) for _ in range(2))
    work.wait_for_workers(address, 2)

    def kill(now: Progress) -> None:
        if now.done >= 20:
            first.kill()

    results = work.results(tmp_path)
    lines: list[str] = []
    run = run_tasks(
        work.tasks(100, wait_s=WAIT_S),
        work.draw,
        results,
        ClusterOptions(scheduler=address),
        tell=lines.append,
        progress=kill,
    )
    assert lines[0].startswith(f"2 workers at {address}, ")
    assert first.poll() is not None
    assert (run.done, run.failed) == (100, 0)
    assert sorted(results.table()["number"].to_pylist()) == sorted(2 * list(range(100)))


def test_a_scheduler_restarted_ends_the_run_and_the_next_does_the_rest(running: ExitStack, tmp_path: Path) -> None:
    port = work.free_port()
    address = f"tcp://127.0.0.1:{port}"
    results, options = work.results(tmp_path), ClusterOptions(scheduler=address)
    tasks = work.tasks(200, wait_s=WAIT_S)
    with ExitStack() as first:
        scheduler = first.enter_context(work.scheduler(port))
        first.enter_context(work.worker(address))
        work.wait_for_workers(address, 1)

        def end(now: Progress) -> None:
            if now.done >= 40:
                scheduler.kill()

        with pytest.raises(RunError, match=r"the scheduler is gone, .* what is done is kept: run it again"):
            run_tasks(tasks, work.draw, results, options, progress=end)
    written = results.table()["number"].to_pylist()
    assert 0 < len(written) < 400
    running.enter_context(work.scheduler(port))
    running.enter_context(work.worker(address))
    run = run_tasks(tasks, work.draw, results, options)
    assert run.before == len(written) // 2
    assert run.done == 200 - run.before
    assert sorted(results.table()["number"].to_pylist()) == sorted(2 * list(range(200)))


def test_a_worker_with_another_hexdbb_is_refused_whenever_it_joins(running: ExitStack, tmp_path: Path) -> None:
    """The same package, whose metadata state another version."""
    port = work.free_port()
    address = f"tcp://127.0.0.1:{port}"
    stated = tmp_path / "other" / "hexdbb-0.1.7.dist-info"
    stated.mkdir(parents=True)
    (stated / "METADATA").write_text("Metadata-Version: 2.1\nName: hexdbb\nVersion: 0.1.7\n")
    package = Path(hexdbb.__file__).parent
    shutil.copytree(package, tmp_path / "other" / "hexdbb", ignore=shutil.ignore_patterns("__pycache__", "data"))
    other = f"{tmp_path / 'other'}{os.pathsep}{Path(__file__).parents[3]}"
    options = ClusterOptions(scheduler=address)
    said = rf"worker tcp://127.0.0.1:\d+ has hexdbb 0.1.7 \(expected {hexdbb.__version__}, as here; install the same"
    running.enter_context(work.scheduler(port))
    running.enter_context(work.worker(address))
    with connected(options) as cluster:
        running.enter_context(work.worker(address, PYTHONPATH=other))
        work.wait_for_workers(address, 2)
        with pytest.raises(InputError, match=said):
            run_tasks(work.tasks(60, wait_s=WAIT_S), work.draw, work.results(tmp_path / "results"), cluster)
    with pytest.raises(InputError, match=said), connected(options):
        pass


def test_a_scheduler_without_workers_is_told(running: ExitStack) -> None:
    port = work.free_port()
    running.enter_context(work.scheduler(port))
    with (
        Client(f"tcp://127.0.0.1:{port}", timeout=30) as client,
        Submitted(client, lost_s=0.5, tick_s=0.1, report=lambda: None) as submitted,
        pytest.raises(RunError, match=r"no worker for 0.5 s \(expected one at least\); what is done is kept"),
    ):
        list(submitted.each([1], lambda number: (abs, number), window=10))


def test_certificates_of_another_authority_are_refused(running: ExitStack, tmp_path: Path) -> None:
    ours, theirs = authority(tmp_path / "ours"), authority(tmp_path / "theirs")
    port = work.free_port()
    address = f"tls://127.0.0.1:{port}"
    theirs_words = (
        "--tls-ca-file",
        theirs / "ca.pem",
        "--tls-cert",
        theirs / "own.pem",
        "--tls-key",
        theirs / "own.key",
    )
    running.enter_context(work.scheduler(port, "--host", "tls://127.0.0.1", "--port", port, *theirs_words))
    running.enter_context(work.worker(address, *theirs_words))
    options = ClusterOptions(None, address, theirs / "ca.pem", theirs / "own.pem", theirs / "own.key")
    with connected(options) as cluster:
        assert cluster.workers == 1
    for ca, own in ((ours, ours), (theirs, ours)):
        wrong = ClusterOptions(None, address, ca / "ca.pem", own / "own.pem", own / "own.key")
        with (
            pytest.raises(InputError, match=rf"--scheduler {address}: a certificate is refused \(expected"),
            connected(wrong),
        ):
            pass


def authority(folder: Path) -> Path:
    """Write the certificate of an authority, and one that it signed with its key."""
    folder.mkdir()
    ca_key, own_key = ec.generate_private_key(ec.SECP256R1()), ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, folder.name)])
    for file, key, extension in (
        ("ca.pem", ca_key, x509.BasicConstraints(ca=True, path_length=None)),
        ("own.pem", own_key, x509.BasicConstraints(ca=False, path_length=None)),
    ):
        subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, f"{folder.name} {file}")])
        begins = datetime.datetime(2020, 1, 1, tzinfo=datetime.UTC)
        certificate = (
            x509.CertificateBuilder(name, name if key is ca_key else subject, key.public_key())
            .serial_number(x509.random_serial_number())
            .not_valid_before(begins)
            .not_valid_after(begins + datetime.timedelta(days=36500))
            .add_extension(extension, critical=True)
            .sign(ca_key, hashes.SHA256())
        )
        (folder / file).write_bytes(certificate.public_bytes(serialization.Encoding.PEM))
    (folder / "own.key").write_bytes(
        own_key.private_bytes(
            serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
        )
    )
    return folder
