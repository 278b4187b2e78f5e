"""Expansion of entries to parts: composites are replaced by their inner parts, sides are doubled, parameters are
evaluated.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field, replace

from gaitsim.component import Input, Parameter
from gaitsim.component import Part as InnerPart
from gaitsim.components.composite import ComponentFile, Composite
from gaitsim.components.contract import read_contract
from gaitsim.components.driven import driven, obstacle
from gaitsim.components.find import Library, faults_at
from gaitsim.components.primitive import Primitive
from gaitsim.errors import Faults, GaitsimError, Mark, did_you_mean, nearest, with_article
from gaitsim.model import Group, Part, Place, Recording
from gaitsim.spec.inheritance import merged, without
from gaitsim.spec.numbers import SIGNAL, Names, NumberTable
from gaitsim.spec.points import PointReader
from gaitsim.spec.ports import PortReader, is_connection
from gaitsim.spec.scope import Scope, Where, Wire
from gaitsim.spec.series import SAMPLE, listed_sample, read_series
from gaitsim.text.document import MappingNode, Node, ScalarNode, SequenceNode, plain
from gaitsim.text.quantity import example
from gaitsim.text.spelling import respelled

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_SIDES = ("l", "r")
_STRUCTURE = ("use", "sides", "to")


@dataclass
class Expansion:
    """The result of expanding a spec. Ports and frames keep their names."""

    library: Library
    faults: Faults
    use_for: dict[str, MappingNode]
    table: NumberTable
    parts: list[Part] = field(default_factory=list)
    groups: list[Group] = field(default_factory=list)
    outputs: dict[str, str] = field(default_factory=dict)
    inputs: dict[str, list[str]] = field(default_factory=dict)
    frames: dict[str, str] = field(default_factory=dict)
    notices: list[str] = field(default_factory=list)
    dropped: set[Mark] = field(default_factory=set)
    broken: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.ports = PortReader(self.table, self.faults)
        self.points = PointReader(self.table, self.faults, self.frames, self.is_broken)

    @property
    def wires(self) -> list[Wire]:
        return self.ports.wires

    def is_broken(self, name: str) -> bool:
        """Whether a name belongs to an entry that could not be expanded. Its fault was reported already."""
        return any(name == part or name.startswith(f"{part}.") for part in self.broken)

    def announce(self, section: MappingNode, scope: Scope) -> None:
        """Register the names of a section before its entries are expanded, so that others can send to them."""
        for name, node in section.entries.items():
            both = sides(node)
            names = tuple(f"{name}_{s}" for s in both) or (name,)
            scope.children.update({each: scope.below(each) for each in names})
            if both:
                scope.sided[name] = names

    def section(self, section: MappingNode, scope: Scope, side: str = "", measure: bool = False) -> None:
        """Expand every entry of `parts:` or `measures:`.

        Args:
            section: The section.
            scope: The scope of its names.
            side: The side of all entries, l or r; empty for none.
            measure: Whether the entries are measures.
        """
        self.announce(section, scope)
        sided = {name: sides(node, self.faults, name) for name, node in section.entries.items()}
        overrides = {f"{name}_{s}" for name, both in sided.items() for s in both}
        for name, node in section.entries.items():
            mark = section.keys[name]
            where = Where(scope.below(name), _join(scope.logical, name), scope, mark, side, measure)
            if not _NAME.fullmatch(name):
                rule = f'"{name}" is not a name; use letters, digits and _ and begin with a letter.'
                self.faults.add(rule, mark, where.address)
                self.broken.add(where.address)
                continue
            if isinstance(node, ScalarNode) and node.value is None:
                others = [other for other in section.entries if other != name]
                rule = f"there is nothing to remove. {did_you_mean(name, others)}"
                self.faults.add(rule, mark, where.address)
                self.broken.add(where.address)
                continue
            if not isinstance(node, MappingNode):
                rule = "a part is a mapping that begins with use:, such as {use: segment/rod}."
                self.faults.add(rule, mark, where.address)
                self.broken.add(where.address)
                continue
            for s in sided[name]:
                over = section.entries.get(f"{name}_{s}")
                own = replace(where, address=scope.below(f"{name}_{s}"), side=s)
                own_node = without(node, "sides")
                self._entry(merged(own_node, over) if isinstance(over, MappingNode) else own_node, own)
            if not sided[name] and name not in overrides:
                self._entry(node, where)

    def single_entry(self, name: str, node: MappingNode, mark: Mark, scope: Scope) -> None:
        """Expand one entry whose name is unknown to other entries."""
        self._entry(node, Where(scope.below(name), _join(scope.logical, name), scope, mark))

    def finish(self) -> None:
        """Read what needs all parts: points with a `%` of the length of a segment."""
        self.points.read_all()

    def _entry(self, node: MappingNode, where: Where) -> None:
        node = self._instead(node, where)
        found, swapped = self._component(node, where)
        if found is None:
            self.broken.add(where.address)
            return
        node = self._known_words(node, found, where, swapped)
        if isinstance(found, Composite):
            self._composite(found, node, where)
        else:
            self._primitive(found, node, where)

    def _instead(self, node: MappingNode, where: Where) -> MappingNode:
        """The entry with the component that `use_for` gives for its kind. Inner parts of a component from `use_for`
        are not changed again.
        """
        use = node.entries.get("use")
        kind = str(use.value).split("/")[0] if isinstance(use, ScalarNode) else ""
        instead = self.use_for.get(kind)
        if instead is None or str(plain(instead.entries["use"])) in where.scope.references:
            return node
        return merged(node, instead)

    def _component(self, node: MappingNode, where: Where) -> tuple[ComponentFile | None, frozenset[str]]:
        use = node.entries.get("use")
        if use is None:
            # An entry without `use` changes an existing part. If there is none, which one was meant?
            name = where.address.rpartition(".")[2]
            near = nearest(name, where.scope.children.keys() - {name})
            hint = f" Did you mean {near}?" if near else ""
            self.faults.add(f"names no component; write use: kind/name.{hint}", where.mark, where.address)
            return None, frozenset()
        if not isinstance(use, ScalarNode) or not isinstance(use.value, str):
            rule = "use: names a component, such as muscle/geyer2003."
            self.faults.add(rule, use.mark, where.address)
            return None, frozenset()
        try:
            return self.library.find(use.value), node.swapped
        except GaitsimError as error:
            for fault in faults_at(use.mark, where.address, error):
                self.faults.add(fault.message, fault.mark, fault.address)
            return None, node.swapped

    def _known_words(
        self, node: MappingNode, found: ComponentFile, where: Where, swapped: frozenset[str]
    ) -> MappingNode:
        """The entry without the keys that a component from `use:` lacks; other unknown keys are faults."""
        dropped = [word for word in node.entries if word in swapped and word not in (*found.keys, *_STRUCTURE)]
        self.notices += [f"{where.address}: {found.reference} has no {word}; dropped" for word in dropped]
        self.dropped |= {node.keys[word] for word in dropped}
        rest = without(node, *dropped)
        return respelled(rest, found.keys, f"{found.reference} has no", self.faults, where.address, more=_STRUCTURE)

    def _composite(self, found: Composite, node: MappingNode, where: Where) -> None:
        chain = where.scope.references
        if found.reference in chain:
            ring = " -> ".join([*chain[chain.index(found.reference) :], found.reference])
            self.faults.add(f"a composite contains itself: {ring}; take one of them out.", where.mark, where.address)
            self.broken.add(where.address)
            return
        address = where.address
        self.groups.append(Group(address, found.reference, len(self.parts), where.mark, found.document.mark.file))
        inside = Scope(address, where.logical, found.document.mark.file, {}, found.reference, outer=where.scope)
        for name, declared in found.parameters.items():
            given = node.entries.get(name, found.defaults.get(name))
            written_in = where.scope if name in node.entries else inside
            if is_connection(given) or written_in.passed(given):
                self._signal(name, declared, given, written_in.passed(given), inside, where)
                continue
            if given is None:
                self.faults.add(_needs(name, declared), where.chosen(node.entries["use"].mark), address)
            names = where.scope.names if name in node.entries else dict(inside.names)
            index = self.table.add(
                f"{address}.{name}", f"{where.logical}.{name}", given, declared, names, default=name not in node.entries
            )
            inside.names[name] = (index, declared.unit)
        frames, inside.places = self._fastened(found.attachments, node, where)
        inside.attachments = dict.fromkeys(found.attachments, "") | frames
        self.frames.update({f"{address}.{n}": f"{address}.{t}" for n, t in found.frames.items()})
        self.outputs.update({f"{address}.{n}": f"{address}.{t}" for n, t in found.outputs.items()})
        for name, targets in found.inputs.items():
            self.inputs[f"{address}.{name}"] = [f"{address}.{target}" for target in targets]
            self.ports.input(name, Input("*", name), node, where)
        self.ports.to(node, list(found.outputs), where)
        own = without(node, *(word for word in node.entries if word not in found.parts.entries))
        self.section(merged(found.parts, own), inside, where.side, where.measure)
        self._exposed(found, address)

    def _signal(
        self, name: str, declared: Parameter, given: Node | None, wire: Wire | None, inside: Scope, where: Where
    ) -> None:
        """Keep the signal that sets a parameter of a composite, for the inner parts that it is passed on to."""
        port = f"{where.address}.{name}"
        if wire is None and isinstance(given, MappingNode):
            wire = self.ports.connection(given, port, f"{where.logical}.{name}", where)
        if wire is not None:
            inside.signals[name] = wire
        index = (
            SIGNAL if wire else self.table.add(port, port, None, declared, {})
        )  # after a fault it counts as a number
        inside.names[name] = (index, declared.unit)

    def _common(self, kind: str) -> Collection[str]:
        """The parameters that every component of a kind has."""
        found = self.library.contract(kind)
        return read_contract(found[1], str(found[0]))["parameters"] if found else ()

    def _exposed(self, found: Composite, address: str) -> None:
        """Check that every port and frame of a composite names something inside."""
        self._shown("frame", [*found.frames.items()], self.frames, found, address)
        self._shown("output", [*found.outputs.items()], self.outputs, found, address)
        inputs = [(name, target) for name, targets in found.inputs.items() for target in targets]
        self._shown("input", inputs, self.inputs, found, address)

    def _shown(
        self, what: str, pairs: Sequence[tuple[str, str]], known: Iterable[str], found: Composite, address: str
    ) -> None:
        below = f"{address}."
        inside = {name.removeprefix(below) for name in known if name.startswith(below)} - {name for name, _ in pairs}
        for name, target in pairs:
            if target not in inside and not self.is_broken(below + target):
                rule = f"there is no {what} {target} inside. {did_you_mean(target, inside)}"
                self.faults.add(rule, found.mark(f"{what}s", name), f"{found.reference}.{name}")
                self.broken.add(below + name)

    def _primitive(self, found: Primitive, node: MappingNode, where: Where) -> None:
        address = where.address
        entries = {name: node.entries.get(name) for name in found.parameters}
        signals = [name for name, one in entries.items() if is_connection(one) or where.scope.passed(one)]
        if signals:
            common = self._common(found.kind)
            obstacles = [(name, why) for name in signals if (why := obstacle(found, name, common))]
            for name, why in obstacles:
                rule = f"{why}, so no signal can set it; give it a number."
                self.faults.add(rule, node.entries[name].mark, f"{address}.{name}")
            if obstacles:
                self.broken.add(address)
                return
            found = driven(found, frozenset(signals))
        numbers = {}
        for name, declared in found.parameters.items():
            given, names = node.entries.get(name), where.scope.names
            if given is None and name in where.given:
                given, names = where.given[name]
            if given is None and declared.default is None:
                self.faults.add(_needs(name, declared), where.chosen(node.entries["use"].mark), address)
            numbers[name] = self.table.add(f"{address}.{name}", f"{where.logical}.{name}", given, declared, names)
        self.outputs.update({f"{address}.{name}": f"{address}.{name}" for name in found.outputs})
        self.inputs.update({f"{address}.{name}": [f"{address}.{name}"] for name in found.inputs})
        self.frames.update({f"{address}.{name}": f"{address}.{name}" for name in found.frames})
        for name, port in found.inputs.items():
            self.ports.input(name, port, node, where)
        for name, link in found.links.items():
            self.ports.link(name, link, node, where)
        self.ports.to(node, list(found.outputs), where)
        frames, places = self._fastened(found.attachments, node, where)
        self.parts.append(
            Part(
                address,
                found,
                numbers,
                {},
                {name: self.ports.option(name, o, node, where) for name, o in found.options.items()},
                frames,
                {name: self.points.later(name, node, where) for name in found.points},
                where.side == "l",
                where.measure,
                where.mark,
                self._series(found, node, where),
                places,
            )
        )
        self._inner_parts(found, node, where, {n: (numbers[n], d.unit) for n, d in found.parameters.items()})

    def _fastened(
        self, names: Iterable[str], node: MappingNode, where: Where
    ) -> tuple[dict[str, str], dict[str, list[Place]]]:
        """The frames to which an entry is fastened, and places beside frames."""
        places = {}
        for name in names:
            given = node.entries.get(name)
            text = given.value if isinstance(given, ScalarNode) else None
            if isinstance(given, MappingNode):
                places[name] = self.points.one_later(name, given, where)
            elif isinstance(text, str) and text[:1] == "=" and text[1:] in where.scope.places:
                places[name] = where.scope.places[text[1:]]
        return self.ports.attachments([name for name in names if name not in places], node, where), places

    def _series(self, found: Primitive, node: MappingNode, where: Where) -> dict[str, Recording]:
        """The recorded curves of a part."""
        made = {}
        for name, declared in found.series.items():
            address = f"{where.address}.{name}"
            given = node.entries.get(name)
            if given is None:
                sample = listed_sample(declared) if declared.listed else SAMPLE
                rule = f"needs {name} ({declared.doc.rstrip('.')}); write {name}: {sample}."
                self.faults.add(rule, where.mark, where.address)
                continue
            read = read_series(name, declared, given, self.library, self.faults, address)
            if read is not None:
                made[name] = read
        return made

    def _inner_parts(self, found: Primitive, node: MappingNode, where: Where, names: Names) -> None:
        """Expand the inner parts of a primitive, such as the path of a muscle, and connect them."""
        for name, slot in found.parts.items():
            if slot.optional and name not in node.entries:
                continue
            own = node.entries.get(name, MappingNode({}, {}, where.mark))
            wrong, mark = self._slot_fault(name, slot, own, where)
            if wrong:
                self.faults.add(wrong, mark, where.address)
                self.broken.add(f"{where.address}.{name}")
                self.ports.tried |= {f"{where.address}.{mine}" for mine, _ in slot.reads}
                continue
            assert isinstance(own, MappingNode)
            default = ScalarNode(slot.default, where.mark)
            entry = merged(MappingNode({"use": default}, {"use": where.mark}, own.mark), own)
            inner = replace(
                where,
                address=f"{where.address}.{name}",
                logical=f"{where.logical}.{name}",
                mark=node.keys.get(name, where.mark),
                given={theirs: (ScalarNode(f"={text}", where.mark), names) for theirs, text in slot.gives},
            )
            self._entry(entry, inner)
            for mine, theirs in slot.reads:
                self.ports.wire(f"{inner.address}.{theirs}", f"{where.address}.{mine}", where)
            for theirs, mine in slot.sends:
                if mine in found.outputs:
                    self.ports.wire(f"{where.address}.{mine}", f"{inner.address}.{theirs}", where)
                else:
                    self.inputs[f"{where.address}.{mine}"].append(f"{inner.address}.{theirs}")

    def _slot_fault(self, name: str, slot: InnerPart, own: Node, where: Where) -> tuple[str, Mark]:
        """The fault of the entry of an inner part, and its place; empty if the entry can be expanded."""
        if not isinstance(own, MappingNode):
            return f"{name} is a part of its own; write {self._sample(name, slot)}.", own.mark
        use = own.entries.get("use")
        if use is None:
            if slot.default:
                return "", where.mark
            return f"needs {name} ({slot.doc.rstrip('.')}); write {self._sample(name, slot)}.", where.mark
        reference = use.value if isinstance(use, ScalarNode) else None
        kind = reference.split("/")[0] if isinstance(reference, str) else slot.kind
        if kind != slot.kind and kind in self.library.kinds():
            rule = f"{name} is {with_article(slot.kind)}, and {reference} is none"
            return f"{rule}; write {self._sample(name, slot)}.", use.mark
        return "", own.mark

    def _sample(self, name: str, slot: InnerPart) -> str:
        """The entry of an inner part with a component that fits."""
        return f"{name}: {{use: {next(iter(self.library.references(slot.kind)), f'{slot.kind}/...')}, ...}}"


def _needs(name: str, declared: Parameter) -> str:
    about = f" ({declared.doc.rstrip('.')})" if declared.doc else ""
    return f"needs {name}{about}; write {name}: {example(declared.unit)}."


def _join(*words: str) -> str:
    return ".".join(word for word in words if word)


def sides(node: Node, faults: Faults | None = None, name: str = "") -> tuple[str, ...]:
    """The sides for which an entry is made; none without `sides:`."""
    given = node.entries.get("sides") if isinstance(node, MappingNode) else None
    if given is None:
        return ()
    items = given.items if isinstance(given, SequenceNode) else (given,)
    words = tuple(str(item.value) for item in items if isinstance(item, ScalarNode))
    if not words or len(set(words)) != len(items) or not set(words) <= set(_SIDES):
        if faults is not None:
            rule = f'"{", ".join(words)}" names no sides' if words else "this names no sides"
            faults.add(f"{rule}; write sides: [l, r], [l] or [r].", given.mark, name)
        return ()
    return words
