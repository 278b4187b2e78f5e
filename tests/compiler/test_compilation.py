"""Kernels are compiled on all cores: what helpers make is what this process would have made."""

from __future__ import annotations

import subprocess
from pathlib import Path

import llvmlite.binding as llvm
import pytest

from gaitsim.cache import cached
from gaitsim.compiler import compilation
from gaitsim.compiler.kernel import Kernel, kernel_of
from gaitsim.components.find import Library
from gaitsim.components.load import load_primitive
from gaitsim.components.primitive import Primitive
from gaitsim.distribution import shipped_folder
from gaitsim.errors import InvalidComponent

NAMES = ("measure/peak", "measure/range", "controller/clock")


@pytest.fixture
def helpers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[subprocess.Popen[bytes]]:
    """An empty cache, two cores, and the helpers that are started."""
    monkeypatch.setenv("GAITSIM_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(compilation, "_WORTH_A_HELPER", 1)
    monkeypatch.setattr(compilation, "_cores", lambda: 2)
    started: list[subprocess.Popen[bytes]] = []
    real = compilation._helper
    monkeypatch.setattr(compilation, "_helper", lambda kernels: started.append(real(kernels)) or started[-1])
    return started


def primitives() -> list[Primitive]:
    library = Library((shipped_folder(),))
    found = [library.find(name) for name in NAMES]
    assert all(isinstance(each, Primitive) for each in found)
    return found  # type: ignore[return-value]


def has(bitcode: bytes | None, kernel: Kernel) -> bool:
    """Whether bitcode is whole and has a kernel's function. Its bytes differ: numba counts what a process compiles."""
    assert bitcode is not None
    return not llvm.parse_bitcode(bitcode).get_function(kernel.name).is_declaration


def test_all_are_compiled_with_one_helper_for_the_second_core(helpers: list[subprocess.Popen[bytes]]) -> None:
    kernels = [kernel_of(each) for each in primitives()]
    made = compilation.bitcode_of(kernels)
    assert all(map(has, made, kernels))
    assert all(has(cached("kernels", kernel.name), kernel) for kernel in kernels)
    assert len(helpers) == 1 and helpers[0].poll() is not None, "it has ended"
    compilation.bitcode_of(kernels)
    assert len(helpers) == 1, "nothing is missing, so no one helps"


@pytest.mark.usefixtures("helpers")
def test_a_helper_compiles_what_it_is_given() -> None:
    kernels = [kernel_of(each) for each in primitives()[:2]]
    assert compilation._helper(kernels).wait() == 0
    assert all(has(cached("kernels", kernel.name), kernel) for kernel in kernels)


def test_what_cannot_become_native_code_is_told_here(
    helpers: list[subprocess.Popen[bytes]], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    head = "def update(p, u, x, y, dt):"
    text = primitives()[0].text.replace(head, f"{head}\n        z = [[]]")
    broken = load_primitive("measure/broken", tmp_path / "broken.py", "broken.py", text)
    with pytest.raises(InvalidComponent, match=r"broken\.py:.*this cannot become native code"):
        compilation.bitcode_of([kernel_of(broken), *map(kernel_of, primitives())])
    assert all(helper.poll() is not None for helper in helpers)
    assert capfd.readouterr().err == ""


def test_without_helpers_all_is_compiled_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GAITSIM_CACHE", str(tmp_path))
    monkeypatch.setattr(compilation, "_WORTH_A_HELPER", 1)
    monkeypatch.setattr(compilation, "_cores", lambda: 2)
    monkeypatch.setattr(compilation.sys, "executable", str(tmp_path / "gone"))
    kernels = [kernel_of(each) for each in primitives()[:2]]
    assert all(map(has, compilation.bitcode_of(kernels), kernels))


def test_places_are_apart() -> None:
    assert compilation._places(10, 1) == []
    assert compilation._places(10, 2) == [5]
    assert compilation._places(9, 4) == [2, 4, 6]
