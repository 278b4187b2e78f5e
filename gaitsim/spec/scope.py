"""Scopes of names in a spec: a name is searched among siblings, then outwards within the same text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from gaitsim.errors import Faults, Mark, did_you_mean
from gaitsim.model import WORLD, Place
from gaitsim.spec.numbers import Names
from gaitsim.text.document import Node, ScalarNode

_OTHER = {"l": "r", "r": "l"}


@dataclass(frozen=True)
class Wire:
    """A connection as written. Its addresses are absolute and may be names of composites."""

    sender: str
    target: str
    delay: int | None
    initial: Node | None
    made_by: str
    mark: Mark


@dataclass
class Scope:
    """The inside of one composite, or of the spec itself."""

    address: str
    logical: str
    file: str
    names: Names
    reference: str = ""
    children: dict[str, str] = field(default_factory=dict)  # name -> address
    attachments: dict[str, str] = field(default_factory=dict)
    places: dict[str, list[Place]] = field(default_factory=dict)  # attachments that are places beside a frame
    sided: dict[str, tuple[str, ...]] = field(default_factory=dict)
    signals: dict[str, Wire] = field(default_factory=dict)  # parameters that a signal sets
    outer: Scope | None = None

    def below(self, name: str) -> str:
        """The address of something inside this scope."""
        return f"{self.address}.{name}" if self.address else name

    def passed(self, node: Node | None) -> Wire | None:
        """The signal that an entry such as `=lean` passes on; None if it is a number."""
        text = node.value if isinstance(node, ScalarNode) else None
        return self.signals.get(text[1:].strip()) if isinstance(text, str) and text[:1] == "=" else None

    @property
    def references(self) -> list[str]:
        """The composites around this scope, outermost first."""
        outer = self.outer.references if self.outer else []
        return [*outer, self.reference] if self.reference else outer


@dataclass(frozen=True)
class Where:
    """The place of one entry: its address, its address as written once for all sides, and its scope."""

    address: str
    logical: str
    scope: Scope
    mark: Mark
    side: str = ""
    measure: bool = False
    given: Mapping[str, tuple[Node, Names]] = field(default_factory=dict)  # parameters from the part around

    def chosen(self, use: Mark) -> Mark:
        """Where its component was chosen: at the entry, or where another text says `use:` instead."""
        return self.mark if use.file == self.mark.file else use


def absolute(text: str, where: Where, mark: Mark, faults: Faults) -> str | None:
    """Find the absolute address of a name.

    Args:
        text: The name as written, such as `shank.distal`.
        where: The entry that it is written in.
        mark: Its place.
        faults: Receives a fault if there is no such name.

    Returns:
        The address; None after a fault.
    """
    text = _with_side(text, where.side)
    if text == WORLD:
        return WORLD
    if text.startswith("="):
        if text[1:] in where.scope.places:
            rule = f"{text} is a place beside a frame, and this needs a frame; pass a frame instead."
            faults.add(rule, mark, where.address)
            return None
        found = where.scope.attachments.get(text[1:])
        if found is None:
            hint = did_you_mean(text[1:], where.scope.attachments)
            faults.add(f"{text} is not an attachment of this composite. {hint}", mark, where.address)
        return found or None
    if "{" in text:
        faults.add(_brace(text, where.side), mark, where.address)
        return None
    first, _, rest = text.partition(".")
    known: list[str] = []
    here: Scope | None = where.scope
    while here is not None:
        if first in here.sided:
            both = " and ".join(here.sided[first])
            faults.add(f"{first} stands for {both}; name one of them.", mark, where.address)
            return None
        if first in here.children:
            base = here.children[first]
            return f"{base}.{rest}" if rest else base
        known += here.children
        # The text of a composite has access to its siblings only; an override has the scope of its writer.
        here = here.outer if mark.file != here.file else None
    faults.add(f"there is no part {first} here. {did_you_mean(first, known)}", mark, where.address)
    return None


def _brace(text: str, side: str) -> str:
    """The fault of a name with a brace that stands for no side."""
    if side:
        return f"{text} has a brace that stands for no side; write {{side}} for this side or {{other}} for the other."
    return f"{text} stands for a side, and this part has none; write sides: [l, r] here, or name a side, such as leg_l."


def _with_side(text: str, side: str) -> str:
    """`leg_{other}.load` for one side."""
    return text.replace("{other}", _OTHER[side]).replace("{side}", side) if side else text
