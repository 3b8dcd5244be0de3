"""`hexdbb compensate`: a compensation file for motion controllers, or the same correction applied to a path."""

from __future__ import annotations

import json
from pathlib import Path

import click
import numpy as np

from hexdbb import _core
from hexdbb.cli.consoles import message_console, say
from hexdbb.cli.effects_option import effects_option
from hexdbb.cli.existing_model import existing_model
from hexdbb.compensation import (
    MAX_CORRECTION_MM,
    REVERSAL_TRAVEL_MM,
    SUFFIX,
    make_compensation,
    path_targets,
    read_compensation,
    read_poses,
    reference_temperature_of,
    sliders_csv,
    write_compensation,
)
from hexdbb.errors import InputError
from hexdbb.files.atomic_file import refuse_existing, write_text
from hexdbb.importing import read_measured
from hexdbb.model import Model

POSITIVE = click.FloatRange(min=0.0, min_open=True)


@click.command("compensate")
@click.argument("model", type=click.Path(path_type=Path))
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="Compensation file to write (NAME.hexcomp); with --poses, the table of slider coordinates.",
)
@click.option("--poses", type=click.Path(path_type=Path), help="CSV of poses in order of motion.")
@click.option(
    "--header", type=click.Path(path_type=Path), help="C header of constants to write, for firmware without files."
)
@click.option(
    "--max-correction-um",
    type=POSITIVE,
    default=1e3 * MAX_CORRECTION_MM,
    show_default=True,
    help="Largest correction of one slider, µm; controllers refuse poses that need more.",
)
@click.option(
    "--reversal-travel-um",
    type=POSITIVE,
    default=1e3 * REVERSAL_TRAVEL_MM,
    show_default=True,
    help="Travel after a reversal over which a direction-dependent correction changes over, µm.",
)
@click.option(
    "--reference-temperature-c",
    type=float,
    help="Temperature at the fitted record's first sample, °C; without it temperature-dependent effects are left out.",
)
@click.option(
    "--reference",
    "reference_path",
    metavar="RECORD",
    type=click.Path(path_type=Path),
    help="The record to which the model was fitted: its first temperature is the reference temperature.",
)
@effects_option
@click.option("--temperature-c", type=float, help="With --poses: the measured temperature, °C.")
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object on stdout.")
def command(
    model: Path,
    output: Path | None,
    poses: Path | None,
    header: Path | None,
    max_correction_um: float,
    reversal_travel_um: float,
    reference_temperature_c: float | None,
    reference_path: Path | None,
    effects_path: Path | None,
    temperature_c: float | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Write the part of MODEL that a motion controller can correct, or apply the correction to a path.

    MODEL is a model file, or a compensation file (NAME.hexcomp) made from one. Learned effects, and users' effects
    (--effects) that are functions of one variable, go in as tables. Effects that belong to the measurement, or that
    depend on a quantity the controller does not know, are left out and listed with the reason.

    POSES has the columns x_mm, y_mm, z_mm, roll_deg, pitch_deg, yaw_deg; the table written has s1_mm to s6_mm, one row
    per pose. Poses have no times, so that speed-dependent errors (lags) are not corrected in this table.

    \b
    Examples:
      hexdbb compensate model.toml -o sp120.hexcomp
      hexdbb compensate model.toml --header compensation_constants.h
      hexdbb compensate model.toml --poses path.csv -o sliders.csv
    """
    if output is None and header is None:
        raise InputError("hexdbb compensate: nothing to write (expected -o FILE, --header FILE.h or both)")
    if poses is not None and output is None:
        raise InputError("hexdbb compensate: --poses without -o (expected -o SLIDERS.csv)")
    for path in filter(None, (output, header)):
        refuse_existing(path, overwrite)
    with message_console().status("computing compensation"):
        if model.suffix == SUFFIX:
            data = read_compensation(model)
        else:
            known = existing_model(model, effects_path)
            if reference_path is not None:
                reference_temperature_c = _reference_temperature_c(known, reference_path, reference_temperature_c)
            data = make_compensation(
                known,
                max_correction_mm=1e-3 * max_correction_um,
                reversal_travel_mm=1e-3 * reversal_travel_um,
                reference_temperature_c=reference_temperature_c,
            )
        summary = _summary(data)
        if output is not None and poses is not None:
            summary |= _correct_path(data, poses, output, temperature_c)
        elif output is not None:
            write_compensation(data, output)
    if header is not None:
        write_text(header, data.header())
    say(json.dumps(summary, indent=2, allow_nan=False) if as_json else _table(summary))


def _reference_temperature_c(model: Model, path: Path, stated_c: float | None) -> float:
    if stated_c is not None:
        raise InputError(f"--reference {path} together with --reference-temperature-c: expected one of them")
    return reference_temperature_of(model, read_measured(path))


def _correct_path(
    data: _core.CompensationData, poses: Path, output: Path, temperature_c: float | None
) -> dict[str, object]:
    table = read_poses(poses)
    targets = path_targets(
        data,
        table[:, :3],
        np.radians(table[:, 3:]),
        temperature_c=np.nan if temperature_c is None else temperature_c,
        name=str(poses),
    )
    write_text(output, sliders_csv(targets.sliders_mm))
    return {"poses": len(table), "largest_correction_um": 1e3 * float(np.abs(targets.correction_mm).max())}


def _summary(data: _core.CompensationData) -> dict[str, object]:
    return {
        "machine": data.name,
        "corrected": data.effects,
        "tables": [
            {
                "effect": each.effect,
                "port": each.port,
                "variable": each.variable,
                "times": each.times,
                "knots": len(each.knots),
                "largest_um": 1e3 * max(map(abs, each.values_mm)),
            }
            for each in data.tables
        ],
        "left_out": [{"effect": effect, "reason": reason} for effect, reason in data.left_out],
        "max_correction_um": 1e3 * data.max_correction_mm,
        "reversal_travel_um": 1e3 * data.reversal_travel_mm,
    }


def _table(summary: dict[str, object]) -> str:
    corrected, tables, left_out = summary["corrected"], summary["tables"], summary["left_out"]
    assert isinstance(corrected, list)
    assert isinstance(tables, list)
    assert isinstance(left_out, list)
    lines = [f"machine      {summary['machine']}", f"corrected    {', '.join(corrected) or 'nothing'}"]
    lines += [f"table        {_table_words(each)}" for each in tables]
    lines += [f"left out     {each['effect']}: {each['reason']}" for each in left_out]
    lines.append(f"limit        {summary['max_correction_um']:g} µm per slider")
    if "poses" in summary:
        lines.append(
            f"path         {summary['poses']} poses, corrected by up to {summary['largest_correction_um']:.1f} µm"
        )
    return "\n".join(lines)


def _table_words(table: dict[str, object]) -> str:
    """Return one table as "learned:leg:5:turning_rate: leg by slider_joint_rate_rad_s, 82 knots, up to 8.1 µm"."""
    of = " times ".join(filter(None, (str(table["times"]), str(table["variable"])))) or "nothing"
    return f"{table['effect']}: {table['port']} by {of}, {table['knots']} knots, up to {table['largest_um']:.1f} µm"
