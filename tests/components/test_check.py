"""What a component file may hold, and the words when it does not."""

from __future__ import annotations

import pytest

from gaitsim.component import Component
from gaitsim.components.checks.check import check_names, parse
from gaitsim.errors import InvalidComponent

IMPORT = "import math\nfrom gaitsim.component import *\n"
HEAD = """import math
from gaitsim.component import Component, Input, Metric, Option, Output, Parameter, Points, State

LIMIT = 2.5

def half(value):
    return value / 2

class Probe(Component):
    gain = Parameter("1", "A gain.", default=1, bounds=(0, 2))
    points = Points("Places.")
    excitation = Input("1", "Drive.")
    length = State("m", "Length.")
    force = Output("N", "Force.")
"""
STATES = "x.length is assigned in output; states are set in start, update and reset only."
OUTPUT = "    @staticmethod\n    def output(p, u, x, y):\n        y.force = 0\n"


def faults_of(source: str) -> list[str]:
    tree = parse(source, "hill.py")
    space: dict[str, object] = {"__name__": "probe"}
    exec(compile(source, "hill.py", "exec"), space)
    classes = [v for v in space.values() if isinstance(v, type) and issubclass(v, Component)]
    declarations = next(c for c in classes if c is not Component).declarations
    found = check_names(tree, declarations, "hill.py", source.splitlines())
    assert all(fault.mark is not None and fault.mark.file == "hill.py" for fault in found)
    return [fault.message for fault in found]


def function(signature: str, *lines: str) -> str:
    body = "\n".join(f"        {line}" for line in lines)
    return f"    @staticmethod\n    def {signature}:\n{body}\n"


def output(*lines: str) -> list[str]:
    return faults_of(HEAD + function("output(p, u, x, y)", *lines, "y.force = 0"))


def refused(source: str) -> str:
    with pytest.raises(InvalidComponent) as caught:
        parse(source, "hill.py")
    return str(caught.value)


def test_a_clean_file_has_no_faults() -> None:
    lines = ["t = half(p.gain) + LIMIT * u.excitation", "if t > 0:", "    y.force = math.exp(t)"]
    assert output(*lines) == []


def test_an_undeclared_name_is_shown_with_line_and_caret() -> None:
    source = HEAD + function("output(p, u, x, y)", "y.force = u.exitation")
    tree = parse(source, "hill.py")
    space: dict[str, object] = {"__name__": "probe"}
    exec(source, space)
    declarations = space["Probe"].declarations  # type: ignore[attr-defined]
    (fault,) = check_names(tree, declarations, "hill.py", source.splitlines())
    assert str(fault) == (
        "hill.py:17:19: u.exitation is not declared. Did you mean u.excitation?\n"
        "   17 |         y.force = u.exitation\n"
        "      |                   ^"
    )


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("t = u.q", "u.q is not declared. Known here: u.excitation."),
        ("t = u.force", "u.force is not an input: force is an output; write y.force."),
        ("t = p.points", "p.points is a list of points; it is known in build only."),
        ("p.gain = 1", "p.gain is assigned in output; parameters are read only."),
        ("u.excitation += 1", "u.excitation is assigned in output; inputs are read only."),
        ("x.length = 1", STATES),
        ("x.length[0] = 1", STATES),
        ("t = gian + LIMIT", "gian is not defined. Known here: LIMIT, half, math, p, t, u, x, y."),
        ("t = LIMT", "LIMT is not defined. Did you mean LIMIT?"),
        ("t = sum((1, 2))", "sum is not defined. Known here: LIMIT, half, math, p, t, u, x, y."),
        ("t = math.sqr(2)", "math.sqr is not defined. Did you mean math.sqrt?"),
        ("u = 1", "u is an argument; choose another name."),
        ("t = u", "u is used as a whole; write u.name, or pass u to a function of this file."),
    ],
)
def test_names(line: str, message: str) -> None:
    assert output(line) == [message]


@pytest.mark.parametrize(
    ("text", "messages"),
    [
        (
            OUTPUT + function("update(p, u, x, y, dt)", "y.force = dt"),
            ["y.force is assigned in update; outputs are set in output only."],
        ),
        (
            "    @staticmethod\n    def output(p, u, y):\n        y.force = 0\n",
            ["output takes (p, u, x, y); here it has (p, u, y)."],
        ),
        (
            OUTPUT.replace("    @staticmethod\n", ""),
            ["output needs @staticmethod above it, and nothing else."],
        ),
        (
            OUTPUT + function("updat(p, u, x, y, dt)", "pass"),
            ["updat is not a function of a component. Did you mean update?"],
        ),
        (function("output(p, u, x, y)", "pass"), ["output never assigns y.force."]),
        ("", ["output never assigns y.force."]),
        (function("build(p, mj)", "places = sorted(p.points)"), []),
        (
            OUTPUT + '    peak = Metric("N", "Peak.")\n' + function("finish(p, x, m)", "pass"),
            ["finish never assigns m.peak."],
        ),
        (
            '    mass = Parameter("kq", "Mass.")\n' + OUTPUT,
            [
                'mass: "kq" is not a unit; write one made of m, cm, mm, km, g, kg, s, ms, min, h, '
                'rad, deg, N, kN, J, kJ, W, kW, Pa, kPa, MPa, Hz, K, A, %, or "1".'
            ],
        ),
        (
            '    mass = Parameter("kg", "Mass.", bounds=(3, 1))\n' + OUTPUT,
            ["mass: bounds (3, 1) are reversed."],
        ),
        (
            '    mass = Parameter("kg", "Mass.", default=4, bounds=(1, 3))\n' + OUTPUT,
            ["mass: default 4 is outside its bounds (1, 3)."],
        ),
        (
            '    side = Option("Side.", ("left", "right"), "lef")\n' + OUTPUT,
            ["side: default lef is not one of its choices. Did you mean left?"],
        ),
    ],
)
def test_functions_and_declarations(text: str, messages: list[str]) -> None:
    assert faults_of(HEAD + text) == messages


def test_all_faults_come_at_once() -> None:
    assert len(output("p.gain = u.exitation", "x.length = lenght")) == 4


def test_helpers_are_checked_too() -> None:
    source = HEAD.replace("value / 2", "valeu / 2") + OUTPUT
    assert faults_of(source) == ["valeu is not defined. Did you mean value?"]


PROBE = "class Probe(Component):\n    pass\n"
IMPORTS = (
    "a component file imports only math, gaitsim.component and files that its kind shares; "
    "write `import math`, `from gaitsim.component import ...` or `from ._name import ...`."
)


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("x = (1\n", "hill.py:1:5: this is not Python: '(' was never closed."),
        ("import numpy\n" + PROBE, f"hill.py:1:1: {IMPORTS}"),
        ("import math as m\n" + PROBE, f"hill.py:1:1: {IMPORTS}"),
        (PROBE + "    import os\n", f"hill.py:3:5: {IMPORTS}"),
        ("import math\n", "hill.py: a component file holds one class that derives from Component; this has none."),
        (
            PROBE + PROBE.replace("Probe", "Other"),
            "hill.py:3:1: Other is a second component; give it a file of its own.",
        ),
        ("class A:\n    pass\n" + PROBE, "hill.py:1:1: A does not derive from Component."),
        ("X = eval('1')\n" + PROBE, "hill.py:1:5: eval may not be used in a component file."),
        (
            "for i in (1, 2):\n    pass\n" + PROBE,
            "hill.py:1:1: a component file holds imports, constants, functions and one class.",
        ),
    ],
)
def test_what_a_file_may_hold(source: str, message: str) -> None:
    assert refused(source).split("\n")[0] == message


def test_the_future_and_a_docstring_are_fine() -> None:
    parse(f'"""Doc."""\nfrom __future__ import annotations\n{IMPORT}{PROBE}', "hill.py")


@pytest.mark.parametrize(
    ("declared", "said"),
    [
        ('Output("N", "F.", usual=(3, 1))', "other: usual (3, 1) is not a range; write the lower end first."),
        (
            'Output("N", "F.", possible=(0, "peak"))',
            "other: possible: there is no parameter peak here. Known here: gain.",
        ),
        (
            'Output("N", "F.", usual=(0, "gain"))',
            "other: usual: =gain gives a plain number; this needs a force, so multiply or divide by what is missing.",
        ),
        (
            'Output("N", "F.", usual=1)',
            'other: usual is 1; write two ends in brackets, such as (0, 1) or ("lower - 0.1", "upper + 0.1").',
        ),
        ('State("1", "S.", size=3, usual=(0, 1))', "other: a range is of one number; leave out usual."),
    ],
)
def test_ranges_at_the_start(declared: str, said: str) -> None:
    source = f"{HEAD}    other = {declared}\n{function('output(p, u, x, y)', 'y.force = 0', 'y.other = 1')}"
    assert said in faults_of(source)
