"""Records and results in an S3-compatible store: a process of its own on 127.0.0.1, and a bucket that refuses."""

from __future__ import annotations

import json
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from typing import Any

import fsspec
import pytest
from tests import cluster_work
from tests.programs import called

from hexdbb.fleet.columns import fleet_results

from .conftest import Judged

BUCKET = "plant"


@pytest.fixture
def store(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Serve a store with one bucket; credentials and address are those of the environment, as a user has them."""
    port = cluster_work.free_port()
    address = f"http://127.0.0.1:{port}"
    for name, value in {
        "AWS_ACCESS_KEY_ID": "tests",
        "AWS_SECRET_ACCESS_KEY": "tests",
        "AWS_DEFAULT_REGION": "us-east-1",
        "AWS_ENDPOINT_URL": address,
        "AWS_EC2_METADATA_DISABLED": "true",
    }.items():
        monkeypatch.setenv(name, value)
    with cluster_work.process("moto.server", "-H", "127.0.0.1", "-p", port):
        _wait_for(f"{address}/moto-api/")
        fsspec.get_filesystem_class("s3").clear_instance_cache()
        system = fsspec.filesystem("s3")
        system.mkdir(BUCKET)
        yield system
    fsspec.get_filesystem_class("s3").clear_instance_cache()


def _wait_for(address: str) -> None:
    for _ in range(600):
        try:
            urllib.request.urlopen(address, timeout=1.0)
        except (urllib.error.URLError, OSError):
            time.sleep(0.05)
        else:
            return
    raise TimeoutError(address)


def test_records_and_results_in_a_store(judged: Judged, store: Any) -> None:
    for name in ("m004/00000", "m004/00001", "m005/00000"):
        store.put(str(judged.records / f"{name}.parquet"), f"{BUCKET}/records/{name}.parquet")
    store.put(str(judged.records / "m004/again.csv"), f"{BUCKET}/records/m005/again.csv")
    store.put(str(judged.records / "m004/again.toml"), f"{BUCKET}/records/m005/again.toml")
    words = ("fleet", "diagnose", f"s3://{BUCKET}/records", "-o", f"s3://{BUCKET}/results", "--workers", 1)
    run = called("hexdbb", *words, "-m", judged.model)
    assert run.returncode == 0, run.stderr
    assert run.stdout.startswith(f"s3://{BUCKET}/results: 4 done in ")
    rows = {row["source"]: row for row in fleet_results(f"s3://{BUCKET}/results").table().to_pylist()}
    local = {row["source"]: row for row in fleet_results(str(judged.results)).table().to_pylist()}
    for name in ("m004/00000", "m004/00001", "m005/00000"):
        there, here = rows[f"s3://{BUCKET}/records/{name}.parquet"], local[str(judged.records / f"{name}.parquet")]
        assert {key: there[key] for key in ("record", "machine", "month", "value", "sigma")} == {
            key: here[key] for key in ("record", "machine", "month", "value", "sigma")
        }
    lost = rows[f"s3://{BUCKET}/records/m005/again.csv"]["error"]
    assert lost.startswith(f"s3://{BUCKET}/records/m005/again.toml: machine: ")
    assert "hexdbb-" not in lost  # the folder of the copy that was read
    assert (
        called("hexdbb", *words, "-m", judged.model).stdout.strip().endswith("4 of 4 were done before: nothing to do")
    )
    report = called("hexdbb", "fleet", "report", f"s3://{BUCKET}/results", "--json")
    assert json.loads(report.stdout)["records"] == 3


def test_a_bucket_that_refuses_and_one_that_is_not_there(judged: Judged, store: Any) -> None:
    deny = {"Effect": "Deny", "Principal": "*", "Action": "s3:PutObject", "Resource": f"arn:aws:s3:::{BUCKET}/*"}
    store.call_s3("put_bucket_policy", Bucket=BUCKET, Policy=json.dumps({"Version": "2012-10-17", "Statement": [deny]}))
    some = judged.records / "m000/00000.parquet"
    refused = called("hexdbb", "fleet", "diagnose", some, "-o", f"s3://{BUCKET}/results")
    assert refused.returncode == 1
    assert refused.stderr.strip().endswith(f"error: s3://{BUCKET}/results/_about.json: cannot be written: Forbidden")
    assert len(refused.stderr.splitlines()) == 1
    missing = called("hexdbb", "fleet", "diagnose", "s3://nowhere/records", "-o", "out")
    assert missing.returncode == 1
    assert missing.stderr == "error: s3://nowhere/records: cannot be listed: The specified bucket does not exist\n"
