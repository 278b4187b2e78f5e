"""What a component file may not name. It keeps mistakes out, and is not a fence: that is --trust."""

from __future__ import annotations

import pytest

from gaitsim.components.checks.check import parse
from gaitsim.errors import InvalidComponent

HEAD = "from gaitsim.component import Component\n\n\nclass Brake(Component):\n    pass\n\n\n"
WORDS = {
    'x = __builtins__["op" + "en"]': "__builtins__",
    "x = math.__loader__": "__loader__",
    "x = ().__class__.__base__": "__base__",
    "x = getattr(math, 'lo' + 'ader')": "getattr",
    "x = vars()": "vars",
    "x = globals()": "globals",
    "x = (1 for _ in ()).gi_frame": ".gi_frame",
    "def f(x):\n    match x:\n        case int(__class__=c):\n            return c": "__class__",
    "def f(x):\n    match x:\n        case {**__x}:\n            return 1": "__x",
    "def f(x, __y=1):\n    return x": "__y",
    "def f(x):\n    global __builtins__": "__builtins__",
    "def __getattr__(name):\n    return name": "__getattr__",
    "x = f(__y=1)": "__y",
    "x = type('T', (), {})": "type",
    "x = compile('1', '', 'eval')": "compile",
    "x = p.samples.tofile('x')": ".tofile",
}
IMPORTS = ["from gaitsim.component import __builtins__", "from gaitsim.component import _x", "import math as m"]


@pytest.mark.parametrize("line", WORDS)
def test_names_that_lead_out_of_a_component(line: str) -> None:
    with pytest.raises(InvalidComponent) as raised:
        parse(f"{HEAD}{line}\n", "brake.py")
    assert [fault.message for fault in raised.value.faults][:1] == [
        f"{WORDS[line]} may not be used in a component file."
    ]


@pytest.mark.parametrize("line", IMPORTS)
def test_only_public_names_are_imported(line: str) -> None:
    with pytest.raises(InvalidComponent, match=r"a component file imports only math, gaitsim\.component"):
        parse(f"{line}\n{HEAD}", "brake.py")


def test_a_text_may_say_anything() -> None:
    parse(f'{HEAD}x = "__builtins__"\n', "brake.py")
