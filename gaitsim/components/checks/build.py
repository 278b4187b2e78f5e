"""Checks of the names of ports and frames in a component's build()."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping

from gaitsim.component import Attachment, Declaration, Frame, Input, Output
from gaitsim.errors import did_you_mean

# The number of leading arguments of a verb that name declarations, and their classes.
VERBS: Mapping[str, tuple[int, tuple[type, ...], str]] = {
    "frame": (1, (Frame,), "frame"),
    "attached": (1, (Attachment,), "attachment"),
    "tendon_between": (2, (Attachment,), "attachment"),
    "read": (1, (Output,), "output"),
    "read_energy": (2, (Output,), "output"),
    "read_weight": (1, (Output,), "output"),
    "read_key": (1, (Output,), "output"),
    "read_side": (1, (Output,), "output"),
    "read_slopes": (2, (Output,), "output"),
    "reset": (2, (Input, Output), "input or output"),
    "apply": (1, (Input, Output), "input or output"),
    "follow_ground": (6, (Input, Output), "input or output"),
}


def build_faults(build: ast.FunctionDef, known: Mapping[str, Declaration]) -> Iterator[tuple[str, ast.AST]]:
    """Find names in build() that are not declared as its calls need them.

    Yields:
        The message and the place of each fault.
    """
    for call, argument, kinds, what in _named(build):
        word = argument.value if isinstance(argument, ast.Constant) else None
        if isinstance(word, str) and not isinstance(known.get(word), kinds):
            hint = did_you_mean(word, [name for name, one in known.items() if isinstance(one, kinds)])
            yield f"mj.{call} names {word}, which is declared as no {what}. {hint}", argument


def placed(build: ast.FunctionDef, kind: type, known: Mapping[str, Declaration]) -> set[str] | None:
    """The names that build() places or sets; None if they cannot be determined, as in a loop or a helper."""
    found = set()
    for _, argument, kinds, _ in _named(build):
        if kinds == (kind,):
            word = argument.value if isinstance(argument, ast.Constant) else None
            if not isinstance(word, str) or word not in known:
                return None
            found.add(word)
    return found or None


def _named(build: ast.FunctionDef) -> Iterator[tuple[str, ast.expr, tuple[type, ...], str]]:
    side = build.args.args[-1].arg if build.args.args else ""
    for node in ast.walk(build):
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
            continue
        if isinstance(node.func.value, ast.Name) and node.func.value.id == side and node.func.attr in VERBS:
            count, kinds, what = VERBS[node.func.attr]
            for argument in node.args[:count]:
                yield node.func.attr, argument, kinds, what
