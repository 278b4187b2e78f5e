"""Rapid mode: the whole closed loop in native code, with MuJoCo inside and no Python per step.

All that this loop calls stands in this file, so numba's cache cannot serve a stale callee.
`python_loop` is the same loop, to be read first.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import llvmlite.binding
import mujoco
import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic

from gaitsim.compiler.program import STARTING_ROUNDS, Floats, Integers

START, OUTPUT, UPDATE = 0, 1, 2
# What an early round of starting says of inputs that are not there yet is no failure.
RUNNING, LAST_ROUND, EARLY_ROUND = 0, 1, 2
COMPLETED, STOPPED, RAISED, NOT_FINITE, DIVERGED = 0, 1, 2, 3, 4

_LIBRARY = next(Path(mujoco.__file__).parent.glob("libmujoco.*"))
llvmlite.binding.load_library_permanently(str(_LIBRARY))
_step1 = types.ExternalFunction("mj_step1", types.void(types.intp, types.intp))
_step2 = types.ExternalFunction("mj_step2", types.void(types.intp, types.intp))


Addresses = tuple[int, int, int, int]  # of the tables p, u, x, y


class Tables(NamedTuple):
    """Who is called in which order and reads what; see Program. A part's fields are at[i]:at[i+1]."""

    kernels: Integers
    p_at: Integers
    u_at: Integers
    x_at: Integers
    y_at: Integers
    calls: Integers  # (part, last of the step)
    updates: Integers
    senders: Integers  # input slot -> begin in source and line
    source: Integers
    line: Integers
    base: Floats
    line_source: Integers
    line_begin: Integers
    line_size: Integers
    line_whole: Integers
    line_rest: Floats
    line_initial: Floats
    reads: Integers  # (address in MuJoCo's data, output)
    appliers: Integers  # parts whose inputs go into MuJoCo
    writes: Integers  # (address in MuJoCo's data, 0 input or 1 output, its place)
    signs: Floats
    stops: Integers
    signals: Integers  # what is recorded: a place in the outputs, or behind them in the states
    initial_place: Integers
    initial_value: Floats


@intrinsic  # type: ignore[untyped-decorator]
def _call(
    typing: Any, kernel: Any, stage: Any, p: Any, u: Any, x: Any, y: Any, dt: Any
) -> Any:
    """Call the C function at an address: int64 (stage, p*, u*, x*, y*, dt)."""
    word = types.intp
    signature = types.int64(word, types.int64, word, word, word, word, types.float64)

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        integer = ir.IntType(64)
        function = ir.FunctionType(integer, [integer] * 5 + [ir.DoubleType()])
        return builder.call(builder.inttoptr(arguments[0], function.as_pointer()), arguments[1:])

    return signature, generate


@intrinsic  # type: ignore[untyped-decorator]
def _load(typing: Any, address: Any) -> Any:
    """The double at an address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(builder.inttoptr(arguments[0], ir.DoubleType().as_pointer()))

    return types.float64(types.intp), generate


@intrinsic  # type: ignore[untyped-decorator]
def _store(typing: Any, address: Any, value: Any) -> Any:
    """Write a double to an address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointer = builder.inttoptr(arguments[0], ir.DoubleType().as_pointer())
        builder.store(arguments[1], pointer)
        return context.get_dummy_value()

    return types.void(types.intp, types.float64), generate


@njit(cache=True)  # type: ignore[untyped-decorator]
def _gather(part: int, t: Tables, u: Floats, y: Floats, buffer: Floats, step: int) -> None:
    """Sum what arrives at a part's inputs; delayed senders come from their ring buffers."""
    for slot in range(t.u_at[part], t.u_at[part + 1]):
        value = t.base[slot]
        for c in range(t.senders[slot], t.senders[slot + 1]):
            k = t.line[c]
            if k < 0:
                value += y[t.source[c]]
                continue
            newest = step - t.line_whole[k]
            sent = buffer[t.line_begin[k] + newest % t.line_size[k]]
            if t.line_rest[k] > 0.0:
                older = buffer[t.line_begin[k] + (newest - 1) % t.line_size[k]]
                sent = (1.0 - t.line_rest[k]) * sent + t.line_rest[k] * older
            value += sent
        u[slot] = value


@njit(cache=True)  # type: ignore[untyped-decorator]
def _finite(table: Floats, begin: int, end: int) -> bool:
    for i in range(begin, end):  # noqa: SIM110 (a loop is what native code is)
        if not np.isfinite(table[i]):
            return False
    return True


@njit(cache=True)  # type: ignore[untyped-decorator]
def _run_stage(stage: int, part: int, t: Tables, at: Addresses, dt: float) -> int:
    p, u, x, y = at
    code: int = _call(
        t.kernels[part],
        stage,
        p + 8 * t.p_at[part],
        u + 8 * t.u_at[part],
        x + 8 * t.x_at[part],
        y + 8 * t.y_at[part],
        dt,
    )
    return code


@njit(cache=True)  # type: ignore[untyped-decorator]
def _begin(part: int, t: Tables, at: Addresses, x: Floats, dt: float) -> int:
    """Set the states of one part; values given in the spec come last."""
    if _run_stage(START, part, t, at, dt):
        return RAISED
    for i in range(t.initial_place.size):
        x[t.initial_place[i]] = t.initial_value[i]
    return COMPLETED if _finite(x, t.x_at[part], t.x_at[part + 1]) else NOT_FINITE


@njit(cache=True)  # type: ignore[untyped-decorator]
def _outputs(
    moment: int, t: Tables, at: Addresses, u: Floats, x: Floats, y: Floats, buffer: Floats, step: int, dt: float
) -> tuple[int, int, int]:
    """Call every `output` in order (at the start, `start` before it): status, part and stage."""
    for c in range(t.calls.shape[0]):
        part, last = t.calls[c]
        _gather(part, t, u, y, buffer, step)
        status, stage = COMPLETED, START
        if last and moment != RUNNING:
            status = _begin(part, t, at, x, dt)
        if status == COMPLETED:
            stage = OUTPUT
            if _run_stage(OUTPUT, part, t, at, dt):
                status = RAISED
            elif last and not _finite(y, t.y_at[part], t.y_at[part + 1]):
                status = NOT_FINITE
        if status != COMPLETED and moment != EARLY_ROUND:
            return status, part, stage
    return COMPLETED, 0, 0


@njit(cache=True)  # type: ignore[untyped-decorator]
def _read(t: Tables, y: Floats) -> None:
    for i in range(t.reads.shape[0]):
        y[t.reads[i, 1]] = _load(t.reads[i, 0])


@njit(cache=True)  # type: ignore[untyped-decorator]
def _start(
    t: Tables, at: Addresses, u: Floats, x: Floats, y: Floats, buffer: Floats, dt: float
) -> tuple[int, int, int]:
    """Start all parts in rounds, so that what goes in circles (a fiber, its reflex, its activation) is read."""
    _read(t, y)
    failure = (COMPLETED, 0, 0)
    for i in range(STARTING_ROUNDS):
        moment = LAST_ROUND if i == STARTING_ROUNDS - 1 else EARLY_ROUND
        failure = _outputs(moment, t, at, u, x, y, buffer, 0, dt)
        for k in range(t.line_source.size):
            sent = t.line_initial[k]
            if np.isnan(sent):
                sent = y[t.line_source[k]]
            buffer[t.line_begin[k] : t.line_begin[k] + t.line_size[k]] = sent
    return failure


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def simulate(
    steps: int,
    dt: float,
    model: int,
    data: int,
    qpos: Floats,
    qvel: Floats,
    t: Tables,
    p: Floats,
    u: Floats,
    x: Floats,
    y: Floats,
    buffer: Floats,
    record: Floats,
) -> tuple[int, int, int, int]:
    """Run a posed model: status, part, stage and the number of steps done.

    `record` has a row for each instant, or none if no trajectory is wanted.
    """
    at = (p.ctypes.data, u.ctypes.data, x.ctypes.data, y.ctypes.data)
    status, part, stage = _start(t, at, u, x, y, buffer, dt)
    if status:
        return status, part, stage, 0
    for k in range(steps):
        _step1(model, data)
        _read(t, y)
        status, part, stage = _outputs(RUNNING, t, at, u, x, y, buffer, k, dt)
        if status:
            return status, part, stage, k
        for i in range(t.appliers.size):
            _gather(t.appliers[i], t, u, y, buffer, k)
        for i in range(t.writes.shape[0]):
            address, of_outputs, place = t.writes[i]
            _store(address, t.signs[i] * (y[place] if of_outputs else u[place]))
        for i in range(t.line_source.size):
            buffer[t.line_begin[i] + k % t.line_size[i]] = y[t.line_source[i]]
        if record.shape[0]:
            for i in range(t.signals.size):
                place = t.signals[i]
                record[k, i] = y[place] if place < y.size else x[place - y.size]
        for i in range(t.stops.size):
            if y[t.stops[i]] > 0.5:
                return STOPPED, t.stops[i], 0, k
        for i in range(t.updates.size):
            part = t.updates[i]
            _gather(part, t, u, y, buffer, k)
            if _run_stage(UPDATE, part, t, at, dt):
                return RAISED, part, UPDATE, k
            if not _finite(x, t.x_at[part], t.x_at[part + 1]):
                return NOT_FINITE, part, UPDATE, k
        _step2(model, data)
        if not (_finite(qpos, 0, qpos.size) and _finite(qvel, 0, qvel.size)):
            return DIVERGED, 0, 0, k
    return COMPLETED, 0, 0, steps
