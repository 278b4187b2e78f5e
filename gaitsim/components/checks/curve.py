"""Checks of declared curves against the names of the component file."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from gaitsim.component import Curve, Declaration, Input, Output, Parameter, State
from gaitsim.errors import did_you_mean

TIME = "time"
_READ = Parameter | Input | State | Output


def curve_faults(
    name: str, curve: Curve, known: Mapping[str, Declaration], functions: Mapping[str, ast.FunctionDef]
) -> Iterator[str]:
    """The messages for names in a curve that the file does not have."""
    low, high = curve.span
    if not low < high:
        yield f"{name}: span {curve.span} is not a range; write the lower end first."
    outputs = {n for n, one in known.items() if isinstance(one, Output)}
    if curve.of not in outputs | set(functions):
        hint = did_you_mean(curve.of, outputs | set(functions))
        yield f"{name}: of names {curve.of}, which is neither an output nor a function of this file. {hint}"
        return
    named = [curve.over, *curve.at, *([curve.each[0]] if curve.each else [])]
    if curve.of in outputs:
        names = {n for n, one in known.items() if isinstance(one, _READ)}
        inputs = {n for n, one in known.items() if isinstance(one, Input)}
        wrong = [word for word in named if word not in names | {TIME}]
        wrong += [word for word in curve.steps if word not in inputs]
    else:
        names = {argument.arg for argument in functions[curve.of].args.args}
        wrong = [word for word in named if word not in names] + list(curve.steps)
        parameters = {n for n, one in known.items() if isinstance(one, Parameter)}
        for missing in sorted(names - set(named) - parameters):
            yield f"{name}: {curve.of} also takes {missing}; give it a value in at."
    for word in wrong:
        yield f"{name}: {curve.of} does not depend on {word}. {did_you_mean(word, names)}"
    for word, value in curve.at.items():
        if isinstance(value, str) and not isinstance(known.get(value), Parameter):
            hint = did_you_mean(value, [n for n, one in known.items() if isinstance(one, Parameter)])
            yield f"{name}: {word} is to be {value}, which is not a parameter. {hint}"
