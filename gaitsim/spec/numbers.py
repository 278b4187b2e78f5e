"""The table of a model's numbers: values, tuned values, expressions and fractions."""

from __future__ import annotations

from dataclasses import dataclass, field

from gaitsim.component import Parameter
from gaitsim.errors import Faults, did_you_mean
from gaitsim.model import Free, Number
from gaitsim.spec.document import Mapping, Node, Scalar, Sequence
from gaitsim.spec.expression import BadExpression, parse_expression
from gaitsim.spec.inheritance import VALUE_KEYS
from gaitsim.spec.quantity import number
from gaitsim.units import parse_unit

Names = dict[str, tuple[int, str]]


def is_value(node: Node) -> bool:
    """Whether a node says a number: a scalar or `{value: ..., tune: ...}`."""
    return isinstance(node, Scalar) or (
        isinstance(node, Mapping) and bool(node.entries) and set(node.entries) <= VALUE_KEYS
    )


@dataclass
class NumberTable:
    """Numbers in the order of their evaluation, and the free ones among them."""

    faults: Faults
    numbers: list[Number] = field(default_factory=list)
    index: dict[str, int] = field(default_factory=dict)
    _free: dict[tuple[str, int], Free] = field(default_factory=dict)

    def add(
        self,
        address: str,
        logical: str,
        node: Node | None,
        declared: Parameter,
        names: Names,
        fraction_of: int | None = None,
    ) -> int:
        """Add one number; `logical` is its address as written once for all sides."""
        made = self._number(address, logical, node, declared, names, fraction_of)
        self.index[address] = len(self.numbers)
        self.numbers.append(made)
        return self.index[address]

    def free(self) -> tuple[Free, ...]:
        """The tuned numbers, in the order of the spec."""
        return tuple(self._free.values())

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
            return self._default(address, declared)
        text = node.value if isinstance(node, Scalar) else None
        if isinstance(text, str) and text.startswith("="):
            try:
                expression = parse_expression(text[1:], declared.unit, names)
            except BadExpression as error:
                self.faults.add(f"{error}.", node.mark, address)
                return Number(address, declared.unit, mark=node.mark)
            return Number(address, declared.unit, expression=expression, mark=node.mark)
        if isinstance(node, Mapping):
            return self._mapping(address, logical, node, declared, names, fraction_of)
        value = number(node, declared.unit, self.faults, address)
        if value is None:
            return Number(address, declared.unit, mark=node.mark)
        self._within(value, declared, node, address)
        return Number(address, unit.text, value, fraction_of=fraction_of, source="spec", mark=node.mark)

    def _default(self, address: str, declared: Parameter) -> Number:
        factor = parse_unit(declared.unit).factor
        value = declared.default * factor if declared.default is not None else float("nan")
        return Number(address, declared.unit, value, source=declared.source)

    def _mapping(
        self,
        address: str,
        logical: str,
        node: Mapping,
        declared: Parameter,
        names: Names,
        fraction_of: int | None,
    ) -> Number:
        for word, mark in node.keys.items():
            if word not in VALUE_KEYS:
                self.faults.add(f"{word} is no field of a value. {did_you_mean(word, VALUE_KEYS)}", mark, address)
        source = node.entries.get("source")
        said = str(source.value) if isinstance(source, Scalar) else declared.source
        value_node = node.entries.get("value")
        value: float | None = None
        if value_node is not None:
            if "tune" not in node.entries:
                made = self._number(address, logical, value_node, declared, names, fraction_of)
                return Number(**{**made.__dict__, "source": said})
            value = number(value_node, declared.unit, self.faults, address)
            if value is not None:
                self._within(value, declared, value_node, address)
        elif declared.default is not None:
            value = declared.default * parse_unit(declared.unit).factor
        if "tune" not in node.entries:
            self.faults.add("says no value; write value: or tune: [low, high]", node.mark, address)
            return Number(address, declared.unit, mark=node.mark)
        return self._tuned(address, logical, node, declared, value, said, fraction_of)

    def _tuned(
        self,
        address: str,
        logical: str,
        node: Mapping,
        declared: Parameter,
        value: float | None,
        source: str,
        fraction_of: int | None,
    ) -> Number:
        bounds = self._bounds(node.entries["tune"], declared, address)
        if bounds is None:
            return Number(address, declared.unit, mark=node.mark)
        low, high = bounds
        start = (low + high) / 2 if value is None else value
        if not low <= start <= high:
            unit = parse_unit(declared.unit)
            shown = f"{start / unit.factor:g} is outside [{low / unit.factor:g}, {high / unit.factor:g}] {unit.text}"
            self.faults.add(f"the start {shown}; move it or widen tune", node.mark, address)
        spread_node = node.entries.get("spread")
        spread = (high - low) / 4
        if spread_node is not None:
            given = number(spread_node, declared.unit, self.faults, address)
            if given is not None and given <= 0:
                self.faults.add("the spread must be positive", spread_node.mark, address)
            spread = given or spread
        key = (logical, id(node))
        known = self._free.get(key)
        drives = (*known.drives, address) if known else (address,)
        name = logical if known else address
        self._free[key] = Free(name, declared.unit, low, high, start, spread, source, drives, node.mark)
        which = list(self._free).index(key)
        return Number(address, declared.unit, start, which, fraction_of=fraction_of, source=source, mark=node.mark)

    def _bounds(self, node: Node, declared: Parameter, address: str) -> tuple[float, float] | None:
        if not isinstance(node, Sequence) or len(node.items) != 2:
            self.faults.add("tune is two bounds, such as tune: [0, 5]", node.mark, address)
            return None
        low, high = (number(item, declared.unit, self.faults, address) for item in node.items)
        if low is None or high is None:
            return None
        for bound, item in ((low, node.items[0]), (high, node.items[1])):
            self._within(bound, declared, item, address)
        if low >= high:
            word = "equal" if low == high else "reversed"
            self.faults.add(f"the bounds are {word}; write the lower one first, then a higher one", node.mark, address)
            return None
        return low, high

    def _within(self, value: float, declared: Parameter, node: Node, address: str) -> None:
        if declared.bounds is None:
            return
        unit = parse_unit(declared.unit)
        low, high = declared.bounds
        given = value / unit.factor
        if not low - 1e-12 * abs(low) <= given <= high + 1e-12 * abs(high):
            self.faults.add(
                f"{given:g} {_suffix(unit.text)}is outside the bounds of {declared.doc.rstrip('.').lower() or 'this'}:"
                f" {low:g} to {high:g}{' ' + unit.text if unit.text != '1' else ''}; choose a value between",
                node.mark,
                address,
            )


def _suffix(unit: str) -> str:
    return "" if unit == "1" else f"{unit} "
