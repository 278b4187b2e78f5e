"""Connections between ports of primitives, made from connections as written; every input is checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from gaitsim.component import Parameter
from gaitsim.errors import Mark, did_you_mean
from gaitsim.model import WORLD, Connection, Part, Place, port_unit
from gaitsim.spec.expand import Expansion
from gaitsim.spec.scope import Wire
from gaitsim.text.quantity import measured
from gaitsim.units import parse_unit


@dataclass
class Wiring:
    """Follows port names through composites to ports of primitives."""

    expansion: Expansion
    _constants: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.faults = self.expansion.faults
        self.parts = {part.address: part for part in self.expansion.parts}
        self._read_constants()

    def connections(self) -> tuple[Connection, ...]:
        """All connections, each from a primitive to a primitive."""
        made: list[Connection] = []
        for wire in self.expansion.wires:
            sender = self._output(wire)
            for target in self._inputs(wire.target, wire.mark, wire.sender):
                if sender and self._units_fit(sender, target, wire.mark):
                    made.append(self._connection(sender, target, wire))
        self._check_inputs(made)
        return tuple(made)

    def completed(self, part: Part) -> Part:
        """The part with its constants, and with its attachments and points on primitives."""
        ports = {name: f"{part.address}.{name}" for name in part.type.inputs}
        constants = {name: self._constants[port] for name, port in ports.items() if port in self._constants}
        attachments = {
            name: self._frame(text, f"{part.address}.{name}", part.mark) for name, text in part.attachments.items()
        }
        points, places = self._followed(part.points), self._followed(part.places)
        # A place that could not be read was reported already.
        attachments |= {name: each[0].frame if each else WORLD for name, each in places.items()}
        return replace(part, constants=constants, attachments=attachments, points=points, places=places)

    def initial(self, text: str, mark: Mark) -> tuple[str, str] | None:
        """Find the output or state that an initial value belongs to.

        Args:
            text: The address as written.
            mark: Its place.

        Returns:
            The address and the unit; None after a fault.
        """
        address = self._follow(text, self.expansion.outputs)
        owner, _, name = address.rpartition(".")
        part = self.parts.get(owner)
        declared = part and (part.type.outputs.get(name) or part.type.states.get(name))
        if declared:
            return address, declared.unit
        if self.expansion.is_broken(text):
            return None
        mechanical = {a: p.type.outputs for a, p in self.parts.items() if "build" in p.type.functions}
        known = [f"{a}.{name}" for a, outputs in mechanical.items() for name in outputs]
        known += [f"{a}.{name}" for a, p in self.parts.items() for name in p.type.states]
        self.faults.add(f"{text} is neither a coordinate nor a state. {did_you_mean(text, known)}", mark, "initial")
        return None

    def _followed(self, points: Mapping[str, Sequence[Place]]) -> dict[str, list[Place]]:
        """Points by name, each on the frame or the body of a primitive."""
        return {
            name: [Place(self._body_or_frame(place.frame), place.at) for place in places]
            for name, places in points.items()
        }

    def _follow(self, name: str, aliases: Mapping[str, str]) -> str:
        """Follow a name through composites: leg.load -> leg.foot.load -> leg.foot.contact.force."""
        seen = {name}
        while aliases.get(name, name) not in seen:
            name = aliases[name]
            seen.add(name)
        return name

    def _output(self, wire: Wire) -> str | None:
        name = self._follow(wire.sender, self.expansion.outputs)
        owner, _, port = name.rpartition(".")
        if owner in self.parts and port in self.parts[owner].type.outputs:
            return name
        if not self.expansion.is_broken(wire.sender):
            hint = did_you_mean(wire.sender, self.expansion.outputs)
            self.faults.add(f"there is no output {wire.sender}. {hint}", wire.mark, wire.target)
        return None

    def _inputs(self, name: str, mark: Mark, address: str) -> list[str]:
        """The inputs of primitives that a name stands for."""
        targets = self.expansion.inputs.get(name)
        if targets is None and self.expansion.is_broken(name):
            return []
        if targets is None:
            hint = did_you_mean(name, self.expansion.inputs)
            self.faults.add(f"there is no input {name}. {hint}", mark, address)
            return []
        found = [name] if name in targets else []
        for target in targets:
            if target != name:
                found += self._inputs(target, mark, address)
        return found

    def _units_fit(self, sender: str, target: str, mark: Mark) -> bool:
        given, asked = self._unit(sender, "outputs"), self._unit(target, "inputs")
        if "*" in (given, asked) or parse_unit(given).dimension == parse_unit(asked).dimension:
            return True
        sent = f"{sender} is {measured(parse_unit(given))} [{given}]"
        rule = f"{target} takes {measured(parse_unit(asked))} [{asked}]; connect another output."
        self.faults.add(f"{sent} but {rule}", mark, target)
        return False

    def _unit(self, port: str, ports: str) -> str:
        owner, _, name = port.rpartition(".")
        part = self.parts[owner]
        return port_unit(part, getattr(part.type, ports)[name], self.expansion.table.numbers)

    def _connection(self, sender: str, target: str, wire: Wire) -> Connection:
        initial = None
        if wire.initial is not None:
            asked = Parameter(self._unit(sender, "outputs"), "the signal before the start")
            initial = self.expansion.table.add(f"{target}.initial", f"{target}.initial", wire.initial, asked, {})
        return Connection(sender, target, wire.delay, initial, wire.made_by, wire.mark)

    def _check_inputs(self, made: list[Connection]) -> None:
        """Check that an input has at most one sender unless it sums, and at least one unless it has a default."""
        senders: dict[str, list[Connection]] = {}
        for connection in made:
            senders.setdefault(connection.target, []).append(connection)
        named = {wire.target for wire in self.expansion.wires} | self.expansion.ports.tried
        tried = {target for name in named for target in self._quiet_inputs(name)}
        told: set[str] = set()
        for part in self.parts.values():
            for name, declared in part.type.inputs.items():
                port = f"{part.address}.{name}"
                mine = senders.get(port, [])
                given = len(mine) + (port in self._constants)
                if declared.sums:
                    continue
                if given > 1:
                    names = " and ".join(self._written(c) for c in mine)
                    names += " and a number" if port in self._constants else ""
                    rule = f"takes one sender and has {given}: {names}; remove one, or add them in a part of their own."
                    self.faults.add(rule, mine[-1].mark, port)
                elif not given and declared.default is None and port not in tried:
                    shown, mark = self._open_input(port, part)
                    if shown in told:
                        continue
                    told.add(shown)
                    rule = f"is connected to nothing; write {shown.rpartition('.')[2]}: {{from: part.output}}"
                    self.faults.add(f"{rule} with {measured(parse_unit(declared.unit))}.", mark, shown)

    def _open_input(self, port: str, part: Part) -> tuple[str, Mark]:
        """The input that a spec has to connect, and the place of its part: that of the outermost composite which has
        the input of a part as its own.
        """
        for group in self.expansion.groups:
            for name in (name for name in self.expansion.inputs if name.rpartition(".")[0] == group.address):
                if port in self._quiet_inputs(name):
                    return name, group.mark
        return port, part.mark

    def _written(self, connection: Connection) -> str:
        line = f" (line {connection.mark.line})" if connection.mark and connection.mark.line else ""
        return f"{connection.sender}{line}"

    def _quiet_inputs(self, name: str) -> set[str]:
        targets = self.expansion.inputs.get(name, [])
        return {name} | {t for target in targets if target != name for t in self._quiet_inputs(target)}

    def _read_constants(self) -> None:
        table = self.expansion.table
        for constant in self.expansion.ports.constants:
            for target in self._inputs(constant.target, constant.node.mark, constant.target):
                owner, _, name = target.rpartition(".")
                declared = self.parts[owner].type.inputs[name]
                asked = Parameter(declared.unit, declared.doc)
                self._constants[target] = table.add(target, constant.logical, constant.node, asked, constant.names)

    def _frame(self, text: str, address: str, mark: Mark) -> str:
        name = self._follow(text, self.expansion.frames)
        broken = self.expansion.is_broken(name) or self.expansion.is_broken(text)
        if name == WORLD or name in self.expansion.frames or broken:
            return name
        hint = did_you_mean(text, self.expansion.frames)
        self.faults.add(f"there is no frame {text}. {hint}", self.expansion.ports.marks.get(address, mark), address)
        return WORLD

    def _body_or_frame(self, text: str) -> str:
        """The frame of a name, or the body of a part; for a composite, the body of its first frame."""
        part = self.parts.get(text)
        if part is not None and part.type.frames:
            return text
        inside = [name for name in self.expansion.frames if name.startswith(f"{text}.")]
        if text not in self.expansion.frames and inside:
            return self._follow(inside[0], self.expansion.frames).rpartition(".")[0]
        return self._follow(text, self.expansion.frames)
