"""The order in which outputs are computed, so that the inputs of each are computed before it."""

from __future__ import annotations

import heapq
from collections.abc import Iterable
from dataclasses import dataclass

from gaitsim.errors import Fault, InvalidSpec
from gaitsim.model import Connection, Model

Port = tuple[int, str]


@dataclass(frozen=True)
class Call:
    """One call of a part's `output`. At the last call of a step, all inputs of the part are known."""

    part: int
    last: bool


def schedule(model: Model, delayed: Iterable[Connection]) -> tuple[Call, ...]:
    """Order the calls of `output`. A part is called again if some of its outputs need outputs that depend on others
    of it.

    Args:
        model: The model.
        delayed: The connections with a delay, which do not count.

    Raises:
        InvalidSpec: A loop has neither a state nor a delay; the message shows the loop.
    """
    index = {part.address: i for i, part in enumerate(model.parts)}
    cut = {id(connection) for connection in delayed}
    senders: dict[Port, list[Port]] = {}
    for connection in model.connections:
        if id(connection) not in cut:
            target = _port(connection.target, index)
            senders.setdefault(target, []).append(_port(connection.sender, index))
    needs: dict[Port, set[Port]] = {}
    for i, part in enumerate(model.parts):
        for output, inputs in part.type.dependencies.items():
            if "output" in part.type.functions:
                needs[i, output] = {s for name in inputs for s in senders.get((i, name), [])}
    calls = _ordered(model, needs)
    last = {part: k for k, part in enumerate(calls)}
    return tuple(Call(part, last[part] == k) for k, part in enumerate(calls))


class _Waiting:
    """The outputs that are not computed yet, and for each the number of inputs that are missing."""

    def __init__(self, needs: dict[Port, set[Port]]) -> None:
        self.lacking = {port: sum(need in needs for need in wanted) for port, wanted in needs.items()}
        self.outputs: dict[int, set[str]] = {}
        self.readers: dict[Port, list[Port]] = {}
        for (part, output), wanted in needs.items():
            self.outputs.setdefault(part, set()).add(output)
            for need in wanted:
                self.readers.setdefault(need, []).append((part, output))
        self.ready: dict[int, set[str]] = {part: set() for part in self.outputs}
        self.queue: list[tuple[int, int]] = []
        for port, lacking in self.lacking.items():
            if not lacking:
                self._can(port)

    def next(self) -> int | None:
        """The part to call next; None if no part can be called."""
        while self.queue:
            rank, part = heapq.heappop(self.queue)
            if self.ready[part] and rank == self._rank(part):
                return part
        return None

    def call(self, part: int) -> None:
        """Compute the outputs of a part that can be computed."""
        done, self.ready[part] = self.ready[part], set()
        self.outputs[part] -= done
        for output in done:
            for reader in self.readers.get((part, output), ()):
                self.lacking[reader] -= 1
                if not self.lacking[reader]:
                    self._can(reader)

    def _can(self, port: Port) -> None:
        part, output = port
        self.ready[part].add(output)
        rank = self._rank(part)
        if rank is not None:
            heapq.heappush(self.queue, (rank, part))

    def _rank(self, part: int) -> int | None:
        """The preference of a part: 0 if all its outputs can be computed, 1 if it is called again in any case, 2 if
        it would have to be called again, None if a call computes nothing.
        """
        if self.ready[part] == self.outputs[part]:
            return 0
        reached = {port for output in self.ready[part] for port in self.readers.get((part, output), ())}
        if not reached:
            return None
        ahead = list(reached)
        while ahead:
            port = ahead.pop()
            # Outputs that can be computed lead to outputs that cannot be yet.
            if port[0] == part:
                return 1
            following = [reader for reader in self.readers.get(port, ()) if reader not in reached]
            reached.update(following)
            ahead += following
        return 2


def _ordered(model: Model, needs: dict[Port, set[Port]]) -> list[int]:
    waiting = _Waiting(needs)
    # A part without outputs, or whose outputs MuJoCo sets, is called once all others are done.
    rest = [i for i in range(len(model.parts)) if i not in waiting.outputs]
    calls: list[int] = []
    while (part := waiting.next()) is not None:
        calls.append(part)
        waiting.call(part)
    left = {part: outputs for part, outputs in waiting.outputs.items() if outputs}
    if left:
        raise InvalidSpec(_loop(model, needs, left))
    return calls + rest


def _loop(model: Model, needs: dict[Port, set[Port]], waiting: dict[int, set[str]]) -> Fault:
    """A fault that shows one loop, sender by sender."""
    ports = [(part, output) for part, outputs in waiting.items() for output in sorted(outputs)]
    port = next(p for p in ports if any(n[1] in waiting.get(n[0], ()) for n in needs[p]))
    path: list[Port] = []
    while port not in path:
        path.append(port)
        port = next(n for n in sorted(needs[port]) if n[1] in waiting.get(n[0], ()))
    ring = [*path[path.index(port) :], port][::-1]
    loop = " -> ".join(f"{model.parts[part].address}.{output}" for part, output in ring)
    first = model.parts[ring[0][0]]
    message = f"a loop without a state or a delay: {loop}; give one of these connections a delay."
    return Fault(message, model.place(first), first.address)


def _port(text: str, index: dict[str, int]) -> Port:
    owner, _, name = text.rpartition(".")
    return index[owner], name
