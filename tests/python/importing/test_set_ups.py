"""Files of one set-up: one position of the cup for all, and geometry that is better determined by it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from tests.imports.one_set_up import CIRCLES, FEED_MM_MIN, PLAN, write_files

from hexdbb.cli import cli
from hexdbb.diagnosis import diagnose, fit_mounts
from hexdbb.errors import InputError
from hexdbb.importing import mapping_of, read_measured, save_mapping
from hexdbb.logbook import content_of
from hexdbb.model import new_model
from hexdbb.plan import Mount, Plan, load_plan
from hexdbb.record import Record, read_record, write_record
from hexdbb.samples import Samples
from hexdbb.trend.joint import JointFit, Part, fit_together, started


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    return write_files(tmp_path_factory.mktemp("files"), with_mapping=False)


def read(files: list[Path], mount: str | None = None) -> list[Record]:
    return [
        read_measured(path, mapping_of(plan=PLAN, circle=circle, feed_mm_min=FEED_MM_MIN, mount=mount))
        for path, circle in zip(files, CIRCLES.values(), strict=True)
    ]


def sigmas_mm(records: list[Record]) -> np.ndarray:
    samples = Samples.of(records)
    found = diagnose(samples, new_model(samples.machine, ["platform_side", "cup_position"]), check_held_out=False)
    (sides,) = (term for term in found.model.terms if term.effect == "platform_side")
    return sides.sigma


def test_shared_geometry_is_better_determined_by_files_of_one_set_up(files: list[Path]) -> None:
    apart, together = read(files), read(files, "bench")
    assert len(Samples.of(apart).mounts) == 3
    assert len(Samples.of(together).mounts) == 1
    assert (sigmas_mm(together) < 0.5 * sigmas_mm(apart)).all()


def test_records_fitted_over_time_share_it_too(files: list[Path]) -> None:
    def fitted(records: list[Record]) -> JointFit:
        parts = [Part.of(Samples.of([record])) for record in records]
        return fit_together(parts, started(parts, new_model(records[0].machine, ["platform_side", "cup_position"])))

    apart, together = fitted(read(files)), fitted(read(files, "bench"))
    sides = slice(0, 3)
    assert [each.effect for each in together.models[0].parameters()[sides]] == ["platform_side"] * 3
    sigma_apart, sigma = (np.sqrt(np.diag(each.solution.covariance))[sides] for each in (apart, together))
    assert (sigma < 0.5 * sigma_apart).all()
    for model in together.models[1:]:
        np.testing.assert_array_equal(model.values, together.models[0].values)


def test_records_of_which_some_share_a_set_up_keep_their_own_beside(files: list[Path]) -> None:
    records = [*read(files, "bench")[:2], read(files)[2]]
    parts = [Part.of(Samples.of([record])) for record in records]
    fit = fit_together(parts, started(parts, new_model(records[0].machine, ["platform_side", "cup_position"])))
    assert [len(model.mounts) for model in fit.models] == [1, 1, 2]
    first, second, third = (model.values for model in fit.models)
    np.testing.assert_array_equal(first, second)
    np.testing.assert_array_equal(third[: len(first)], first)
    assert (third[len(first) :] != 0.0).any()


def test_a_set_up_is_fitted_once_where_the_model_does_not_know_it(files: list[Path]) -> None:
    samples = Samples.of(read(files, "bench"))
    model, said = fit_mounts(samples, new_model(samples.machine, ["leg_length"]))
    assert len(model.mounts) == 1
    (sentence,) = said
    assert all(str(path) in sentence for path in files)


def test_the_name_is_kept_in_every_format_and_leaves_a_record_what_it_is(files: list[Path], tmp_path: Path) -> None:
    plain, named = read(files)[0], read(files, "bench")[0]
    assert named.content_hash() == plain.content_hash()
    for name in ("record.parquet", "record.csv", "record.xlsx"):
        write_record(named, tmp_path / name)
        assert read_measured(tmp_path / name).mounts == named.mounts
    assert content_of(tmp_path / "record.parquet").sha256 == plain.content_hash()


def test_a_record_of_its_own_is_given_a_name_too(files: list[Path], tmp_path: Path) -> None:
    write_record(read(files)[0], tmp_path / "record.parquet")
    (mount,) = read_measured(tmp_path / "record.parquet", mapping_of(mount="bench")).mounts
    assert mount.fixing == "bench"


@pytest.mark.parametrize("key", ["cup_mm", "bar_length_mm"])
def test_files_of_one_set_up_that_contradict_are_refused(files: list[Path], key: str) -> None:
    first, other, _ = read(files, "bench")
    if key == "cup_mm":
        wrong = replace(other, mounts=(Mount(id=0, cup_mm=(0.0, 0.0, 350.0), fixing="bench"),))
        value, expected = "[0.0, 0.0, 350.0]", "[0.0, 0.0, 340.0]"
    else:
        wrong = replace(other, gauge=other.gauge.model_copy(update={"bar_length_mm": 150.0}))
        value, expected = "150.0", "100.0"
    with pytest.raises(InputError) as caught:
        Samples.of([first, wrong])
    where = f'{files[1]}: mount 0, fixing "bench": {key}: {value}'
    assert str(caught.value) == f"{where} (expected {expected}, as in {files[0]}; another set-up needs another name)"


def test_commands_say_what_counts_as_one_set_up(files: list[Path], tmp_path: Path) -> None:
    for path, circle in zip(files, CIRCLES.values(), strict=True):
        mapping = mapping_of(plan=PLAN, circle=circle, feed_mm_min=FEED_MM_MIN)
        save_mapping(mapping, path.with_suffix(".toml"), overwrite=True)
    words = ["compare", "--no-plot", *map(str, files)]
    apart = CliRunner().invoke(cli, words)
    assert apart.exit_code == 0, apart.output
    assert "3 files, each with a set-up of its own (--mount NAME: the cup was not touched between them)" in apart.stderr
    together = CliRunner().invoke(cli, [*words, "--mount", "bench"])
    assert f'{", ".join(map(str, files))}: one set-up, "bench"' in together.stderr
    assert "set-up of its own" not in together.stderr


def test_the_logbook_keeps_the_name(files: list[Path], tmp_path: Path) -> None:
    book = tmp_path / "glider"
    options = ["--plan", "standard", "--circle", "0", "--mount", "march", "--date", "2026-03-01"]
    mapping = files[0].with_suffix(".toml")
    save_mapping(mapping_of(feed_mm_min=FEED_MM_MIN), mapping, overwrite=True)
    added = CliRunner().invoke(cli, ["log", "add", str(book), str(files[0]), *options])
    assert added.exit_code == 0, added.output
    (kept,) = (book / "records").iterdir()
    assert [mount.fixing for mount in read_record(kept).mounts] == ["march"]


def test_a_plan_may_name_a_cup_that_stays(files: list[Path]) -> None:
    plan = load_plan("thesis")
    stays = plan.model_dump(by_alias=True, exclude_none=True)
    stays["mount"] = [{**each, "fixing": "table"} for each in stays["mount"]]
    assert Plan.model_validate(stays).mounts[0].fixing == "table"


def test_a_record_in_the_logbook_keeps_its_set_up_and_says_so(files: list[Path], tmp_path: Path) -> None:
    write_record(read(files, "bench")[0], tmp_path / "record.parquet")
    words = ["log", "add", str(tmp_path / "glider"), str(tmp_path / "record.parquet"), "--date", "2026-03-01"]
    for options, note in (
        ([], ""),
        (["--mount", "bench"], ""),
        (["--mount", "other"], 'keeps "bench" (--mount other: '),
    ):
        added = CliRunner().invoke(cli, [*words, *options])
        assert added.exit_code == 0, added.output
        assert note in added.stderr
        assert ("keeps" in added.stderr) == bool(note)
