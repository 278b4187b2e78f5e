"""In what order outputs are computed, so that every one finds its inputs done."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from gaitsim.errors import Fault, InvalidSpec
from gaitsim.model import Connection, Model

Port = tuple[int, str]


@dataclass(frozen=True)
class Call:
    """One call of a part's `output`; the last one of a step has all its inputs."""

    part: int
    last: bool


def schedule(model: Model, delayed: Iterable[Connection]) -> tuple[Call, ...]:
    """Calls of `output` in order: a part is called again if some outputs wait for others' outputs.

    Errors: InvalidSpec for a loop without a state or a delay; it prints the loop.
    """
    index = {part.address: i for i, part in enumerate(model.parts)}
    cut = {id(connection) for connection in delayed}
    senders: dict[Port, list[Port]] = {}
    for connection in model.connections:
        if id(connection) not in cut:
            target = _port(connection.target, index)
            senders.setdefault(target, []).append(_port(connection.source, index))
    needs: dict[Port, set[Port]] = {}
    for i, part in enumerate(model.parts):
        for output, inputs in part.type.dependencies.items():
            if "output" in part.type.functions:
                needs[i, output] = {s for name in inputs for s in senders.get((i, name), [])}
    calls = _ordered(model, needs)
    last = {part: k for k, part in enumerate(calls)}
    return tuple(Call(part, last[part] == k) for k, part in enumerate(calls))


def _ordered(model: Model, needs: dict[Port, set[Port]]) -> list[int]:
    waiting: dict[int, set[str]] = {}
    for part, output in needs:
        waiting.setdefault(part, set()).add(output)
    # A part without outputs, or whose outputs MuJoCo sets, is called once all others are done.
    rest = [i for i in range(len(model.parts)) if i not in waiting]
    calls: list[int] = []
    while waiting:
        ready = {
            part: {o for o in outputs if not any(n in waiting.get(p, ()) for p, n in needs[part, o])}
            for part, outputs in waiting.items()
        }
        whole = [part for part in waiting if ready[part] == waiting[part]]
        # Only for an output that others wait for is a part called before all its inputs are there.
        wanted = {n for part, outputs in waiting.items() for o in outputs for n in needs[part, o]}
        some = whole or [p for p in waiting if any((p, o) in wanted for o in ready[p])]
        if not some:
            raise InvalidSpec(_loop(model, needs, waiting))
        part = some[0]
        calls.append(part)
        waiting[part] -= ready[part]
        if not waiting[part]:
            del waiting[part]
    return calls + rest


def _loop(model: Model, needs: dict[Port, set[Port]], waiting: dict[int, set[str]]) -> Fault:
    """A fault that prints one loop, sender by sender."""
    ports = [(part, output) for part, outputs in waiting.items() for output in sorted(outputs)]
    port = next(p for p in ports if any(n[1] in waiting.get(n[0], ()) for n in needs[p]))
    path: list[Port] = []
    while port not in path:
        path.append(port)
        port = next(n for n in sorted(needs[port]) if n[1] in waiting.get(n[0], ()))
    ring = [*path[path.index(port) :], port][::-1]
    words = " -> ".join(f"{model.parts[part].address}.{output}" for part, output in ring)
    first = model.parts[ring[0][0]]
    message = f"a loop without a state or a delay: {words}; give one of these connections a delay."
    return Fault(message, first.mark, first.address)


def _port(text: str, index: dict[str, int]) -> Port:
    owner, _, name = text.rpartition(".")
    return index[owner], name
