"""From LLVM IR to machine code that can be called. This module does not know models.

Machine code is cached as an object file with the names of the functions that it calls, so that loading it needs neither
numba nor LLVM's optimization.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import llvmlite
import llvmlite.binding as llvm
import mujoco
import numpy as np

from gaitsim.cache import cached, keep

_MUJOCO = (
    *("mj_step1", "mj_step2", "mj_forwardSkip", "mj_RungeKutta"),
    *("mj_kinematics", "mj_comPos", "mj_makeM", "mj_comVel", "mj_subtreeVel", "mj_rne"),
    *("mj_sensorPos", "mj_sensorVel", "mj_energyPos", "mj_energyVel", "mj_factorM", "mj_solveM"),
    *("mj_tendon", "mj_transmission", "mj_fwdVelocity", "mj_fwdActuation", "mj_fwdAcceleration", "mj_fwdConstraint"),
    *("mj_Euler", "mj_implicit"),
)
MAKERS = (
    "chains",
    "compilation",
    "events",
    "functions",
    "instant",
    "kernel",
    "machine",
    "mujoco_step",
    "native",
    "records",
    "stage_code",
    "stages",
    "stopwatch",
    "translation",
    "writer",
)


@dataclass(frozen=True)
class Code:
    """Machine code in memory. It is freed with this object."""

    engine: Any = field(repr=False)

    def address(self, name: str) -> int:
        """The address of a function."""
        return int(self.engine.get_function_address(name))


@cache
def environment() -> str:
    """A text with everything on which machine code depends besides its source: versions and the processor."""
    folder = Path(__file__).parent
    own = [hashlib.sha256((folder / f"{name}.py").read_bytes()).hexdigest() for name in MAKERS]
    versions = [llvmlite.__version__, version("numba"), np.__version__, mujoco.__version__, sys.version]
    switches = sorted(f"{name}={value}" for name, value in os.environ.items() if name.startswith("NUMBA_"))
    processor, features = llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    return "|".join([*own, *versions, *switches, processor, features])


@cache
def _target() -> Any:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.Target.from_default_triple()


def _target_machine() -> Any:
    # As numba does, for code that is loaded at any address.
    reloc = "static" if _target().name.startswith("x86") else "default"
    return _target().create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=2,
        reloc=reloc,
        codemodel="jitdefault",
        jit=True,
    )


def linked(text: str, modules: Iterable[bytes]) -> Any:
    """Parse a module of LLVM IR and link modules of bitcode into it."""
    machine = _target_machine()
    module = llvm.parse_assembly(text)
    module.triple, module.data_layout = llvm.get_process_triple(), str(machine.target_data)
    for bitcode in modules:
        module.link_in(llvm.parse_bitcode(bitcode))
    return module


def stripped(module: Any, exported: Sequence[str]) -> Any:
    """The module with only what its exported functions need."""
    _internalize(module, exported)
    passes = llvm.create_new_module_pass_manager()
    passes.add_global_dead_code_eliminate_pass()
    passes.run(module, llvm.create_pass_builder(_target_machine(), llvm.create_pipeline_tuning_options()))
    return module


def _internalize(module: Any, exported: Sequence[str]) -> None:
    for each in (*module.functions, *module.global_variables):
        if not each.is_declaration and each.name not in exported:
            each.linkage = "internal"


def object_file(module: Any, exported: Sequence[str]) -> bytes:
    """Compile a module to optimized machine code. Floating-point arithmetic is not relaxed.

    Returns:
        The names of the functions that it calls, and the object file, as bytes for the cache.
    """
    _internalize(module, exported)
    machine = _target_machine()
    options = llvm.create_pipeline_tuning_options(speed_level=2)
    options.loop_vectorization = options.slp_vectorization = False
    llvm.create_pass_builder(machine, options).getModulePassManager().run(
        module, llvm.create_pass_builder(machine, options)
    )
    everything = (*module.functions, *module.global_variables)
    called = [each.name for each in everything if each.is_declaration and not each.name.startswith("llvm.")]
    return json.dumps(called).encode() + b"\n" + bytes(machine.emit_object(module))


def code(kind: str, key: str, make: Callable[[], bytes]) -> Code:
    """Load the machine code of a cache entry; make the entry if it is missing.

    Args:
        kind: The kind of the entry.
        key: Its key.
        make: Makes the object file.
    """
    file = cached(kind, key)
    if file is None:
        file = make()
        keep(kind, key, file)
    return _loaded(file)


def _loaded(file: bytes) -> Code:
    called, _, content = file.partition(b"\n")
    _provide(json.loads(called))
    machine = _target_machine()
    empty = llvm.parse_assembly("")
    empty.triple = llvm.get_process_triple()
    engine = llvm.create_mcjit_compiler(empty, machine)
    engine.add_object_file(llvm.ObjectFileRef.from_data(content))
    engine.finalize_object()
    return Code(engine)


def _provide(names: Sequence[str]) -> None:
    """Make the functions that code calls available. LLVM ends the process if one is missing."""
    _provide_mujoco()
    if not all(_known(name) for name in names):
        _provide_numba()
    missing = [name for name in names if not _known(name)]
    assert not missing, f"native code calls {', '.join(missing)}, which nobody offers"


def _known(name: str) -> bool:
    return llvm.address_of_symbol(name) is not None or hasattr(ctypes.pythonapi, name)


def set_clock(address: int | None) -> None:
    """Set the function that MuJoCo's timers call; without a function the timers stand still."""
    ctypes.c_void_p.in_dll(_mujoco(), "mjcb_time").value = address


@cache
def _mujoco() -> ctypes.CDLL:
    return ctypes.CDLL(str(next(Path(mujoco.__file__).parent.glob("libmujoco.*"))))


@cache
def _provide_mujoco() -> None:
    library = _mujoco()
    for name in _MUJOCO:
        llvm.add_symbol(name, ctypes.cast(getattr(library, name), ctypes.c_void_p).value)
    # The Python package installs a clock that MuJoCo reads a dozen times in a step; its timers are not used.
    set_clock(None)


@cache
def _provide_numba() -> None:
    """Make the functions of numba's runtime available; they are registered when numba compiles anything."""
    import numba

    numba.njit("int64()")(lambda: 0)
