"""The handbook: a page for every effect, made from its description; an index of all.

Values are shown in the units of files and tables (`hexdbb.units`). The pictures are drawn in `signature`.
"""

from __future__ import annotations

from hexdbb import _core
from hexdbb.kinematics import engine_machine
from hexdbb.machine import MachineFile, shipped_machine
from hexdbb.units import readable_unit, shown_factor, shown_unit

INDEX = "README.md"
GROUPS = {
    "geometry": "The thesis' 33 geometric errors",
    "set-up": "Unknowns of the set-up",
    "places": "Unknowns of the set-up where the ball had several places on the platform within one mount",
    "catalogue": "Physical causes beyond geometry",
}
"""Groups of effects and their headings, in the order of the index."""
MADE = "Made by `hexdbb effects handbook`; do not edit.\n"
SYMBOLS = (
    "Left: the [port](../glossary.md#models) that is pushed. Right: parameters of the effect, "
    "[columns of the state](../glossary.md#columns-of-the-state) without their units, and s, the slider coordinate."
)
SOURCES = "../../cpp/src/effects"
"""Folder of the effects' source files, seen from the pages; each file is called as its effect."""
CAPTION = (
    "Change of the reading on the thesis' level circle, run 0.1 mm off the bar's length, with {sizes}, one at a time, "
    "at element {element}; left against the polar angle, right magnified about the circle."
)


def effect_infos(machine: MachineFile | None = None) -> list[_core.EffectInfo]:
    """Return the description of every effect the engine knows, for one mount."""
    engine = engine_machine(machine if machine is not None else shipped_machine())
    return [_core.effect_info(engine, 1, name) for name in _core.effect_names()]


def handbook() -> dict[str, str]:
    """Return the text of every page, by file name."""
    infos = effect_infos()
    return {INDEX: _index(infos), **{f"{info.name}.md": _page(info) for info in infos}}


def shown_size(parameter: _core.ParameterInfo) -> str:
    """Return the prior standard deviation of a parameter with its unit, for people."""
    # Three digits, and thousands written out.
    size = float(f"{parameter.prior_sigma * shown_factor(parameter.unit):.3g}")
    return f"{size:g} {readable_unit(shown_unit(parameter.unit))}"


def _index(infos: list[_core.EffectInfo]) -> str:
    lines = ["# Effects", "", MADE, "A model is a machine plus a list of effects. These are the ones hexdbb knows.", ""]
    for group, heading in GROUPS.items():
        lines += [f"## {heading}", "", "| effect | elements | parameters | physics |", "|---|---|---|---|"]
        for info in infos:
            if info.group == group:
                names = ", ".join(each.name for each in info.parameters)
                lines.append(f"| [`{info.name}`]({info.name}.md) | {_elements(info)} | {names} | {info.physics} |")
        lines.append("")
    return "\n".join(lines)


def _page(info: _core.EffectInfo) -> str:
    lines = [f"# {info.name}", "", MADE, info.physics, "", f"    {info.formula}", "", SYMBOLS, ""]
    lines.append(f"Source: {info.source}. Written in [`{info.name}.cpp`]({SOURCES}/{info.name}.cpp).")
    lines += ["", "| | |", "|---|---|", f"| elements | {_elements(info)} |"]
    lines.append(f"| pushes at | {', '.join(f'`{each}`' for each in info.ports)} |")
    lines.append(f"| depends on | {', '.join(f'`{each}`' for each in info.needs) or 'the sliders alone'} |")
    kind = "the measurement: never compensated" if info.is_set_up else "the machine"
    lines += [f"| belongs to | {kind} |", ""]
    lines += ["| parameter | unit | prior standard deviation | domain |", "|---|---|---|---|"]
    for each in info.parameters:
        factor = shown_factor(each.unit)
        shape = " (shapes the others)" if each.is_shape else ""
        domain = f"{each.lower * factor:.4g} … {each.upper * factor:.4g}"
        unit = readable_unit(shown_unit(each.unit))
        lines.append(f"| `{each.name}`{shape} | {unit} | {each.prior_sigma * factor:.4g} | {domain} |")
    drawn = ", ".join(f"{each.name} = {shown_size(each)}" for each in info.parameters if not each.is_shape)
    lines += ["", f"![What {info.name} does to a circle](images/{info.name}.png)", ""]
    lines += [CAPTION.format(sizes=drawn, element=info.elements[0]), ""]
    return "\n".join(lines)


def _elements(info: _core.EffectInfo) -> str:
    per_set_up = {"mount": "one for each mount"}
    if info.element_kind in per_set_up:
        return per_set_up[info.element_kind]
    if len(info.elements) == 1:
        return "one for the whole machine"
    return f"{info.element_kind} {', '.join(info.elements)}"
