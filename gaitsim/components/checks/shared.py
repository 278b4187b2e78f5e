"""Files that the components of a kind share: declarations and pure functions, with names that begin with `_`.

A component that says `from ._hill import PATH, look_ahead` uses the definitions of `_hill.py` in the folder of its
kind. A shared file holds no component and imports no other shared file.
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
    """A file that components of a kind import from.

    Attributes:
        display_path: The name of the file in messages.
    """

    name: str
    path: Path
    display_path: str
    text: str


def imported_names(text: str) -> list[str]:
    """The shared files that the text of a component imports from, without repetition."""
    return list(dict.fromkeys(_IMPORT.findall(text)))


def whole(text: str, shared: Sequence[Shared]) -> str:
    """The text of a component with that of its shared files, whose digest is the version of the component.

    Args:
        text: The text of the component.
        shared: The shared files that it imports from.

    Returns:
        The texts of the shared files, followed by that of the component.
    """
    return "".join(f"# {file.name}.py\n{file.text}" for file in shared) + text


def imports_shared(node: ast.AST) -> bool:
    """Whether a statement imports from a shared file."""
    return isinstance(node, ast.ImportFrom) and node.level == 1 and re.fullmatch(r"_\w+", node.module or "") is not None


def import_faults(
    tree: ast.Module, shared: Sequence[Shared], trees: Sequence[ast.Module]
) -> Iterator[tuple[str, ast.ImportFrom]]:
    """Find names that a component imports and no shared file defines.

    Yields:
        The message of each fault, and the import.
    """
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
    """The functions that a component file can call: its own and the imported ones."""
    wanted = {alias.name for node in tree.body if imports_shared(node) for alias in node.names}  # type: ignore[attr-defined]
    theirs = [node for other in trees for node in other.body if isinstance(node, ast.FunctionDef)]
    own = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    return {node.name: node for node in (*(n for n in theirs if n.name in wanted), *own)}


def builtins_with(spaces: Mapping[str, Mapping[str, Any]], known: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """The builtins of a component file, in which `from ._name import ...` finds the shared files.

    Args:
        spaces: The namespaces of the shared files, by name.
        known: The other builtins; Python's by default.
    """
    own = vars(builtins) if known is None else known
    usual = own["__import__"]

    def find(name: str, *rest: Any) -> Any:
        level = rest[3] if len(rest) > 3 else 0
        return SimpleNamespace(**spaces[name]) if level else usual(name, *rest)

    return {**own, "__import__": find}
