"""A study as a page of the documentation: what was simulated, the answer, the picture, the tables."""

from __future__ import annotations

import textwrap

from hexdbb.studies.setting import Setting
from hexdbb.studies.study import Result, Sheet
from hexdbb.studies.thesis.markdown import markdown_table

WIDTH = 120
"""Longest line of the page, the same as in the sources."""
PAGE = """\
# {title}

{setting}

{answer}

![{title}]({picture})

{sheets}
{notes}
Made by `{command}`.
"""


def study_page(title: str, setting: Setting, result: Result, picture: str, command: str) -> str:
    """Return the page of a study as Markdown.

    Parameters
    ----------
    title : str
    setting : Setting
    result : Result
    picture : str
        Link to the picture.
    command : str
        What made the page.
    """
    return PAGE.format(
        title=title,
        setting=textwrap.fill(setting_text(setting), WIDTH),
        answer="\n".join(f"- {sentence}" for sentence in result.answer),
        picture=picture,
        sheets="\n\n".join(_sheet(each) for each in result.sheets),
        notes="".join(f"\n{textwrap.fill(note, WIDTH)}\n" for note in result.notes),
        command=command,
    )


def setting_text(setting: Setting) -> str:
    """Return in words which machines are measured how."""
    spread, plan, gauge = setting.file.machine_errors, setting.plan, setting.gauge
    feeds = " and ".join(f"{feed:g}" for feed in plan.feeds_mm_min)
    return (
        f"Random machines of {setting.machine.name}: errors of geometry of {spread.length_um:g} µm and"
        f" {spread.rotation_urad:g} µrad, platform sides {spread.platform_side_um:g} µm, cup misplaced by"
        f" {spread.cup_um:g} µm, ball by {spread.ball_um:g} µm (one standard deviation each). Plan {setting.file.plan}:"
        f" {len(plan.circles)} circles at {feeds} mm/min, laps {plan.laps}, {setting.file.rate_hz:g} readings a second;"
        f" gauge noise {gauge.noise_um:g} µm, resolution {gauge.resolution_um:g} µm. The truth shares no code with the"
        " engine that judges it."
    )


def _sheet(sheet: Sheet) -> str:
    title = f"{sheet.title[0].upper()}{sheet.title[1:]}"
    return f"## {title}\n\n{markdown_table(sheet.head, sheet.rows, left=sheet.names)}".rstrip()
