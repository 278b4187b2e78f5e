"""Perturbations that cannot act in a run."""

from __future__ import annotations

from collections.abc import Iterator

from gaitsim.errors import Fault
from gaitsim.model import Model, Part


def idle_perturbations(model: Model) -> Iterator[Fault]:
    """Pulses without a duration, after the end of the run, or after an event that no part reports.

    Args:
        model: The model.

    Yields:
        One fault for each, at the number that prevents it.
    """
    values = model.values()
    for part in (part for part in model.parts if part.type.kind == "perturbation"):
        numbers = {name: values[index] for name, index in part.numbers.items()}
        for name, rule in _reasons(model, part, numbers):
            mark = model.numbers[part.numbers[name]].mark or model.place(part)
            yield Fault(f"{rule}.", mark, f"{part.address}.{name}")
            break


def _reasons(model: Model, part: Part, numbers: dict[str, float]) -> Iterator[tuple[str, str]]:
    """The number that prevents a pulse, with the rule and the next move."""
    end, never = model.simulate.duration, "so it never acts"
    if numbers.get("duration") == 0:
        yield "duration", f"the pulse takes 0 s, {never}; write a longer one, such as 100 ms"
    if numbers.get("event_number", 0) > 0 and not _connected(model, f"{part.address}.event"):
        rule = f"the pulse follows event {numbers['event_number']:g}, but event is connected to nothing"
        yield "event_number", f"{rule}, {never}; write event: {{from: part.output}}, or remove event_number"
    elif numbers.get("event_number", 0) == 0 and numbers.get("onset", 0) >= end:
        rule = f"the pulse begins at {numbers['onset']:g} s and the run ends at {end:g} s"
        yield "onset", f"{rule}, {never}; write an earlier onset or a longer simulate.duration"


def _connected(model: Model, port: str) -> bool:
    return any(connection.target == port for connection in model.connections)
