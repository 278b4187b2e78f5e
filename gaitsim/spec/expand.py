"""From entries to parts: composites are opened, sides doubled, masks evaluated."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

from gaitsim.component import Input
from gaitsim.errors import Faults, GaitsimError, did_you_mean
from gaitsim.model import Group, Part
from gaitsim.parts.composite import ComponentFile, Composite
from gaitsim.parts.find import Library, at
from gaitsim.parts.primitive import Primitive
from gaitsim.spec.document import Mapping, Node, Scalar, Sequence
from gaitsim.spec.inheritance import merged, without
from gaitsim.spec.numbers import NumberTable
from gaitsim.spec.points import PointReader
from gaitsim.spec.ports import PortReader, Wire
from gaitsim.spec.scope import Scope, Where

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_SIDES = ("l", "r")
_STRUCTURE = ("use", "sides", "to")


@dataclass
class Expansion:
    """What opening a spec yields; ports and frames keep the names they were given."""

    library: Library
    faults: Faults
    use_for: dict[str, str]
    table: NumberTable
    parts: list[Part] = field(default_factory=list)
    groups: list[Group] = field(default_factory=list)
    outputs: dict[str, str] = field(default_factory=dict)
    inputs: dict[str, list[str]] = field(default_factory=dict)
    frames: dict[str, str] = field(default_factory=dict)
    notices: list[str] = field(default_factory=list)
    broken: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.ports = PortReader(self.table, self.faults)
        self.points = PointReader(self.table, self.faults)

    @property
    def wires(self) -> list[Wire]:
        return self.ports.wires

    def section(self, section: Mapping, scope: Scope, side: str = "", measure: bool = False) -> None:
        """Open every entry of `parts:` or `measures:`."""
        sided = {name: _sides(node, self.faults, name) for name, node in section.entries.items()}
        overrides = {f"{name}_{s}" for name, sides in sided.items() for s in sides}
        for name, sides in sided.items():
            names = tuple(f"{name}_{s}" for s in sides) or (name,)
            scope.children.update({each: scope.below(each) for each in names})
            if sides:
                scope.sided[name] = names
        for name, node in section.entries.items():
            mark = section.keys[name]
            where = Where(scope.below(name), _join(scope.logical, name), scope, mark, side, measure)
            if not _NAME.fullmatch(name):
                rule = f'"{name}" is no name; use letters, digits and _ and begin with a letter.'
                self.faults.add(rule, mark, where.address)
            if isinstance(node, Scalar) and node.value is None:
                others = [other for other in section.entries if other != name]
                rule = f"there is nothing to remove. {did_you_mean(name, others)}"
                self.faults.add(rule, mark, where.address)
                continue
            if not isinstance(node, Mapping):
                rule = "a part is a mapping that begins with use:, such as {use: segment/rod}."
                self.faults.add(rule, mark, where.address)
                continue
            for s in sided[name]:
                over = section.entries.get(f"{name}_{s}")
                own = replace(where, address=scope.below(f"{name}_{s}"), side=s)
                both = without(node, "sides")
                self._entry(merged(both, over) if isinstance(over, Mapping) else both, own)
            if not sided[name] and name not in overrides:
                self._entry(node, where)

    def finish(self) -> None:
        """What needs every part to be known: points with a `%` of a segment's length."""
        self.points.read_all()

    def _entry(self, node: Mapping, where: Where) -> None:
        found, swapped = self._component(node, where)
        if found is None:
            self.broken.add(where.address)
            return
        node = self._known_words(node, found, where, swapped)
        if isinstance(found, Composite):
            self._composite(found, node, where)
        else:
            self._primitive(found, node, where)

    def _component(self, node: Mapping, where: Where) -> tuple[ComponentFile | None, frozenset[str]]:
        use = node.entries.get("use")
        if use is None:
            self.faults.add("says no component; write use: kind/name.", where.mark, where.address)
            return None, frozenset()
        if not isinstance(use, Scalar) or not isinstance(use.value, str):
            rule = "use: names a component, such as muscle/geyer2003."
            self.faults.add(rule, use.mark, where.address)
            return None, frozenset()
        reference, swapped = use.value, node.swapped
        instead = self.use_for.get(reference.split("/")[0], reference)
        if instead != reference:
            reference, swapped = instead, swapped | frozenset(node.entries)
        try:
            return self.library.find(reference), swapped
        except GaitsimError as error:
            for fault in at(use.mark, where.address, error):
                self.faults.add(fault.message, fault.mark, fault.address)
            return None, swapped

    def _known_words(self, node: Mapping, found: ComponentFile, where: Where, swapped: frozenset[str]) -> Mapping:
        """The entry without what a swapped-in part lacks; other unknown words are faults."""
        known = [*found.words, *_STRUCTURE]
        unknown = [word for word in node.entries if word not in known]
        for word in unknown:
            if word in swapped:
                self.notices.append(f"{where.address}: {found.reference} has no {word}; dropped")
            else:
                hint = did_you_mean(word, known)
                self.faults.add(f"{found.reference} has no {word}. {hint}", node.keys[word], where.address)
        return without(node, *unknown)

    def _composite(self, found: Composite, node: Mapping, where: Where) -> None:
        chain = where.scope.references
        if found.reference in chain:
            ring = " -> ".join([*chain[chain.index(found.reference) :], found.reference])
            self.faults.add(f"a composite contains itself: {ring}; take one of them out.", where.mark, where.address)
            return
        address = where.address
        self.groups.append(Group(address, found.reference, where.mark))
        inside = Scope(
            address, where.logical, found.document.mark.file, {}, found.reference, outer=where.scope
        )
        for name, declared in found.parameters.items():
            given = node.entries.get(name, found.defaults.get(name))
            if given is None:
                self.faults.add(f"needs {name} in {declared.unit}; write it.", where.mark, address)
            names = where.scope.names if name in node.entries else dict(inside.names)
            index = self.table.add(f"{address}.{name}", f"{where.logical}.{name}", given, declared, names)
            inside.names[name] = (index, declared.unit)
        inside.attachments = self.ports.attachments(found.attachments, node, where)
        self.frames.update({f"{address}.{n}": f"{address}.{t}" for n, t in found.frames.items()})
        self.outputs.update({f"{address}.{n}": f"{address}.{t}" for n, t in found.outputs.items()})
        for name, targets in found.inputs.items():
            self.inputs[f"{address}.{name}"] = [f"{address}.{target}" for target in targets]
            self.ports.input(name, Input("*", name), node, where)
        self.ports.to(node, list(found.outputs), where)
        own = without(node, *(word for word in node.entries if word not in found.parts.entries))
        self.section(merged(found.parts, own), inside, where.side, where.measure)

    def _primitive(self, found: Primitive, node: Mapping, where: Where) -> None:
        address = where.address
        numbers = {}
        for name, declared in found.parameters.items():
            given = node.entries.get(name)
            if given is None and declared.default is None:
                rule = f"needs {name} in {declared.unit} ({declared.doc.rstrip('.')}); write it."
                self.faults.add(rule, where.mark, address)
            names = where.scope.names
            numbers[name] = self.table.add(f"{address}.{name}", f"{where.logical}.{name}", given, declared, names)
        self.outputs.update({f"{address}.{name}": f"{address}.{name}" for name in found.outputs})
        self.inputs.update({f"{address}.{name}": [f"{address}.{name}"] for name in found.inputs})
        self.frames.update({f"{address}.{name}": f"{address}.{name}" for name in found.frames})
        for name, port in found.inputs.items():
            self.ports.input(name, port, node, where)
        self.ports.to(node, list(found.outputs), where)
        self.parts.append(
            Part(
                address,
                found,
                numbers,
                {},
                {name: self.ports.option(name, o, node, where) for name, o in found.options.items()},
                self.ports.attachments(found.attachments, node, where),
                {name: self.points.later(name, node, where) for name in found.points},
                where.side == "l",
                where.measure,
                where.mark,
            )
        )
        self._inner_parts(found, node, where)

    def _inner_parts(self, found: Primitive, node: Mapping, where: Where) -> None:
        """The parts inside a primitive, such as a muscle's path, and their wiring."""
        for name, slot in found.parts.items():
            own = node.entries.get(name, Mapping({}, {}, where.mark))
            rule = f"{name}: {{use: {slot.kind}/...}}"
            if not isinstance(own, Mapping):
                self.faults.add(f"{name} is a part; write {rule}.", own.mark, where.address)
                continue
            if "use" not in own.entries and slot.default is None:
                self.faults.add(f"needs {name} ({slot.doc.rstrip('.')}); write {rule}.", where.mark, where.address)
                continue
            default = Scalar(slot.default, where.mark)
            entry = merged(Mapping({"use": default}, {"use": where.mark}, own.mark), own)
            inner = replace(
                where,
                address=f"{where.address}.{name}",
                logical=f"{where.logical}.{name}",
                mark=node.keys.get(name, where.mark),
            )
            self._entry(entry, inner)
            for mine, theirs in slot.reads:
                self.ports.wire(f"{inner.address}.{theirs}", f"{where.address}.{mine}", where)
            for theirs, mine in slot.sends:
                if mine in found.outputs:
                    self.ports.wire(f"{where.address}.{mine}", f"{inner.address}.{theirs}", where)
                else:
                    self.inputs[f"{where.address}.{mine}"].append(f"{inner.address}.{theirs}")


def _join(*words: str) -> str:
    return ".".join(word for word in words if word)


def _sides(node: Node, faults: Faults, name: str) -> tuple[str, ...]:
    sides = node.entries.get("sides") if isinstance(node, Mapping) else None
    if sides is None:
        return ()
    items = sides.items if isinstance(sides, Sequence) else (sides,)
    words = tuple(str(item.value) for item in items if isinstance(item, Scalar))
    if not words or len(set(words)) != len(items) or not set(words) <= set(_SIDES):
        faults.add("sides is [l, r], [l] or [r].", sides.mark, name)
        return ()
    return words
