"""Messages of failed runs: the component, the function, the instant and the values, in one sentence."""

from __future__ import annotations

import traceback

import numpy as np

from gaitsim.compiler.native import EVENTS
from gaitsim.compiler.program import Floats, Program
from gaitsim.model import Part
from gaitsim.simulation.view import View, views

_NEXT = "try a shorter step"


def of_exception(program: Program, part: int, stage: str, step: int, error: Exception) -> str:
    """The message for an exception that a component raised, with its line."""
    return raised_in(program.model.parts[part], stage, _when(program, step), error)


def raised_in(part: Part, function: str, moment: str, error: Exception) -> str:
    """The message for an exception that a part's function raised at an instant, with its line."""
    lines = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == part.type.display_path]
    place = f"{part.type.display_path}:{lines[-1]}" if lines else function
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return f"{part.address} ({part.type.reference}) raised in {function} at {moment} ({place}): {reason}"


def of_values(program: Program, part: int, stage: str, step: int, u: Floats, x: Floats, y: Floats) -> str:
    """The message for outputs or states that are not finite, about the part where this began."""
    origin = _origin(program, _read_slots(program, part, stage, y), u, y)
    if origin is not None:
        part, stage = origin, "output"
    _, _, states, outputs = views(program, part, u, u, x, y)
    fields: View = outputs if stage == "output" else states
    names = program.model.parts[part].type
    owned = names.outputs if stage == "output" else names.states
    wrong = [
        f"{name} = {np.ravel(getattr(fields, name))[~np.isfinite(np.ravel(getattr(fields, name)))][0]}"
        for name in owned
        if not np.all(np.isfinite(getattr(fields, name)))
    ]
    return f"{_who(program, part)} gives no finite number in {stage} at {_when(program, step)}: {', '.join(wrong)}"


def _read_slots(program: Program, part: int, stage: str, y: Floats) -> list[int]:
    """The inputs that values which are not finite may come from."""
    kind = program.model.parts[part].type
    wrong = [name for name in kind.outputs if not np.isfinite(y[program.outputs.place(part, name)])]
    needed = {name for output in wrong for name in kind.dependencies[output]}
    read = [name for name in kind.inputs if stage != "output" or name in needed]
    return [program.inputs.place(part, name) for name in read]


def _origin(program: Program, slots: list[int], u: Floats, y: Floats) -> int | None:
    """The part behind these inputs whose output is not finite although all of its own inputs are."""
    for sender, line in (sender for slot in slots for sender in program.senders[slot]):
        if line >= 0 or np.isfinite(y[sender]):
            continue
        part = program.part_of_output(sender)
        kind, fields = program.model.parts[part].type, program.outputs.fields[part]
        name = next(name for name in kind.outputs if program.outputs.offsets[part] + fields[name] == sender)
        needed = [program.inputs.place(part, n) for n in kind.dependencies[name]]
        if np.all(np.isfinite(u[needed])):
            return part
        found = _origin(program, needed, u, y)
        if found is not None:
            return found
    return None


def of_events(program: Program, parts: list[int], step: int) -> str:
    """The message for events without end: each is followed by the next one at once."""
    who = " and ".join(_who(program, part) for part in parts)
    rule = f"{who} has {EVENTS} events within one step at {_when(program, step)}"
    return f"{rule}; let its guard be below 0 for a while after a reset"


def of_mechanics(program: Program, wrong: list[str], step: int) -> str:
    """The message for joint coordinates that are not finite."""
    where = f" in {', '.join(wrong)}" if wrong else ""
    return f"the mechanics diverged{where} at {_when(program, step)}; {_NEXT}"


def of_nothing_found(program: Program, step: int) -> str:
    """The message for a run that native code ended and for which plain Python finds no reason."""
    reason = f"native code raised or gave no finite number at {_when(program, step)}, and plain Python does not"
    return f"{reason}; run it with --mode normal"


def of_runaway(program: Program, joint: str, speed: float, unit: str, step: int) -> str:
    """The message for a joint that moves faster than a step can resolve."""
    dt = program.model.simulate.step
    rule = f"the mechanics diverged: {joint} moves at {speed:.3g} {unit}/s at {_when(program, step)}"
    return (
        f"{rule}, which is {speed * dt:.2g} {unit} in a step of {1e3 * dt:g} ms; {_NEXT}, or less stiffness and damping"
    )


def _who(program: Program, part: int) -> str:
    found = program.model.parts[part]
    return f"{found.address} ({found.type.reference})"


def _when(program: Program, step: int) -> str:
    return f"{step * program.model.simulate.step:g} s"
