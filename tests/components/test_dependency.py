"""Which inputs an output needs at the same instant."""

from __future__ import annotations

import ast

import pytest

from gaitsim.component import Declaration, Input, Output, Parameter, State
from gaitsim.components.checks.dependency import output_dependencies

DECLARED: dict[str, Declaration] = {
    "k": Parameter("1", ""),
    "a": Input("1", ""),
    "b": Input("1", ""),
    "c": Input("1", ""),
    "s": State("1", ""),
    "f": Output("1", ""),
    "g": Output("1", ""),
}


def of(*lines: str, helpers: str = "") -> tuple[str, str]:
    body = "\n".join(f"        {line}" for line in lines)
    head = "class A(Component):\n    @staticmethod\n    def output(p, u, x, y):"
    source = f"{helpers}\n{head}\n{body}\n"
    found = output_dependencies(ast.parse(source), DECLARED)
    return "".join(sorted(found["f"])), "".join(sorted(found["g"]))


FILL = "def fill(u, y):\n    y.f = u.a\n"
GUARD = "def guard(v):\n    if v < 0:\n        raise ValueError\n    return v\n"


@pytest.mark.parametrize(
    ("lines", "f", "g"),
    [
        (["y.f = u.a + p.k * x.s"], "a", ""),
        (["y.f = x.s"], "", ""),
        (["t = u.a", "v = t * 2", "y.f = v", "y.g = u.b"], "a", "b"),
        (["y.f = u.a", "y.g = y.f + u.b"], "a", "ab"),
        (["y.g = y.f", "y.f = u.a"], "a", "a"),
        (["if u.a > 0:", "    y.f = u.b", "else:", "    y.f = 0", "y.g = u.c"], "ab", "c"),
        (["y.f = u.a if u.b > 0 else u.c"], "abc", ""),
        (["y.g = u.c", "if u.a > 0:", "    y.f = 1", "    return", "y.f = u.b"], "ab", "c"),
        (["if u.a > 0:", "    return", "y.f = u.b", "y.g = 1"], "ab", "a"),
        (["if u.a > 0:", "    raise ValueError", "y.f = 1"], "a", ""),
        (["for i in (1, 2):", "    y.f = 1", "    if u.a > i: break", "y.g = 2"], "a", ""),
        (["n = 0", "while n < u.b:", "    n += 1", "y.f = n", "y.g = u.c"], "b", "c"),
        (["for i in range(3):", "    if u.a > i:", "        return", "y.f = 1"], "a", ""),
        (["t, v = u.a, u.b", "y.f = t", "y.g = v"], "a", "b"),
        (["t = 0", "t += u.a", "y.f = t"], "a", ""),
        (["y.f = (t := u.a) + 1", "y.g = t"], "a", "a"),
        (["v = [0, 0]", "w = v", "w[0] = u.a", "y.f = v[1]"], "a", ""),
        (["y.f = min(u.a, u.b)"], "ab", ""),
    ],
)
def test_flow(lines: list[str], f: str, g: str) -> None:
    assert of(*lines) == (f, g)


def test_a_helper_gives_what_it_is_given() -> None:
    assert of("y.f = half(u.a, u.b)", helpers="def half(v, w):\n    return v / 2\n") == ("ab", "")


def test_a_helper_that_is_given_everything_may_do_everything() -> None:
    assert of("fill(u, y)", helpers=FILL) == ("abc", "abc")


def test_a_helper_that_raises_decides_on_what_follows() -> None:
    assert of("y.g = 1", "guard(u.a)", "y.f = 1", helpers=GUARD) == ("a", "")


def test_without_output_nothing_is_direct() -> None:
    found = output_dependencies(ast.parse("class A(Component):\n    pass"), DECLARED)
    assert found == {"f": frozenset(), "g": frozenset()}
