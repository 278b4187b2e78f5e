"""Checks against imports, names and attributes that lead to files or to other code."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gaitsim.components.checks.declaration import unknown_fields
from gaitsim.components.checks.shared import imports_shared

FORBIDDEN = {"open", "exec", "eval", "compile", "input", "getattr", "setattr", "delattr", "vars", "globals", "locals"}
FORBIDDEN |= {"dir", "type", "object", "super", "memoryview", "help"}
# Attributes through which a generator, a function or an array gives access to other code or to files.
_INSIDES = {"gi_frame", "gi_code", "f_back", "f_builtins", "f_globals", "f_locals", "tb_frame", "tb_next", "ctypes"}
_INSIDES |= {"tofile", "dump", "with_traceback", "mro"}


def foreign(tree: ast.Module) -> Iterator[tuple[str, ast.AST]]:
    """Find unknown fields of declarations, and imports and names that component files must not use.

    Yields:
        The message and the place of each fault.
    """
    yield from unknown_fields(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom) and not _may_import(node):
            yield (
                "a component file imports only math, gaitsim.component and files that its kind shares; "
                "write `import math`, `from gaitsim.component import ...` or `from ._name import ...`.",
                node,
            )
        elif word := _forbidden(node):
            yield f"{word} may not be used in a component file.", node


def _forbidden(node: ast.AST) -> str:
    """The forbidden name in a node: one that leads to files or to the internals of Python; empty if there is none."""
    if isinstance(node, ast.Name) and node.id in FORBIDDEN:
        return node.id
    if isinstance(node, ast.Attribute) and node.attr in _INSIDES:
        return f".{node.attr}"
    if isinstance(node, ast.Import | ast.ImportFrom):
        return ""
    for value in (value for _, value in ast.iter_fields(node)):
        for word in value if isinstance(value, list) else (value,):
            # Strings in the syntax tree are names, except those of constants.
            if isinstance(word, str) and word.startswith("__") and not isinstance(node, ast.Constant):
                return word
    return ""


def _may_import(node: ast.Import | ast.ImportFrom) -> bool:
    if isinstance(node, ast.Import):
        return all(alias.name == "math" and alias.asname is None for alias in node.names)
    if imports_shared(node):
        return all(alias.name.isidentifier() and alias.asname is None for alias in node.names)
    public = all(not alias.name.startswith("_") and not (alias.asname or "").startswith("__") for alias in node.names)
    return node.level == 0 and public and node.module in ("gaitsim.component", "__future__")
