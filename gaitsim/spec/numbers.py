"""The numbers of a model: values, tuned values, expressions and fractions."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from gaitsim.component import Parameter
from gaitsim.errors import Faults
from gaitsim.model import Free, Number
from gaitsim.spec.inheritance import VALUE_KEYS
from gaitsim.text.document import MappingNode, Node, ScalarNode, SequenceNode
from gaitsim.text.expression import BadExpression, parse_expression
from gaitsim.text.quantity import comma_within, example, number, quoted, written_unit
from gaitsim.text.spelling import respelled
from gaitsim.units import parse_unit, with_unit

Names = dict[str, tuple[int, str]]
SIGNAL = -1  # in place of the index of a number: the parameter is set by a signal
_FIXED = "a whole number cannot be tuned, because a search tries all that lies between; give it one value"
_SPEC = "spec"  # the source of numbers that a spec sets without one


def is_value(node: Node) -> bool:
    """Whether a node is a number: a scalar or `{value: ..., tune: ...}`."""
    return isinstance(node, ScalarNode) or (
        isinstance(node, MappingNode) and bool(node.entries) and set(node.entries) <= VALUE_KEYS
    )


@dataclass
class NumberTable:
    """Numbers in the order in which they are computed, and the tuned ones among them."""

    faults: Faults
    numbers: list[Number] = field(default_factory=list)
    index: dict[str, int] = field(default_factory=dict)
    _free: dict[tuple[str, int], Free] = field(default_factory=dict)
    _computed: dict[int, tuple[Parameter, Node]] = field(default_factory=dict)  # expressions, by index

    def add(
        self,
        address: str,
        logical: str,
        node: Node | None,
        declared: Parameter,
        names: Names,
        fraction_of: int | None = None,
        default: bool = False,
    ) -> int:
        """Add a number.

        Args:
            address: Its address.
            logical: Its address as written once for all sides.
            node: The node that sets it, if any.
            declared: Its declaration.
            names: The parameters that an expression may name.
            fraction_of: The number of which it is a share, if any.
            default: Whether the node belongs to the declaration, whose source then applies.

        Returns:
            The index of the number.
        """
        made = self._number(address, logical, node, _closed(declared, node), names, fraction_of)
        if default and made.source in ("", _SPEC):
            made = replace(made, source=declared.source or _SPEC)
        if fraction_of is not None:
            made = replace(made, unit=self.numbers[fraction_of].unit)
        self.index[address] = len(self.numbers)
        self.numbers.append(made)
        return self.index[address]

    def check_computed(self) -> None:
        """Check that every expression has a value at the start, within its bounds, and that whole numbers are fixed."""
        values: list[float] = []
        for i, each in enumerate(self.numbers):
            values.append(each.value)
            if each.expression is None:
                continue
            declared, node = self._computed[i]
            if declared.whole and self._tunes(i):
                self.faults.add(f"{quoted(node)} depends on a tuned value, and {_FIXED}.", node.mark, each.address)
                return
            try:
                values[i] = each.expression.value(values)
                if not math.isfinite(values[i]):
                    raise ArithmeticError("it is not finite")
            except (ArithmeticError, ValueError) as error:
                reason = "it divides by zero" if isinstance(error, ZeroDivisionError) else error
                rule = f"{each.expression.text} has no value here ({reason}); correct it, or the numbers in it."
                self.faults.add(rule, node.mark, each.address)
                return
            self._allowed(values[i], declared, node, each.address)

    def free(self) -> tuple[Free, ...]:
        """The tuned numbers, in the order of the spec."""
        return tuple(self._free.values())

    def _tunes(self, index: int) -> bool:
        """Whether a search changes a number."""
        each = self.numbers[index]
        read = [other for _, other in each.expression.names] if each.expression else []
        return each.free is not None or any(self._tunes(other) for other in read if other != SIGNAL)

    def _number(
        self,
        address: str,
        logical: str,
        node: Node | None,
        declared: Parameter,
        names: Names,
        fraction_of: int | None,
    ) -> Number:
        unit = parse_unit(declared.unit)
        if node is None:
            return Number(address, unit, _default(declared), source=declared.source)
        text = node.value if isinstance(node, ScalarNode) else None
        if isinstance(text, str) and text.startswith("="):
            try:
                expression = parse_expression(text[1:], declared.unit, names)
            except BadExpression as error:
                self.faults.add(str(error), node.mark, address)
                return Number(address, unit, mark=node.mark)
            driven = next((name for name, index in expression.names if index == SIGNAL), "")
            if driven:
                rule = (
                    f"{text} needs a number, and {driven} is set by a signal; only ={driven} alone passes a signal on"
                )
                self.faults.add(f"{rule}. Give {driven} a number, or send a signal here too.", node.mark, address)
                return Number(address, unit, mark=node.mark)
            self._computed[len(self.numbers)] = (declared, node)
            return Number(address, unit, expression=expression, mark=node.mark)
        if isinstance(node, MappingNode):
            return self._mapping(address, logical, node, declared, names, fraction_of)
        value = number(node, declared.unit, self.faults, address)
        if value is None:
            return Number(address, unit, mark=node.mark)
        self._allowed(value, declared, node, address)
        return Number(address, unit, value, fraction_of=fraction_of, source=_SPEC, mark=node.mark)

    def _mapping(
        self,
        address: str,
        logical: str,
        node: MappingNode,
        declared: Parameter,
        names: Names,
        fraction_of: int | None,
    ) -> Number:
        shared = node  # one tune written for both sides is one number
        node = respelled(node, sorted(VALUE_KEYS), "a value has no key", self.faults, address)
        source = node.entries.get("source")
        value_node = node.entries.get("value")
        # The source in a declaration belongs to its default only.
        unsaid = declared.source if value_node is None else _SPEC
        origin = str(source.value) if isinstance(source, ScalarNode) else unsaid
        value: float | None = None
        if value_node is not None:
            if "tune" not in node.entries:
                made = self._number(address, logical, value_node, declared, names, fraction_of)
                return replace(made, source=origin)
            value = number(value_node, declared.unit, self.faults, address)
            if value is not None:
                self._allowed(value, declared, value_node, address)
        elif declared.default is not None:
            value = _default(declared)
        if "tune" not in node.entries:
            rule = f"has no value; write value: {example(declared.unit)}, or tune: with a lower and a higher one."
            self.faults.add(rule, node.mark, address)
            return Number(address, parse_unit(declared.unit), mark=node.mark)
        return self._tuned(address, (logical, id(shared)), node, declared, value, origin, fraction_of)

    def _tuned(
        self,
        address: str,
        key: tuple[str, int],
        node: MappingNode,
        declared: Parameter,
        value: float | None,
        source: str,
        fraction_of: int | None,
    ) -> Number:
        unit, bounds = parse_unit(declared.unit), self._bounds(node.entries["tune"], declared, address)
        if declared.whole:
            self.faults.add(f"{_FIXED}.", node.mark, address)
        if bounds is None or declared.whole:
            return Number(address, unit, mark=node.mark)
        low, high = bounds
        start = (low + high) / 2 if value is None else value
        if not low <= start <= high:
            written = node.entries.get("value")
            shown = quoted(written) if written else f"by default {unit.of(start):g}"
            rule = f"the start, {shown}, is outside {unit.span(low, high)}"
            self.faults.add(f"{rule}; move it, or widen tune.", (written or node).mark, address)
        spread_node = node.entries.get("spread")
        spread = (high - low) / 4
        if spread_node is not None:
            given = number(spread_node, declared.unit, self.faults, address)
            if given is not None and given <= 0:
                rule = f"a spread is above 0, and this is {quoted(spread_node)}; write such as a quarter of the range."
                self.faults.add(rule, spread_node.mark, address)
            spread = given or spread
        known = self._free.get(key)
        drives = (*known.drives, address) if known else (address,)
        name = key[0] if known else address
        self._free[key] = Free(name, unit, low, high, start, spread, source, drives, node.mark)
        which = list(self._free).index(key)
        return Number(address, unit, start, which, fraction_of=fraction_of, source=source, mark=node.mark)

    def _bounds(self, node: Node, declared: Parameter, address: str) -> tuple[float, float] | None:
        if not isinstance(node, SequenceNode) or len(node.items) != 2:
            pair = ", ".join(with_unit(str(bound), declared.unit) for bound in (1, 5))
            hint = comma_within(node) if isinstance(node, SequenceNode) else ""
            self.faults.add(f"tune needs two bounds; write such as tune: [{pair}].{hint}", node.mark, address)
            return None
        low, high = (number(item, declared.unit, self.faults, address) for item in node.items)
        if low is None or high is None:
            return None
        for bound, item in ((low, node.items[0]), (high, node.items[1])):
            self._allowed(bound, declared, item, address)
        if low >= high:
            word, move = ("reversed", "exchange them") if low > high else ("equal", "write a lower and a higher one")
            rule = f"the bounds {quoted(node.items[0])} and {quoted(node.items[1])} are {word}; {move}."
            self.faults.add(rule, node.mark, address)
            return None
        return low, high

    def _allowed(self, value: float, declared: Parameter, node: Node, address: str) -> None:
        """Check that a value lies within its bounds, and that it is whole if it has to be."""
        unit = parse_unit(declared.unit)
        low, high = declared.bounds or (-math.inf, math.inf)
        given = unit.of(value)
        outside = not low - 1e-12 * abs(low) <= given <= high + 1e-12 * abs(high)
        if not outside and not (declared.whole and given % 1):
            return
        shown = unit.shown(value)
        value_text = quoted(node) if isinstance(node, ScalarNode) else f'"{shown}"'
        if value_text != f'"{shown}"':
            value_text += f" is {shown}, which"
        if outside:
            rule = f"{value_text} is outside {unit.span(unit.to_si(low), unit.to_si(high))}; choose a value between."
        else:
            nearer = max(low, min(high, round(given)))
            rule = f"{value_text} is not a whole number; write such as {unit.shown(unit.to_si(nearer))}."
        self.faults.add(rule, node.mark, address)


def _default(declared: Parameter) -> float:
    """The declared default in SI; nan if there is none."""
    return math.nan if declared.default is None else parse_unit(declared.unit).to_si(declared.default)


def _closed(declared: Parameter, node: Node | None) -> Parameter:
    """The declaration; an open unit is replaced by the unit in which the spec sets the number."""
    while isinstance(node, MappingNode):
        node = node.entries.get("tune", node.entries.get("value"))
    unit = written_unit(node)
    if declared.unit != "*" or unit is None:
        return declared
    default = None if declared.default is None else unit.of(declared.default)
    bounds = None if declared.bounds is None else (unit.of(declared.bounds[0]), unit.of(declared.bounds[1]))
    return replace(declared, unit=unit.text, default=default, bounds=bounds)
