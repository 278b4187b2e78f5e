"""What the components of a kind share: declarations and pure functions, in files whose names begin with `_`.

A component of the kind says `from ._hill import PATH, look_ahead` and has then what
`_hill.py`, in the folder of its kind, defines. Such a file holds no component, and no import of another one.
"""

from __future__ import annotations

import ast
import builtins
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from gaitsim.errors import did_you_mean

_IMPORT = re.compile(r"^from \.(_\w+) import ", re.MULTILINE)


@dataclass(frozen=True)
class Shared:
    """A file that components of a kind import from; `shown` is how errors name it."""

    name: str
    path: Path
    shown: str
    text: str


def imported_names(text: str) -> list[str]:
    """The shared files that the text of a component imports from, each once."""
    return list(dict.fromkeys(_IMPORT.findall(text)))


def whole(text: str, shared: Sequence[Shared]) -> str:
    """The texts of shared files and of a component as one; that of the component alone if it imports none."""
    return "".join(f"# {file.name}.py\n{file.text}" for file in shared) + text


def imports_shared(node: ast.AST) -> bool:
    """Whether a statement imports from a file that a kind shares."""
    return isinstance(node, ast.ImportFrom) and node.level == 1 and re.fullmatch(r"_\w+", node.module or "") is not None


def import_faults(
    tree: ast.Module, shared: Sequence[Shared], trees: Sequence[ast.Module]
) -> Iterator[tuple[str, ast.ImportFrom]]:
    """What a component imports that no shared file defines, in words, with the statement that does."""
    defined = {file.name: set(definitions(tree)) for file, tree in zip(shared, trees, strict=True)}
    for node in tree.body:
        if not isinstance(node, ast.ImportFrom) or not imports_shared(node):
            continue
        known = defined.get(node.module or "")
        if known is None:
            yield f"this kind has no file {node.module}.py; write it in the folder of this kind.", node
            continue
        for alias in node.names:
            if alias.name not in known:
                yield f"{node.module}.py defines no {alias.name}. {did_you_mean(alias.name, known)}", node


def definitions(tree: ast.Module) -> Iterator[str]:
    """The names that a shared file defines: its constants, declarations and functions."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            yield from (n.id for n in ast.walk(node) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store))


def used_functions(tree: ast.Module, trees: Sequence[ast.Module]) -> dict[str, ast.FunctionDef]:
    """The functions that a component file can call, by name: its own and those that it imports."""
    wanted = {alias.name for node in tree.body if imports_shared(node) for alias in node.names}  # type: ignore[attr-defined]
    theirs = [node for other in trees for node in other.body if isinstance(node, ast.FunctionDef)]
    own = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    return {node.name: node for node in (*(n for n in theirs if n.name in wanted), *own)}


def builtins_with(spaces: Mapping[str, Mapping[str, Any]], known: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """The builtins of a component file in which `from ._name import ...` gives names of executed shared files.

    Args:
        spaces: The namespaces of the shared files by name.
        known: The other builtins; Python's by default.
    """
    own = vars(builtins) if known is None else known
    usual = own["__import__"]

    def find(name: str, *rest: Any) -> Any:
        level = rest[3] if len(rest) > 3 else 0
        return SimpleNamespace(**spaces[name]) if level else usual(name, *rest)

    return {**own, "__import__": find}
