"""What the syntax of a component says of its functions; comments and docstrings say nothing."""

from __future__ import annotations

import ast

import pytest

from gaitsim.components.checks.findings import Findings, findings_of

CLASS = '''
"""While a leg swings, for each step in it: raise [nothing], assert nothing."""
def halved(x):
    {helper}
    return x / 2

class A(Component):
    """Raise the leg while it swings, for all [steps] in a stride."""
    gains = [1, 2]

    def output(p, u, x, y):
        """For each x in y; while it holds, raise."""
        {output}

    def build(p, mj):
        for name in p.names:
            assert name[0]
'''


def found(output: str, helper: str = "pass") -> Findings:
    return findings_of(ast.parse(CLASS.format(output=output, helper=helper)), {})


@pytest.mark.parametrize(
    ("line", "may_raise", "open_loop"),
    [
        ("y.a = u.b", False, False),
        ("y.a = [u.b, 1]", False, False),
        ("y.a = p.curve[3]", True, False),
        ("assert u.b > 0", True, False),
        ("if u.b: raise ValueError", True, False),
        ("for _ in range(8): y.a += u.b", False, False),
        ("for _ in range(-3, 8, +2): y.a += u.b", False, False),
        ("for _ in range(int(u.b)): y.a += u.b", False, True),
        ("for c in x.c: y.a += c", False, True),
        ("y.a = sum(c for c in u.several(u.b))", False, True),
        ("while u.b < 1: y.a += u.b", False, True),
    ],
)
def test_a_line_counts_in_the_class_and_in_what_it_calls(line: str, may_raise: bool, open_loop: bool) -> None:
    for findings in (found(line), found("pass", line)):
        assert (findings.may_raise, findings.open_loop) == (may_raise, open_loop)


def test_shared_files_count() -> None:
    shared = ast.parse("def of(x):\n    while x > 1:\n        x = x / 2\n    return x\n")
    assert findings_of(ast.parse(CLASS.format(output="pass", helper="pass")), {}, [shared]).open_loop
