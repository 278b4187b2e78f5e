"""The house rules that imports and names can break, read from the source."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "gaitsim"
FILES = sorted(PACKAGE.rglob("*.py"))
BANNED = {"utils", "util", "helpers", "helper", "common", "misc", "base", "manager", "core"}


@cache
def imports(path: Path) -> frozenset[str]:
    """Every module that a file imports at run time, wherever the import stands."""
    found: set[str] = set()
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            node.body = [ast.Pass()]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return frozenset(found)


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


def test_only_the_cli_prints() -> None:
    calls = {
        str(path.relative_to(PACKAGE))
        for path in FILES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "print"
    }
    assert calls == {"cli/console.py"}


def test_arrows_point_one_way() -> None:
    upwards = {
        "spec": {"compiler", "simulation", "results", "cli"},
        "parts": {"compiler", "simulation", "results", "cli"},
        "model.py": {"compiler", "simulation", "results", "cli"},
        "compiler": {"simulation", "results", "cli"},
        "simulation": {"results", "cli"},
        "exchange": {"results", "analysis", "animation", "cli"},
        "results": {"analysis", "animation", "cli"},
        "analysis": {"animation", "cli"},
        "component.py": {"spec", "parts", "compiler", "simulation", "results", "cli"},
        "units.py": {"spec", "parts", "compiler", "simulation", "results", "cli"},
        "errors.py": {"spec", "parts", "compiler", "simulation", "results", "cli"},
    }
    wrong = {
        (low, high) for low, highs in upwards.items() for high in highs if low in users(f"gaitsim.{high}")
    }
    assert wrong == set()


def test_no_module_imports_itself_through_others() -> None:
    names = {f"gaitsim.{'.'.join(path.relative_to(PACKAGE).with_suffix('').parts)}": path for path in FILES}
    edges = {name: {other for other in imports(path) if other in names} for name, path in names.items()}
    done: set[str] = set()

    def visit(name: str, trail: tuple[str, ...]) -> None:
        assert name not in trail, " -> ".join([*trail, name])
        if name not in done:
            for other in sorted(edges[name]):
                visit(other, (*trail, name))
            done.add(name)

    for name in names:
        visit(name, ())


def test_files_are_short_and_named_after_what_they_hold() -> None:
    assert not {path.stem for path in FILES} & BANNED
    # The audit's math, numbers and paths are one mechanism; apart they would import each other.
    allowed = {"parts/audit.py"}
    long = {str(p.relative_to(PACKAGE)) for p in FILES if len(p.read_text(encoding="utf-8").splitlines()) > 400}
    assert long <= allowed
