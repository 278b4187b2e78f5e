"""The house rules that imports and names can break, read from the source."""

from __future__ import annotations

import ast
from collections.abc import Collection, Mapping
from functools import cache
from pathlib import Path

from gaitsim.compiler.machine import MAKERS

PACKAGE = Path(__file__).parents[1] / "gaitsim"
FILES = sorted(PACKAGE.rglob("*.py"))
BANNED = {"utils", "util", "helpers", "helper", "common", "misc", "base", "manager", "core"}


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def imports(path: Path, types: bool = False) -> frozenset[str]:
    """Every module that a file imports at run time, wherever the import stands.

    Args:
        types: Whether to add what only type checkers import.
    """
    found: set[str] = set()
    waiting: list[ast.AST] = [tree_of(path)]
    while waiting:
        node = waiting.pop()
        if not types and isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            waiting += node.orelse
            continue
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
        waiting += ast.iter_child_nodes(node)
    return frozenset(found)


def module_of(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


# Without gaitsim itself: others read its version, and it imports them only in its functions.
MODULES = {module_of(path): path for path in FILES if path.parent != PACKAGE or path.stem != "__init__"}


def first_ring(arrows: Mapping[str, Collection[str]]) -> list[str]:
    """Names that lead back to the first of them along arrows; empty if there are none."""
    done: set[str] = set()

    def visit(name: str, trail: list[str]) -> list[str]:
        if name in trail:
            return [*trail[trail.index(name) :], name]
        if name not in done:
            for other in sorted(arrows.get(name, ())):
                if ring := visit(other, [*trail, name]):
                    return ring
            done.add(name)
        return []

    return next((ring for name in arrows if (ring := visit(name, []))), [])


def users(module: str) -> set[str]:
    """The top-level parts of gaitsim that import a module."""
    return {
        path.relative_to(PACKAGE).parts[0]
        for path in FILES
        if any(name == module or name.startswith(f"{module}.") for name in imports(path))
    }


def test_only_the_compiler_and_the_simulation_know_mujoco_and_numba() -> None:
    # animation draws with it.
    assert users("mujoco") == {"animation", "compiler", "simulation"}
    assert users("numba") == {"compiler"}


def at_import(path: Path) -> set[str]:
    """The packages that are imported when a file is, and not only when one of its functions runs."""
    found: set[str] = set()
    waiting: list[ast.AST] = [tree_of(path)]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            continue
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            waiting += node.orelse
            continue
        if isinstance(node, ast.Import):
            found |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module.partition(".")[0])
        waiting += ast.iter_child_nodes(node)
    return found


def test_packages_for_analysis_are_imported_where_they_are_used() -> None:
    """Neither a command that needs none of them nor a worker waits for them."""
    heavy = {"PIL", "h5netcdf", "h5py", "imageio_ffmpeg", "jinja2", "matplotlib", "pandas", "rich", "xarray"}
    found = {str(path.relative_to(PACKAGE)): at_import(path) & heavy for path in FILES}
    assert {path: names for path, names in found.items() if names} == {}


def test_only_the_cli_prints() -> None:
    calls = {
        str(path.relative_to(PACKAGE))
        for path in FILES
        for node in ast.walk(tree_of(path))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "print"
    }
    assert calls == {"cli/console.py"}


def test_the_study_is_what_commands_and_notebooks_call() -> None:
    assert users("gaitsim.cli") == {"cli"}
    assert users("gaitsim.study") <= {"__init__.py", "cli", "study"}


def test_no_module_imports_itself_through_others() -> None:
    """Nor may it with what type checkers import: two modules that need each other's types are one, or lack a third."""
    arrows = {
        name: {other for other in imports(path, types=True) if other in MODULES} for name, path in MODULES.items()
    }
    assert first_ring(arrows) == []


def test_packages_import_each_other_one_way() -> None:
    """A folder is a package, also one within another; a file that stands beside the folders is one of its own."""

    def package(module: str) -> str:
        path = MODULES[module]
        return module if path.parent == PACKAGE else module_of(path.parent / "__init__.py")

    arrows: dict[str, set[str]] = {}
    for name, path in MODULES.items():
        found = {package(other) for other in imports(path) if other in MODULES}
        arrows.setdefault(package(name), set()).update(found - {package(name)})
    assert first_ring(arrows) == []


def test_a_ring_of_imports_is_found() -> None:
    assert first_ring({"a": {"b"}, "b": {"c", "d"}, "c": set(), "d": {"b"}}) == ["b", "d", "b"]
    assert first_ring({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == []


def test_files_are_short_and_named_after_what_they_hold() -> None:
    assert not {path.stem for path in FILES} & BANNED
    long = {str(p.relative_to(PACKAGE)) for p in FILES if len(p.read_text(encoding="utf-8").splitlines()) > 400}
    assert not long


def test_the_key_of_machine_code_has_every_module_that_writes_some() -> None:
    writers = {
        path.stem
        for path in (PACKAGE / "compiler").glob("*.py")
        if any(name.startswith(("llvmlite", "numba", "gaitsim.compiler.writer")) for name in imports(path))
    }
    assert writers <= set(MAKERS)
