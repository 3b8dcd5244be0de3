"""A learned effect written down as a user's effect: Python source, ready to be given physics.

Where the function has a form (`hexdbb.learned.describe`), the draft is that form with shape parameters to be fitted,
else a table of its values. The name is the learned one's place and variable; everything else is a number.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hexdbb.errors import InputError
from hexdbb.learned import Curve, Form, Space, describe
from hexdbb.learned.forms import Fit
from hexdbb.learned.shown import place_words
from hexdbb.learned.variable import BENT, ELAPSED, is_growing
from hexdbb.machine import MachineFile
from hexdbb.model import Model
from hexdbb.samples import PUSH_SHAPES

Floats = NDArray[np.float64]

HEAD = '''"""Effects drafted from what was learned: give each its physics, then name this file with `--effects`."""

import numpy as np

from hexdbb.effects import Shape, effect
'''
SHAPE_PART = 0.2
"""Prior standard deviation of a width or period, of its size: a draft starts where the learned function has it."""
ROUNDED = 7
"""Significant digits of numbers in a draft: a table's values to a part in a million of the largest."""


def draft(model: Model, name: str) -> str:
    """Return the source of a user's effect that pushes what a learned one of a model pushes.

    One unit of its value (1 mm) is 1 mm of the height of the form, or of the largest value of the table.

    Raises
    ------
    InputError
        Where the model has no learned effect of that name.
    """
    term = model.term(name)
    if term is None or term.learned is None:
        raise InputError(f"{name}: no learned effect of {model.name} (expected the name of one it has)")
    space = term.learned.space
    parts = [HEAD]
    for function, curve in enumerate(term.learned.curves(term.values)):
        parts.append(_effect(space, curve, describe(curve, space.period), function, model.machine))
    return "\n\n".join(parts)


def drafted_name(space: Space, function: int) -> str:
    """Return the name of the drafted effect: ``learned_leg_5_turning_rate``."""
    part = space.hypothesis.part_name(function)
    return "_".join(filter(None, (re.sub(r"\W", "_", space.hypothesis.name), part)))


def _effect(space: Space, curve: Curve, form: Form, number: int, machine: MachineFile) -> str:
    height, shapes, function = _function(space, curve, form)
    port, count = space.hypothesis.port, max(abs(height), 1e-6)
    declared = f'@effect(port="{port}", unit="mm", prior_sigma={_number(count)}'
    if shapes:
        declared += ", shapes={\n" + "".join(f"    {each},\n" for each in shapes) + "}"
    arguments = ", ".join(["samples", *(each.split('"')[1] for each in shapes)])
    lines = [
        f"{declared})",
        f"def {drafted_name(space, number)}({arguments}):",
        f'    """{place_words(space.hypothesis, number)}: {form.text}.',
        "",
        f"    As learned its value is {_number(height)} mm.",
        '    """',
        *(f"    {line}".rstrip() for line in function),
        f"    push = np.zeros((len(samples), {int(np.prod(PUSH_SHAPES[port], dtype=int))}))",
        f"    for element, pushed in {_pushed(space, number, machine)}:",
        *(f"        {line}" for line in _value(space, curve.times)),
        "        for column, weight in pushed:",
        f"            push[:, column] += {_weight(space, number)} * value",
        f"    return push.reshape(len(samples), *{PUSH_SHAPES[port]!r})",
    ]
    return "\n".join(lines) + "\n"


def _pushed(space: Space, function: int, machine: MachineFile) -> str:
    """Return elements and columns of the port, counted within it, as source."""
    pushes = space.hypothesis.pushes(space.hypothesis.component_of(function), machine)
    width = {port: int(np.prod(shape, dtype=int)) for port, shape in PUSH_SHAPES.items()}
    ports = list(PUSH_SHAPES)
    first = sum(width[port] for port in ports[: ports.index(space.hypothesis.port)])
    return repr([(each, [(port - first, weight) for port, weight in columns]) for each, columns in pushes])


def _weight(space: Space, function: int) -> str:
    """Return by what a column is pushed, as source: a load by its share in every sample."""
    lever = space.hypothesis.lever(space.hypothesis.component_of(function))
    return f'weight * samples["{lever}"][:, column]' if lever else "weight"


def _value(space: Space, times: str) -> list[str]:
    """Return the lines that evaluate the function, with the column that multiplies, for one element, as ``value``."""
    variable = space.hypothesis.variable
    lines = ["value = np.ones(len(samples))"]
    if variable.column:
        of_two = f"x[:, element if x.shape[1] == 6 else {variable.axis}]"
        lines = [f'x = samples["{variable.state}"]', f"x = {of_two} if x.ndim == 2 else x"]
        if variable.period:
            lines.append(f"x = np.mod(x, {_number(space.period)})")
        if variable.lingers_s:
            acting = ["def acting(samples):", *(f"    {line}" for line in lines), "    return function(x)"]
            standing = ", standing=function(np.zeros(1))" if variable.is_zero_at_rest else ""
            lines = [*acting, f"value = samples.lingering(acting, {_number(variable.lingers_s)}{standing})"]
        else:
            lines.append("value = function(x)")
    if is_growing(times):
        lines.append(f'grown = (samples["time_s"] - {_number(space.since_s)}) / {_number(space.span_s)}')
        lines.append(f"value = value * {_grown(space)}")
    elif times:
        lines.append(f'times = samples["{times}"]')
        lines.append("value = value * (times[:, element] if times.ndim == 2 else times)")
    return lines


def _grown(space: Space) -> str:
    """Return how far a growing function has grown, as source, by the part of its time that has gone: ``grown``."""
    times = space.hypothesis.variable.times
    if times in (ELAPSED, BENT):
        return "grown" if times == ELAPSED else "4.0 * grown * (1.0 - grown)"
    spans = _number(space.span_s / float(times.partition("@")[2]))
    return f"np.expm1(-{spans} * grown) / np.expm1(-{spans})"


def _function(space: Space, curve: Curve, form: Form) -> tuple[float, list[str], list[str]]:
    """Return the height (mm), the shapes and the lines of ``function``, of unit height."""
    fit = form.fit
    if not curve.column:
        return float(curve.value_mm[0]), [], []
    if fit is None or fit.kind == "step":
        return _table(curve)
    # The constant beside a form belongs to it: as a part of its height, or the push would not be the learned one.
    height = _height(fit)
    base = _number(fit.constant / height)
    unit = space.hypothesis.variable.unit or "1"
    if fit.kind == "linear":
        return height, [], _body(f"{base} + x")
    if fit.kind == "sine":
        phase = float(np.arctan2(fit.coefficients[1], fit.coefficients[0]))
        (period,) = map(float, fit.shapes)
        shapes = [
            f'"period": Shape({_number(period)}, prior_sigma={_number(SHAPE_PART * period)}, lower=0.0, unit="{unit}")',
            f'"phase": Shape({_number(phase)}, prior_sigma=1.0, unit="rad")',
        ]
        return height, shapes, _body(f"{base} + np.sin(2.0 * np.pi * x / period + phase)")
    if fit.kind == "dead band":
        return height, *_dead_band(fit, base, height, unit, float(np.ptp(curve.at)))
    centre, width = map(float, fit.shapes)
    shapes = [
        f'"centre": Shape({_number(centre)}, prior_sigma={_number(width)}, unit="{unit}")',
        f'"width": Shape({_number(width)}, prior_sigma={_number(SHAPE_PART * width)}, lower=0.0, unit="{unit}")',
    ]
    return height, shapes, _body(f"{base} + np.exp(-4.0 * np.log(2.0) * ((x - centre) / width) ** 2)")


def _height(fit: Fit) -> float:
    """Return the size of a form, mm; of a dead band mm per unit of its variable, on the steeper side."""
    if fit.kind == "sine":
        return float(np.hypot(*fit.coefficients))
    return float(fit.coefficients[np.argmax(np.abs(fit.coefficients))])


def _dead_band(fit: Fit, base: str, height: float, unit: str, span: float) -> tuple[list[str], list[str]]:
    """Return the shapes and the lines of a function that is constant between two values, and linear outside them.

    The priors are parts of the variable's range, and the width has no bound: the band may begin at zero, or be a mere
    change of slope of width zero, on which a bound would be refused.
    """
    low, width = map(float, fit.shapes)
    below, above = (_number(each / height) for each in fit.coefficients)
    sigma = _number(SHAPE_PART * span)
    shapes = [
        f'"low": Shape({_number(low)}, prior_sigma={sigma}, unit="{unit}")',
        f'"width": Shape({_number(width)}, prior_sigma={sigma}, unit="{unit}")',
    ]
    return shapes, _body(f"{base} + {below} * np.minimum(x - low, 0.0) + {above} * np.maximum(x - low - width, 0.0)")


def _table(curve: Curve) -> tuple[float, list[str], list[str]]:
    height = float(curve.value_mm[np.argmax(np.abs(curve.value_mm))]) or 1.0
    lines = [f"knots = {_numbers(curve.at)}", f"values = {_numbers(curve.value_mm / height)}"]
    return height, [], [*lines, *_body("np.interp(x, knots, values)")]


def _body(expression: str) -> list[str]:
    return ["", "def function(x):", f"    return {expression}", ""]


def _number(value: float) -> str:
    return repr(float(f"{value:.{ROUNDED}g}"))


def _numbers(values: Floats | Sequence[float]) -> str:
    return f"[{', '.join(_number(float(each)) for each in values)}]"
