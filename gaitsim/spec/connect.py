"""From wires as written to connections between ports of primitives; every input accounted for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from gaitsim.component import Parameter
from gaitsim.errors import Mark, did_you_mean
from gaitsim.model import WORLD, Connection, Part, Place
from gaitsim.spec.expand import Expansion
from gaitsim.spec.ports import Wire
from gaitsim.units import parse_unit


@dataclass
class Wiring:
    """Follows names through the masks of composites."""

    expansion: Expansion
    _constants: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.faults = self.expansion.faults
        self.parts = {part.address: part for part in self.expansion.parts}
        self._read_constants()

    def connections(self) -> tuple[Connection, ...]:
        """Every connection, each between two primitives."""
        made: list[Connection] = []
        for wire in self.expansion.wires:
            source = self._output(wire)
            for target in self._inputs(wire.target, wire.mark, wire.source):
                if source and self._units_fit(source, target, wire.mark):
                    made.append(self._connection(source, target, wire))
        self._check_inputs(made)
        return tuple(made)

    def completed(self, part: Part) -> Part:
        """The part with its constants, and its attachments and points followed to primitives."""
        ports = {name: f"{part.address}.{name}" for name in part.type.inputs}
        constants = {name: self._constants[port] for name, port in ports.items() if port in self._constants}
        attachments = {
            name: self._frame(text, part.mark, f"{part.address}.{name}") for name, text in part.attachments.items()
        }
        points = {
            name: [Place(self._body_or_frame(p.frame, part.mark, part.address), p.at) for p in places]
            for name, places in part.points.items()
        }
        return replace(part, constants=constants, attachments=attachments, points=points)

    def initial(self, text: str, mark: Mark) -> tuple[str, str] | None:
        """The output or state that an initial value is for, and its unit; None after a fault."""
        address = self._follow(text, self.expansion.outputs)
        owner, _, name = address.rpartition(".")
        part = self.parts.get(owner)
        declared = part and (part.type.outputs.get(name) or part.type.states.get(name))
        if declared:
            return address, declared.unit
        if self._broken(text):
            return None
        known = [*self.expansion.outputs, *(f"{a}.{s}" for a, p in self.parts.items() for s in p.type.states)]
        self.faults.add(f"{text} is no coordinate and no state. {did_you_mean(text, known)}", mark, "initial")
        return None

    def _follow(self, name: str, aliases: Mapping[str, str]) -> str:
        """Through the masks: leg.load -> leg.foot.load -> leg.foot.contact.force."""
        seen = {name}
        while aliases.get(name, name) not in seen:
            name = aliases[name]
            seen.add(name)
        return name

    def _broken(self, name: str) -> bool:
        """Whether a name lies in a part that could not be loaded; that has been said already."""
        return any(name == part or name.startswith(f"{part}.") for part in self.expansion.broken)

    def _output(self, wire: Wire) -> str | None:
        name = self._follow(wire.source, self.expansion.outputs)
        owner, _, port = name.rpartition(".")
        if owner in self.parts and port in self.parts[owner].type.outputs:
            return name
        if not self._broken(wire.source):
            hint = did_you_mean(wire.source, self.expansion.outputs)
            self.faults.add(f"there is no output {wire.source}. {hint}", wire.mark, wire.target)
        return None

    def _inputs(self, name: str, mark: Mark, address: str) -> list[str]:
        """The inputs of primitives that a name stands for."""
        targets = self.expansion.inputs.get(name)
        if targets is None and self._broken(name):
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

    def _units_fit(self, source: str, target: str, mark: Mark) -> bool:
        given, asked = self._unit(source, "outputs"), self._unit(target, "inputs")
        if "*" in (given, asked) or parse_unit(given).dimension == parse_unit(asked).dimension:
            return True
        words = f"{source} is {parse_unit(given).article} [{given}]"
        rule = f"{target} takes {parse_unit(asked).article} [{asked}]; connect another output."
        self.faults.add(f"{words} but {rule}", mark, target)
        return False

    def _unit(self, port: str, ports: str) -> str:
        owner, _, name = port.rpartition(".")
        unit: str = getattr(self.parts[owner].type, ports)[name].unit
        return unit

    def _connection(self, source: str, target: str, wire: Wire) -> Connection:
        initial = None
        if wire.initial is not None:
            asked = Parameter(self._unit(source, "outputs"), "the signal before the start")
            initial = self.expansion.table.add(f"{target}.initial", f"{target}.initial", wire.initial, asked, {})
        return Connection(source, target, wire.delay, initial, wire.made_by, wire.mark)

    def _check_inputs(self, made: list[Connection]) -> None:
        """A single-valued input has one sender; one without default has at least one."""
        senders: dict[str, list[Connection]] = {}
        for connection in made:
            senders.setdefault(connection.target, []).append(connection)
        tried = {target for wire in self.expansion.wires for target in self._quiet_inputs(wire.target)}
        for part in self.parts.values():
            for name, declared in part.type.inputs.items():
                port = f"{part.address}.{name}"
                mine = senders.get(port, [])
                given = len(mine) + (port in self._constants)
                if declared.sums:
                    continue
                if given > 1:
                    names = " and ".join(c.source for c in mine) or "a number"
                    names += " and a number" if port in self._constants and mine else ""
                    rule = f"takes one sender and has {given}: {names}; remove one, or add them in a part."
                    self.faults.add(rule, mine[-1].mark if mine else part.mark, port)
                elif not given and declared.default is None and port not in tried:
                    rule = f"is connected to nothing; write {name}: {{from: ...}}, {parse_unit(declared.unit).article}."
                    self.faults.add(rule, part.mark, port)

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

    def _frame(self, text: str, mark: Mark, address: str) -> str:
        name = self._follow(text, self.expansion.frames)
        if name == WORLD or name in self.expansion.frames or self._broken(name):
            return name
        hint = did_you_mean(text, self.expansion.frames)
        self.faults.add(f"there is no frame {text}. {hint}", mark, address)
        return WORLD

    def _body_or_frame(self, text: str, mark: Mark, address: str) -> str:
        """A frame, or the body of a part: of a composite's first frame."""
        part = self.parts.get(text)
        if part is not None and part.type.frames:
            return text
        inside = [name for name in self.expansion.frames if name.startswith(f"{text}.")]
        if text not in self.expansion.frames and inside:
            return self._follow(inside[0], self.expansion.frames).rpartition(".")[0]
        return self._frame(text, mark, address)
