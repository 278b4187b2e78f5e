"""Points on segments, such as `{on: shank, at: [-4 cm, 0 m, 30 %]}`. Each coordinate is a number of the model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from gaitsim.component import Parameter
from gaitsim.errors import Faults, did_you_mean
from gaitsim.model import WORLD, Place
from gaitsim.spec.numbers import NumberTable
from gaitsim.spec.scope import Where, absolute
from gaitsim.text.document import MappingNode, Node, ScalarNode, SequenceNode
from gaitsim.text.quantity import comma_within
from gaitsim.text.spelling import respelled

_LENGTH = Parameter("m", "a coordinate")
_FRACTION = Parameter("1", "a fraction of the segment's length")
_FIELDS = ("on", "at")


@dataclass
class PointReader:
    """Reads lists of points. A `%` needs the lengths of segments, so points are read after all parts are known."""

    table: NumberTable
    faults: Faults
    frames: Mapping[str, str]
    broken: Callable[[str], bool]
    _waiting: list[tuple[str, Node, Where, list[Place]]] = field(default_factory=list)

    def later(self, name: str, node: MappingNode, where: Where) -> list[Place]:
        """The points of an entry. The list is empty until `read_all` is called."""
        given, places = node.entries.get(name), list[Place]()
        if isinstance(given, SequenceNode):
            self._waiting.append((name, given, where, places))
        else:
            rule = f"needs {name}, a list of places; write {name}: [{{on: shank, at: [-4 cm, 0 m, 30 %]}}, ...]."
            self.faults.add(rule, given.mark if given else where.mark, where.address)
        return places

    def one_later(self, name: str, node: MappingNode, where: Where) -> list[Place]:
        """The place of an attachment, `{on: pelvis.center, at: [...]}`. The list is empty until `read_all` is
        called.
        """
        places = list[Place]()
        self._waiting.append((name, node, where, places))
        return places

    def read_all(self) -> None:
        """Read all points."""
        for name, node, where, places in self._waiting:
            items = node.items if isinstance(node, SequenceNode) else (node,)
            names = [f"{name}.{i}" for i in range(len(items))] if isinstance(node, SequenceNode) else [name]
            found = [self._place(each, item, where) for each, item in zip(names, items, strict=True)]
            places += [place for place in found if place]
        self._waiting.clear()

    def _place(self, name: str, node: Node, where: Where) -> Place | None:
        address = f"{where.address}.{name}"
        before = len(self.faults.found)
        if isinstance(node, MappingNode):
            node = respelled(node, _FIELDS, "a point has no key", self.faults, address)
        if not isinstance(node, MappingNode) or set(node.entries) != set(_FIELDS):
            if len(self.faults.found) > before:
                return None
            rule = "a point says on which part it lies and where; write {on: shank, at: [-4 cm, 0 m, 30 %]}."
            self.faults.add(rule, node.mark, address)
            return None
        on, at = node.entries["on"], node.entries["at"]
        if not isinstance(at, SequenceNode) or len(at.items) != 3:
            hint = comma_within(at) if isinstance(at, SequenceNode) else ""
            rule = "at: needs three coordinates; write such as at: [-4 cm, 0 m, 30 %]."
            self.faults.add(f"{rule}{hint}", at.mark, address)
            return None
        if not isinstance(on, ScalarNode) or not isinstance(on.value, str):
            self.faults.add("on: names a part or a frame; write such as on: shank.", on.mark, address)
            return None
        frame = absolute(on.value, where, on.mark, self.faults)
        if frame is None or self.broken(frame) or not self._has_frame(frame, on, address):
            return None
        x, y, z = (self._coordinate(f"{name}.at.{i}", item, where, frame) for i, item in enumerate(at.items))
        return Place(frame, (x, y, z))

    def _has_frame(self, frame: str, on: ScalarNode, address: str) -> bool:
        """Whether points can lie on a part or a frame."""
        if frame == WORLD or any(f == frame or f.startswith(f"{frame}.") for f in self.frames):
            return True
        bodies = {WORLD} | {name.rpartition(".")[0] for name in self.frames}
        near = did_you_mean(frame, [*self.frames] if frame.rpartition(".")[0] in bodies else bodies)
        self.faults.add(f"points cannot lie on {on.value}, which has no frame. {near}", on.mark, address)
        return False

    def _coordinate(self, name: str, node: Node, where: Where, frame: str) -> int:
        address, logical = f"{where.address}.{name}", f"{where.logical}.{name}"
        value = node.entries.get("value") if isinstance(node, MappingNode) else node
        text = value.value if isinstance(value, ScalarNode) else None
        if not (isinstance(text, str) and text.rstrip().endswith("%")):
            return self.table.add(address, logical, node, _LENGTH, where.scope.names)
        length = self._length(frame)
        if length is None:
            rule = f"{frame} has no length, so % means nothing here; write a length, such as 12 cm."
            self.faults.add(rule, node.mark, address)
        return self.table.add(address, logical, node, _FRACTION, where.scope.names, fraction_of=length)

    def _length(self, frame: str) -> int | None:
        """The number that is the length of the segment of a frame."""
        owner = frame
        while owner:
            if f"{owner}.length" in self.table.index:
                return self.table.index[f"{owner}.length"]
            owner = owner.rpartition(".")[0]
        return None
