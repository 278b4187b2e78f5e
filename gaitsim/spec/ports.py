"""The ports in an entry of a spec: constants, connections, attachments and options."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from gaitsim.component import Input, Link, Option, Parameter
from gaitsim.errors import Faults, Mark, did_you_mean
from gaitsim.spec.numbers import Names, NumberTable, is_value
from gaitsim.spec.scope import Where, Wire, absolute
from gaitsim.text.document import MappingNode, Node, ScalarNode, SequenceNode
from gaitsim.text.quantity import quoted
from gaitsim.text.spelling import respelled

_DELAY = Parameter("s", "a delay", bounds=(0, 3600))
_FIELDS = ("from", "delay", "initial")


def is_connection(node: Node | None) -> bool:
    """Whether a node is a connection, such as `{from: soleus.force}`."""
    return isinstance(node, MappingNode) and "from" in node.entries


@dataclass(frozen=True)
class Constant:
    """A number for an input. Its unit is that of the primitive's input."""

    target: str
    logical: str
    node: Node
    names: Names


@dataclass
class PortReader:
    """Reads the ports of entries."""

    table: NumberTable
    faults: Faults
    wires: list[Wire] = field(default_factory=list)
    constants: list[Constant] = field(default_factory=list)
    tried: set[str] = field(default_factory=set)  # inputs that an entry mentions
    marks: dict[str, Mark] = field(default_factory=dict)  # where attachments are written

    def wire(self, sender: str, target: str, where: Where) -> None:
        """Add a connection that a part makes with its own inner part."""
        self.wires.append(Wire(sender, target, None, None, where.address, where.mark))

    def input(self, name: str, declared: Input, node: MappingNode, where: Where) -> None:
        """Read an input: a connection or a constant."""
        given, port = node.entries.get(name), f"{where.address}.{name}"
        if given is None:
            return
        self.tried.add(port)
        passed = where.scope.passed(given)
        if passed is not None:
            self.wires.append(replace(passed, target=port))
            return
        if isinstance(given, MappingNode) and not is_value(given):
            if declared.sums:
                written = given.entries.get("from")
                sender = f" of {written.value}" if isinstance(written, ScalarNode) else ""
                rule = f"this input sums its senders; write to: {port} at the part{sender} instead."
                self.faults.add(rule, given.mark, port)
            else:
                wire = self.connection(given, port, f"{where.logical}.{name}", where)
                self.wires += [wire] if wire else []
            return
        text = given.value if isinstance(given, ScalarNode) else None
        if isinstance(text, str) and text[:1] not in "=+-.0123456789":
            rule = f'"{text}" is not a number; to connect this input, write {name}: {{from: {text}}}.'
            self.faults.add(rule, given.mark, port)
            return
        self.constants.append(Constant(port, f"{where.logical}.{name}", given, where.scope.names))

    def connection(self, given: MappingNode, port: str, logical: str, where: Where) -> Wire | None:
        """Read `{from: part.output, delay: 15 ms, initial: 0}`; None after a fault."""
        given = respelled(given, _FIELDS, "a connection has no key", self.faults, port)
        written = given.entries.get("from")
        if written is None:
            self.faults.add("this connection has no sender; write such as {from: soleus.force}.", given.mark, port)
            return None
        text = self._text(written, "from: names an output; write such as {from: soleus.force}.", where)
        sender = absolute(text, where, written.mark, self.faults) if text else None
        if not sender:
            return None
        delay = self._delay(given, port, logical, where)
        return Wire(sender, port, delay, given.entries.get("initial"), "", written.mark)

    def link(self, name: str, declared: Link, node: MappingNode, where: Where) -> None:
        """Add the connections that a link makes with the part that it names."""
        given = node.entries.get(name)
        if given is None:
            return
        text = self._text(given, f"{name} names a part; write such as {name}: ankle.", where)
        other = absolute(text, where, given.mark, self.faults) if text else None
        self.tried |= {f"{where.address}.{own}" for own, _ in declared.reads}
        if other is None:
            return
        reads = [(f"{other}.{theirs}", f"{where.address}.{own}") for own, theirs in declared.reads]
        sends = [(f"{where.address}.{own}", f"{other}.{theirs}") for theirs, own in declared.sends]
        self.wires += [Wire(sender, target, None, None, where.address, given.mark) for sender, target in reads + sends]

    def to(self, node: MappingNode, outputs: list[str], where: Where) -> None:
        """Read `to: port`, `to: [ports]`, or `to: {output: port(s)}`, which send outputs to summing inputs."""
        given = node.entries.get("to")
        if given is None:
            return
        if isinstance(given, MappingNode) and "port" not in given.entries:
            for name, target in given.entries.items():
                if name in outputs:
                    self._send(name, target, where)
                else:
                    hint = did_you_mean(name, outputs)
                    self.faults.add(f"{name} is not an output of this part. {hint}", given.keys[name], where.address)
        elif len(outputs) == 1:
            self._send(outputs[0], given, where)
        else:
            names = ", ".join(outputs) or "none"
            rule = f"to: needs the name of an output (here: {names}); write to: {{output: part.port}}."
            self.faults.add(rule, given.mark, where.address)

    def attachments(self, names: Iterable[str], node: MappingNode, where: Where) -> dict[str, str]:
        """The frames to which an entry is fastened."""
        found = {}
        for name in names:
            given = node.entries.get(name)
            if given is None:
                rule = f"has no {name}; write {name}: part.frame, or {name}: world."
                self.faults.add(rule, where.mark, where.address)
                continue
            text = self._text(given, f"{name} names a frame; write such as {name}: thigh.distal.", where)
            frame = absolute(text, where, given.mark, self.faults) if text else None
            if frame:
                found[name] = frame
                # What a composite hands on was written where the composite is used.
                handed = f"{where.scope.address}.{text[1:]}" if text[:1] == "=" else ""
                self.marks[f"{where.address}.{name}"] = self.marks.get(handed, given.mark)
        return found

    def option(self, name: str, declared: Option, node: MappingNode, where: Where) -> str:
        """The word that is chosen for an option."""
        given = node.entries.get(name)
        value = given.value if isinstance(given, ScalarNode) else declared.default
        if value in declared.choices and (given is None or isinstance(given, ScalarNode)):
            return str(value)
        choices = ", ".join(declared.choices)
        rule = "is not said" if given is None else f"cannot be {quoted(given)}"
        mark = given.mark if given else where.mark
        self.faults.add(f"{name} {rule}; choose one of {choices}.", mark, where.address)
        return declared.choices[0]

    def _send(self, output: str, node: Node, where: Where) -> None:
        if isinstance(node, SequenceNode):
            for item in node.items:
                self._send(output, item, where)
            return
        sender, delay = f"{where.address}.{output}", None
        target: Node = node
        if isinstance(node, MappingNode):
            node = respelled(node, ("port", "delay"), "a connection here has no key", self.faults, sender)
            target = node.entries.get("port", node)
        text = self._text(target, "to: names a summing input; write such as to: soleus.excitation.", where)
        found = absolute(text, where, target.mark, self.faults) if text else None
        if found is None:
            return
        if isinstance(node, MappingNode):
            delay = self._delay(node, f"{sender}.to.{found}", f"{where.logical}.{output}.to.{text}", where)
        self.wires.append(Wire(sender, found, delay, None, "", target.mark))

    def _delay(self, node: MappingNode, address: str, logical: str, where: Where) -> int | None:
        delay = node.entries.get("delay")
        if delay is None:
            return None
        return self.table.add(f"{address}.delay", f"{logical}.delay", delay, _DELAY, where.scope.names)

    def _text(self, node: Node, rule: str, where: Where) -> str:
        if isinstance(node, ScalarNode) and isinstance(node.value, str):
            return node.value
        self.faults.add(rule, node.mark, where.address)
        return ""
