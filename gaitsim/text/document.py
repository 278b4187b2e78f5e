"""The text of a spec as data with places: YAML with five own rules for scalars."""

from __future__ import annotations

import math
import re
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Union

import yaml

from gaitsim.distribution import shipped_specs
from gaitsim.errors import Fault, Faults, InvalidSpec, Mark, did_you_mean
from gaitsim.text.syntax import DEPTH_LIMIT, NO_ANCHORS, ONE_DOCUMENT, TOO_DEEP, explained

SIZE_LIMIT = 5_000_000

# libyaml if PyYAML has it: it takes a tenth of the time and gives the same events and text.
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_DUMPER: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
_INTEGER = re.compile(r"[-+]?(0|[1-9][0-9]*)")
_FLOAT = re.compile(r"[-+]?((0|[1-9][0-9]*)(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?")
_WORDS: dict[str, bool | None] = {"": None, "~": None, "null": None, "true": True, "false": False}
_BREAK = re.compile("\r\n|[\n\r\x85\u2028\u2029]")
# All but what YAML allows: tab, \x20 to \x7e, \xa0 to \ud7ff, \ue000 to \ufffd, \U00010000 and above.
_CONTROL = re.compile("[\x00-\x08\x0a-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
_SIDE = re.compile(r"\{(other|side)\}")
_HIDDEN = re.compile("⟨(other|side)⟩")
_EMPTY = 'there is nothing in it; write "parts:" and below it the parts.'


@dataclass(frozen=True)
class ScalarNode:
    """One value and its place."""

    value: bool | int | float | str | None
    mark: Mark


@dataclass(frozen=True)
class SequenceNode:
    """A list of nodes and its place."""

    items: tuple[Node, ...]
    mark: Mark


@dataclass(frozen=True)
class MappingNode:
    """Nodes by key, in the order of the text, with the place of each key.

    Attributes:
        swapped: Keys that were written for a component which `use:` replaced.
    """

    entries: dict[str, Node]
    keys: dict[str, Mark]
    mark: Mark
    swapped: frozenset[str] = frozenset()


Node = Union[ScalarNode, SequenceNode, MappingNode]  # noqa: UP007 (the names below it must exist at run time)


def read(path: Path, display_path: str | None = None) -> MappingNode:
    """Read a document from a file.

    Args:
        path: The file.
        display_path: The name of the file in messages; the path by default.

    Raises:
        InvalidSpec: The file cannot be read, or its text is not a document.
    """
    name = str(path) if display_path is None else display_path
    return parse(text_of(path, name), name)


def text_of(path: Path, name: str, what: str = "spec") -> str:
    """Read a text file.

    Args:
        path: The file.
        name: The name of the file in messages.
        what: What the file should be, for messages.

    Raises:
        InvalidSpec: The file is missing, too large, or not UTF-8.
    """
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            inside = ", ".join(_specs_in(path))
            hint = f"name one spec in it: {inside}" if inside else "it holds no .yaml file"
            raise _refused(name, f"this is a folder; {hint}.")
        if not stat.S_ISREG(status.st_mode):
            raise _refused(name, f"this is a pipe or a device; save the {what} in a file and name it.")
        if status.st_size > SIZE_LIMIT:
            size, limit = status.st_size / 1e6, SIZE_LIMIT // 1_000_000
            rule = f"this file has {size:.1f} MB and the limit is {limit} MB"
            raise _refused(name, f"{rule}; name a {what}, and keep data in other files.")
        data = path.read_bytes()
    except (FileNotFoundError, NotADirectoryError) as error:
        raise _refused(name, _missing(path)) from error
    except PermissionError as error:
        rule = "there is no permission to read it"
        raise _refused(name, f"{rule}; allow it with: chmod u+r {name}") from error
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path itself
        reason = getattr(error, "strerror", None) or str(error)
        raise _refused(name, f"it cannot be read ({reason}); check the path.") from error
    return _decoded(data, name)


def parse(text: str, file: str) -> MappingNode:
    """Read a document from a text.

    Args:
        text: YAML.
        file: The name of the text in messages.

    Raises:
        InvalidSpec: The text is not a document; the error has every fault.
    """
    reader = _Reader(text, file)
    top = reader.document()
    if top is None:
        raise _refused(file, _EMPTY)
    if not isinstance(top, MappingNode):
        kind = "a list" if isinstance(top, SequenceNode) else "a bare value"
        raise InvalidSpec(Fault(f'this is {kind}; a spec is keys with values, such as "parts: ...".', top.mark))
    return top


def parse_value(text: str, file: str) -> Node:
    """Read one value by the rules of documents. Its places have no line.

    Args:
        text: The value, as after `--set ADDRESS=`.
        file: The name of the text in messages.

    Raises:
        InvalidSpec: The text is not a value.
    """
    value = _Reader(text, file, lines_count=False).document()
    if value is None:
        raise _refused(file, "there is no value; write one, in quotes if it begins with #.")
    return value


def plain(node: Node) -> Any:
    """The node as plain Python data."""
    if isinstance(node, MappingNode):
        return {key: plain(value) for key, value in node.entries.items()}
    if isinstance(node, SequenceNode):
        return [plain(item) for item in node.items]
    return node.value


def dump(data: Any) -> str:
    """Write plain data as YAML that `parse` reads back identically."""
    if not isinstance(data, dict):
        raise TypeError(f"a document is a dict, not a {type(data).__name__}")
    node = _represented(data)
    node.flow_style = not data
    text = yaml.serialize(node, Dumper=_Dumper, allow_unicode=True, width=2**31 - 1)
    return str(text)


def scalar(text: str) -> bool | int | float | str | None:
    """The meaning of an unquoted text. A number that is too large becomes infinite."""
    if text in _WORDS:
        return _WORDS[text]
    if _INTEGER.fullmatch(text):
        return int(text) if len(text) <= 308 else math.inf
    return float(text) if _FLOAT.fullmatch(text) else text


class _Reader:
    """Makes nodes from YAML events, and collects faults."""

    def __init__(self, text: str, file: str, lines_count: bool = True) -> None:
        # Events rather than yaml.compose: composing loses anchors and recurses without a limit.
        text = text.removeprefix("\ufeff")
        # {other} and {side} belong to our grammar; between braces YAML would read a mapping.
        self.text, self.file, self.lines_count = _SIDE.sub(r"⟨\1⟩", text), file, lines_count
        self.lines = _BREAK.split(text)
        self.faults = Faults()
        self.events: Iterator[yaml.Event] = iter(())

    def mark(self, line: int, column: int) -> Mark:
        if not self.lines_count:
            return Mark(self.file)
        text = self.lines[line] if line < len(self.lines) else ""
        if column > 200:  # a frame is useless for a very long line
            text = ""
        shown = text[:240]
        if not shown.isprintable():
            shown = "".join(letter if letter.isprintable() else " " for letter in shown)
        return Mark(self.file, line + 1, column + 1, shown)

    def document(self) -> Node | None:
        node: Node | None = None
        for number, line in enumerate(self.lines):
            if found := _CONTROL.search(line):
                rule = f"U+{ord(found[0]):04X} is a control character, which a spec must not contain"
                self.faults.add(f"{rule}; remove it.", self.mark(number, found.start()))
        self.faults.raise_if_any()
        self.events = yaml.parse(self.text, Loader=_LOADER)
        try:
            for event in self.events:
                if isinstance(event, yaml.DocumentStartEvent) and node is not None:
                    self.fault(f"a second document begins here; {ONE_DOCUMENT}", event)
                    break
                if isinstance(event, yaml.NodeEvent):
                    node = self.node(event, 1)
        except yaml.MarkedYAMLError as error:
            message, line_number, column = explained(error, self.lines)
            self.faults.add(message, self.mark(line_number, column))
        self.faults.raise_if_any()
        return node

    def fault(self, message: str, event: yaml.Event) -> None:
        self.faults.add(message, self.place(event))

    def place(self, event: yaml.Event) -> Mark:
        begin = event.start_mark
        return self.mark(begin.line, begin.column) if begin else Mark(self.file)

    def node(self, event: yaml.Event, depth: int) -> Node:
        if depth > DEPTH_LIMIT:
            self.fault(TOO_DEEP, event)
            self.faults.raise_if_any()
        mark = self.place(event)
        if isinstance(event, yaml.AliasEvent) or getattr(event, "anchor", None):
            self.fault(NO_ANCHORS, event)
        if tag := getattr(event, "tag", None):
            short = str(tag).replace("tag:yaml.org,2002:", "!!")
            self.fault(f"{short} is a tag, which a spec may not have; remove it.", event)
        if isinstance(event, yaml.SequenceStartEvent):
            items = self.until(yaml.SequenceEndEvent)
            return SequenceNode(tuple(self.node(item, depth + 1) for item in items), mark)
        if isinstance(event, yaml.MappingStartEvent):
            return self.mapping(mark, depth)
        if isinstance(event, yaml.ScalarEvent):
            written = _HIDDEN.sub(r"{\1}", event.value)
            value = written if event.style else scalar(written)
            if value in (math.inf, -math.inf):
                self.fault("this number is too large; write one below 1.8e308.", event)
            return ScalarNode(value, mark)
        return ScalarNode(None, mark)

    def mapping(self, mark: Mark, depth: int) -> MappingNode:
        entries: dict[str, Node] = {}
        keys: dict[str, Mark] = {}
        for event in self.until(yaml.MappingEndEvent):
            merge = isinstance(event, yaml.ScalarEvent) and not event.style and event.value == "<<"
            key = self.node(event, depth + 1)
            value_event = next(self.events)
            if merge:
                self.fault(NO_ANCHORS, event)
                if isinstance(value_event, yaml.AliasEvent):
                    continue  # one mistake, said once
            value = self.node(value_event, depth + 1)
            word = key.value if isinstance(key, ScalarNode) else None
            if comma := self.decimal_comma(event, value, entries):
                self.fault(comma, event)
            elif not isinstance(word, str):
                written = getattr(event, "value", "")
                move = f'it in quotes: "{written}"' if written else "a word before the colon"
                self.fault(f"a key must be text; write {move}.", event)
            elif word in entries:
                first = f" (first in line {keys[word].line})" if self.lines_count else ""
                rule = f"{word} occurs twice here{first}"
                self.fault(f"{rule}; remove or rename one of the two.", event)
            else:
                entries[word], keys[word] = value, key.mark
        return MappingNode(entries, keys, mark)

    def decimal_comma(self, key: yaml.Event, value: Node, before: dict[str, Node]) -> str:
        """The fault of a key that is the rest of a number with a decimal comma, as in {mass: 2,5 kg}; empty for other
        keys.
        """
        number, rest, begin = next(reversed(before.values()), None), getattr(key, "value", ""), key.start_mark
        if begin is None or not isinstance(number, ScalarNode) or plain(value) is not None or not rest[:1].isdigit():
            return ""
        if not isinstance(number.value, int) or self.lines[begin.line][: begin.column][-1:] != ",":
            return ""
        rule = f'"{number.value},{rest}" has a comma, which ends a value between braces'
        return f"{rule}; write {number.value}.{rest}."

    def until(self, end: type[yaml.Event]) -> Iterator[yaml.Event]:
        while not isinstance(event := next(self.events), end):
            yield event


def _decoded(data: bytes, name: str) -> str:
    move = "save it as text in UTF-8, or name another file"
    if (zero := data.find(b"\0")) >= 0:
        raise _refused(name, f"byte {zero} is NUL, so this is not a text in UTF-8; {move}.")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        found = f"byte {error.start} (0x{data[error.start]:02x}, in line"
        line = data.count(b"\n", 0, error.start) + 1
        raise _refused(name, f"{found} {line}) is not UTF-8; {move}.") from error


def _specs_in(folder: Path) -> list[str]:
    try:
        return sorted(path.name for path in folder.glob("*.yaml"))
    except OSError:
        return []


def _missing(path: Path) -> str:
    if path.is_symlink():
        return f"this links to {path.readlink()}, which does not exist; correct the link."
    if path.parts[0] in ("http:", "https:"):  # a path has one slash after them
        return "this is an address on the web, and specs are files here; download it first."
    if not path.parent.is_dir():
        return f"there is no folder {path.parent}; check the path.{_shipped(path)}"
    names = _specs_in(path.parent)
    hint = did_you_mean(path.name, names) if names else "Its folder holds no .yaml file."
    return f"there is no such file. {hint}"


def _shipped(path: Path) -> str:
    """How to get the shipped spec of this name, if there is one."""
    if path.stem not in shipped_specs():
        return ""
    return f" To copy this model of gaitsim into a new folder: gaitsim new FOLDER --from {path.stem}."


def _refused(name: str, message: str) -> InvalidSpec:
    return InvalidSpec(Fault(message, Mark(name)))


class _Dumper(_DUMPER):  # type: ignore[misc]  # either one, known when imported
    """Quotes a text only if it would have another meaning without quotes."""

    def resolve(self, kind: Any, value: Any, implicit: Any) -> str:
        text = kind is not yaml.ScalarNode or not implicit[0] or isinstance(scalar(value), str)
        return "text" if text else "other"


def _represented(data: Any) -> Any:
    if isinstance(data, dict):
        if unfit := [key for key in data if not isinstance(key, str)]:
            raise TypeError(f"a key is a text, not {unfit[0]!r}")
        pairs = [(_represented(key), _represented(value)) for key, value in data.items()]
        leaf = all(isinstance(value, yaml.ScalarNode) for _, value in pairs)
        return yaml.MappingNode("text", pairs, flow_style=leaf)
    if isinstance(data, list | tuple):
        items = [_represented(item) for item in data]
        leaf = all(isinstance(item, yaml.ScalarNode) for item in items)
        return yaml.SequenceNode("text", items, flow_style=leaf)
    if isinstance(data, str):
        # Escapes for line breaks and the like: YAML folds them in its other styles.
        quotes = None if isinstance(scalar(data), str) and data != "<<" else "'"
        return yaml.ScalarNode("text", data, style=quotes if data.isprintable() else '"')
    if data is None or isinstance(data, bool):
        return yaml.ScalarNode("other", {None: "null", True: "true", False: "false"}[data])
    if isinstance(data, int) or (isinstance(data, float) and math.isfinite(data)):
        number = int.__repr__(data) if isinstance(data, int) else float.__repr__(data)
        return yaml.ScalarNode("other", number)
    raise TypeError(f"a document cannot hold {data!r}")
