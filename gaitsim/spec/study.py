"""Studies and episodes: tables of overrides, from `--vary address=values`, `study:` and `optimize: episodes:`."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass

from gaitsim.errors import Faults, Mark, Usage
from gaitsim.spec.inheritance import laid, override, split_setting, without
from gaitsim.text.document import MappingNode, Node, SequenceNode, dump, plain
from gaitsim.text.quantity import in_plain_letters, quoted, unknown_unit
from gaitsim.units import UnknownUnit, parse_quantity, with_unit

_RANGE_LIMIT = 100_000


@dataclass(frozen=True)
class Variant:
    """One row of a study: its settings as written, the document with them, and the place of the row."""

    settings: dict[str, str]
    document: MappingNode
    mark: Mark | None = None


@dataclass(frozen=True)
class Span:
    """A range of values in one unit. Its first end may be the larger one."""

    first: float
    last: float
    unit: str

    def at(self, share: float) -> str:
        """The value at a share of the range, from 0 to 1, as text for a spec."""
        return with_unit(repr(float(f"{self.first + share * (self.last - self.first):.12g}")), self.unit)


def span(text: str) -> tuple[str, Span]:
    """Read an address and a range, such as `push.strength=0 N:200 N`.

    Raises:
        Usage: The text is not of this form, or its units do not fit.
    """
    address, values = split_setting(text, "--vary")
    pieces = [piece.strip() for piece in values.split(":")]
    found = _span(pieces[0], pieces[1], text) if len(pieces) == 2 else None
    if found is None or found.first == found.last:
        raise Usage(f"--vary {text}: this is from:to, two values that differ, such as push.strength=0 N:200 N.")
    return address, found


def variants(document: MappingNode, vary: Sequence[str]) -> list[Variant]:
    """Combine every row of the section `study:` with every value of each `--vary`.

    Args:
        document: The document.
        vary: Texts such as `gain=1,2,3` or `gain=1:15:20`.

    Returns:
        The rows; one row without changes if nothing varies.

    Raises:
        Usage: A `--vary` is not a list of values.
        InvalidSpec: The study has a fault.
    """
    columns = [column(text) for text in vary]
    base = without(document, "study")
    rows: list[Variant] = []
    for start in _table(document.entries.get("study"), document.keys.get("study"), base, "study"):
        settings = start.settings
        for values in itertools.product(*([(address, v) for v in options] for address, options in columns)):
            row = start.document
            for address, value in values:
                row = override(row, address, value, "--vary")
            rows.append(Variant(settings | dict(values), row))
    return rows


def episodes(document: MappingNode) -> list[Variant]:
    """The episodes of the section `optimize:`; the unchanged document if it has none.

    Raises:
        InvalidSpec: The list of episodes has a fault.
    """
    section = document.entries.get("optimize")
    inside = section if isinstance(section, MappingNode) else MappingNode({}, {}, document.mark)
    given = inside.entries.get("episodes")
    return _table(given, inside.keys.get("episodes"), document, "optimize.episodes")


def _table(section: Node | None, key: Mark | None, base: MappingNode, name: str) -> list[Variant]:
    """The rows of a list of overrides; the unchanged base without a list."""
    if section is None or plain(section) in (None, []):
        return [Variant({}, base)]
    rows, faults = [], Faults()
    word = name.rpartition(".")[2]
    for item in section.items if isinstance(section, SequenceNode) else (section,):
        if not isinstance(item, MappingNode) or item is section:
            sample = "[{feedback.gain: 2}, {feedback.gain: 3}]"
            rule = f"{quoted(item)} is not a list of overrides; write {word}: {sample}."
            faults.add(rule, key if item is section else item.mark, name)
            continue
        row = base
        for address, node in item.entries.items():
            row = laid(row, address, node, item.keys[address])
        rows.append(Variant({address: _text(node) for address, node in item.entries.items()}, row, item.mark))
    faults.raise_if_any()
    return rows


def _text(node: Node) -> str:
    return dump({"x": plain(node)}).removeprefix("x:").strip()


def column(text: str, option: str = "--vary") -> tuple[str, list[str]]:
    """An address and its values: `gain=1:15:20` (first, last, count) or `step=1 ms,0.5 ms`.

    Raises:
        Usage: The text is not of this form, or its units do not fit.
    """
    address, values = split_setting(text, option)
    pieces = [piece.strip() for piece in values.split(":")]
    if len(pieces) == 3:
        return address, _range(pieces, text, option)
    if len(pieces) != 1:
        raise Usage(f"{option} {text}: a range is low:high:count, such as gain=1:15:20.")
    # Commas within brackets belong to the value.
    return address, [piece.strip() for piece in re.split(r",(?![^\[{]*[\]}])", values)]


def _range(pieces: list[str], text: str, option: str) -> list[str]:
    count = int(pieces[2]) if pieces[2].isdigit() else 0
    span = _span(pieces[0], pieces[1], text, option)
    if span is None or not 1 <= count <= _RANGE_LIMIT:
        raise Usage(f"{option} {text}: a range is low:high:count, such as gain=1:15:20.")
    return [span.at(i / max(1, count - 1)) for i in range(count)]


def _span(low: str, high: str, text: str, option: str = "--vary") -> Span | None:
    """The range between two values; None if one of them is not a number.

    Raises:
        Usage: The units do not fit.
    """
    try:
        first, last = parse_quantity(low), parse_quantity(high)
    except UnknownUnit as error:
        letters = in_plain_letters(low) or in_plain_letters(high)
        raise Usage(f"{option} {text}: {letters or unknown_unit(str(error))}") from error
    if first is None or last is None:
        letters = in_plain_letters(high if first else low)
        if letters:
            raise Usage(f"{option} {text}: {letters}")
        return None
    if first.unit.text != last.unit.text and first.unit.dimension != last.unit.dimension:
        raise Usage(f"{option} {text}: both ends need the same unit, such as 1 ms:5 ms:3.")
    factor = first.unit.factor
    return Span(first.value / factor, last.value / factor, first.unit.text)
