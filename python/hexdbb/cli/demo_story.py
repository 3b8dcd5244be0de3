"""What `hexdbb demo` does: chapters of stages, each a title and the commands that a user would type."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """A fault of a simulated machine: TOML appended to its truth file, of which no model knows."""

    file: str
    toml: str


@dataclass(frozen=True)
class Chapter:
    """One machine: stages by their titles, and the commands to go on with by hand.

    Commands name the demo's folder ``{folder}`` and the readings per second of machine time ``{rate}``.
    """

    stages: dict[str, tuple[str | Fault, ...]]
    by_hand: tuple[str, ...] = ()


CIRCLE = Chapter(
    {
        "One level circle: measure, diagnose, compare": (
            "hexdbb-run --plan thesis -o {folder}/demo.parquet",
            "hexdbb diagnose {folder}/demo.parquet -m {folder}/demo-model.toml",
            "hexdbb compare {folder}/demo.parquet -m {folder}/demo-model.toml",
        )
    }
)
HIDDEN = Chapter(
    {
        "A machine with a hidden fault: slider 4 has 15 µm of play between drive and slider": (
            "hexdbb rig --seed 11 --write-truth {folder}/hidden.toml --no-serve",
            Fault("hidden.toml", '[[mechanism]]\nkind = "backlash"\nslider = 4\nwidth_um = 15.0\n'),
            "hexdbb-run --plan standard --rate {rate} --truth {folder}/hidden.toml -o {folder}/today.parquet",
        ),
        "Geometry alone does not explain the readings": (
            "hexdbb diagnose {folder}/today.parquet -m {folder}/model.toml",
            "hexdbb compare {folder}/today.parquet -m {folder}/model.toml --plot {folder}/before",
        ),
        "What is missing?": (
            "hexdbb discover {folder}/today.parquet -m {folder}/model.toml",
            "hexdbb add backlash:4 -m {folder}/model.toml {folder}/today.parquet",
        ),
        "Is anything still missing?": (
            "hexdbb discover {folder}/today.parquet -m {folder}/model.toml",
            "hexdbb history -m {folder}/model.toml",
        ),
        "One page to hand over": (
            "hexdbb report {folder}/today.parquet -m {folder}/model.toml -o {folder}/report.html --tolerance G(b)=80",
        ),
    },
    ("hexdbb workbench {folder}/today.parquet -m {folder}/model.toml",),
)
DENT = Chapter(
    {
        "A fault that no formula knows: guideway 1 has a dent, 30 µm deep": (
            "hexdbb rig --seed 11 --write-truth {folder}/dent.toml --no-serve",
            Fault(
                "dent.toml",
                '[[mechanism]]\nkind = "dent"\nguideway = 1\ndepth_um = 30.0\nat_mm = 250.0\nwidth_mm = 10.0\n',
            ),
            "hexdbb-run --plan standard --rate {rate} --truth {folder}/dent.toml -o {folder}/dented.parquet",
            "hexdbb diagnose {folder}/dented.parquet -m {folder}/dent-model.toml",
        ),
        "No known effect is the cause: its function is learned, added, and nothing is missing": (
            "hexdbb discover {folder}/dented.parquet -m {folder}/dent-model.toml --plot {folder}/dent",
            "hexdbb add learned:vertical:1:fine_position -m {folder}/dent-model.toml {folder}/dented.parquet",
            "hexdbb discover {folder}/dented.parquet -m {folder}/dent-model.toml",
            "hexdbb compensate {folder}/dent-model.toml -o {folder}/dent.hexcomp",
        ),
    },
    ("hexdbb workbench {folder}/dented.parquet -m {folder}/dent-model.toml",),
)
CHAPTERS = (CIRCLE, HIDDEN, DENT)
