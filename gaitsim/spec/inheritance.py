"""Inheritance by `extends:`, and single settings from the command line."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Set
from pathlib import Path

from gaitsim.errors import Fault, Faults, InvalidSpec, Mark, Usage, did_you_mean
from gaitsim.text import document
from gaitsim.text.document import MappingNode, Node, ScalarNode, SequenceNode, plain
from gaitsim.text.syntax import DEPTH_LIMIT

VALUE_KEYS = frozenset({"value", "tune", "spread", "source"})
_SECTIONS = frozenset(
    {"about", "gaitsim", "initial", "objective", "parameters", "reproduces", "simulate", "study", "use_for"}
)
_SEARCHED = ("measures", "parts")
_SPEC = re.compile(
    rf"^\ufeff?({'|'.join(sorted({'extends', 'optimize', *_SECTIONS, *_SEARCHED}))}) *:(\s|$)", re.MULTILINE
)


def merged(base: MappingNode, over: MappingNode) -> MappingNode:
    """Merge two documents.

    Args:
        base: The parent.
        over: The document that overrides it. A null removes a key; a null without such a key stays, because it may
            refer to a part of a composite.
    """
    entries, keys = dict(base.entries), dict(base.keys)
    for key, node in over.entries.items():
        _put(entries, keys, key, node, over.keys[key])
    return MappingNode(entries, keys, over.mark, _swapped(base, over))


def _swapped(base: MappingNode, over: MappingNode) -> frozenset[str]:
    """The keys that a part inherits from an entry with another component; the new component may lack them."""
    old, new = base.entries.get("use"), over.entries.get("use")
    if old is None or new is None or plain(old) == plain(new):
        return base.swapped | over.swapped
    return base.swapped | over.swapped | frozenset(base.entries)


def with_parents(
    path: Path, display_path: str, read: Callable[[Path, str], MappingNode] = document.read
) -> MappingNode:
    """Read a document and merge it with the parents that `extends:` names.

    Args:
        path: The file.
        display_path: Its name in messages.
        read: Reads a document from a file, given its name in messages.

    Raises:
        InvalidSpec: A file cannot be read, or specs extend each other in a ring.
    """
    documents = [read(path, display_path)]
    names, seen = [display_path], [os.path.realpath(path)]
    while "extends" in documents[-1].entries:
        parent = documents[-1].entries["extends"]
        if not isinstance(parent, ScalarNode) or not isinstance(parent.value, str):
            rule = "extends names one parent"
            raise InvalidSpec(Fault(f"{rule}; write a file, such as extends: walk.yaml.", parent.mark, "extends"))
        path, display_path = path.parent / parent.value, str(Path(display_path).parent / parent.value)
        names.append(display_path)
        if os.path.realpath(path) in seen:
            ring = " -> ".join(names[seen.index(os.path.realpath(path)) :])
            rule = f"these extend each other in a ring: {ring}"
            raise InvalidSpec(Fault(f"{rule}; remove one extends.", parent.mark, "extends"))
        seen.append(os.path.realpath(path))
        documents.append(_parent(path, display_path, parent.mark, read))
    # A changed spec need not reproduce the values of its parent.
    documents[1:] = [without(each, "reproduces") for each in documents[1:]]
    result, *children = [without(each, "extends") for each in reversed(documents)]
    for child in children:
        result = merged(result, child)
    return result


def parents(path: Path) -> Iterator[Path]:
    """The files that a spec extends, nearest first. The spec must have been read by `with_parents` before."""
    while isinstance(parent := document.read(path).entries.get("extends"), ScalarNode):
        path = path.parent / str(parent.value)
        yield path


def split_setting(text: str, origin: str = "--set") -> tuple[str, str]:
    """Split a setting such as `leg.knee.stiffness=5`.

    Args:
        text: The setting.
        origin: The option that it comes from, for messages.

    Returns:
        The address and the value.

    Raises:
        Usage: It is not of this form.
    """
    address, equals, value = (piece.strip() for piece in text.partition("="))
    if not equals:
        rule = "a setting is address=value"
        raise Usage(f"{origin} {text}: {rule}; write, for example, {origin} leg.knee.damping=5.")
    if not value:
        move = 'write null to remove it, or "" for an empty text'
        raise Usage(f"{origin} {text}: there is no value after the =; {move}.")
    _words(address, f"{origin} {text}")
    return address, value


def override(spec: MappingNode, address: str, text: str, origin: str = "--set") -> MappingNode:
    """Set one value of a spec.

    Args:
        spec: The document.
        address: The address, such as leg.knee.damping.
        text: The value as text.
        origin: The option that it comes from, for messages.

    Returns:
        A new document.

    Raises:
        InvalidSpec: The address or the value cannot be used.
    """
    mark = Mark(f"{origin} {address}={text}")
    words = _sectioned(spec, _words(address, mark.file))
    if len(words) > DEPTH_LIMIT:
        raise Usage(f"{mark}: this address has {len(words)} words; name a part of the spec.")
    return _laid(spec, words, document.parse_value(text, mark.file), mark)


def laid(spec: MappingNode, address: str, value: Node, mark: Mark) -> MappingNode:
    """Merge a node into a spec at an address, as for a row of a study."""
    return _laid(spec, _sectioned(spec, _words(address, str(mark))), value, mark)


def _laid(spec: MappingNode, words: tuple[str, ...], value: Node, mark: Mark) -> MappingNode:
    faults = Faults()
    if len(words) == 2 and words[0] == "parameters":
        _check_declares(spec, words[1], value, mark, faults)
    elif words[0] == "parameters":
        _check_is_no_part(spec, words, mark, faults)
    faults.raise_if_any()
    result = _with(spec, words, (), value, mark, faults)
    faults.raise_if_any()
    assert isinstance(result, MappingNode)  # a spec stays a mapping
    return result


def _check_declares(spec: MappingNode, name: str, value: Node, mark: Mark, faults: Faults) -> None:
    """Check that `parameters.NAME` declares a parameter; a value alone needs another address."""
    removed = isinstance(value, ScalarNode) and value.value is None
    if removed or (isinstance(value, MappingNode) and not _is_value(value)):
        return
    section = spec.entries.get("parameters")
    known = section.entries if isinstance(section, MappingNode) else {}
    places = [place for word in _SEARCHED for place in _addresses(spec.entries.get(word), name)]
    if name in known:
        rule = f"a parameter of the spec goes by its name alone; write {name} instead of parameters.{name}"
    elif places:
        rule = f"the spec itself has no parameter {name}; write {', or '.join(places[:3])}"
    else:
        hint = did_you_mean(name, known) if known else "It has none."
        faults.add(f"the spec itself has no parameter {name}. {hint}", mark, f"parameters.{name}")
        return
    faults.add(f"{rule}.", mark, f"parameters.{name}")


def _check_is_no_part(spec: MappingNode, words: tuple[str, ...], mark: Mark, faults: Faults) -> None:
    """Check that an address below `parameters.NAME` belongs to a parameter of the spec and not to a part."""
    parts = spec.entries.get("parts")
    if isinstance(parts, MappingNode) and words[1] in parts.entries:
        wrong, right = ".".join(words), ".".join(words[1:])
        faults.add(f"a value of a part goes by the part's name; write {right} instead of {wrong}.", mark, wrong)


def _addresses(node: Node | None, name: str) -> Iterator[str]:
    """The addresses of a key in a section of parts."""
    for key, inner in node.entries.items() if isinstance(node, MappingNode) else ():
        if isinstance(inner, MappingNode):
            if name in inner.entries:
                yield f"{key}.{name}"
            yield from (f"{key}.{place}" for place in _addresses(inner, name))


def _put(entries: dict[str, Node], keys: dict[str, Mark], key: str, over: Node, mark: Mark) -> None:
    """Merge a node into an entry, or remove the entry."""
    if isinstance(over, ScalarNode) and over.value is None and key in entries:
        del entries[key], keys[key]
        return
    if isinstance(over, MappingNode) and not _is_value(over):
        base = entries.get(key)
        over = merged(base, over) if isinstance(base, MappingNode) and not _is_value(base) else over
    entries[key], keys[key] = over, mark


def _is_value(node: Node) -> bool:
    """Whether a mapping is one number with its fields: value, tune, spread, source."""
    return isinstance(node, MappingNode) and bool(node.entries) and set(node.entries) <= VALUE_KEYS


def _parent(path: Path, display_path: str, mark: Mark, read: Callable[[Path, str], MappingNode]) -> MappingNode:
    """Read a parent. A fault of the file as a whole is reported at the place that names it."""
    try:
        # The writer of `extends:` chose the file, so messages quote nothing of a file that is not a spec.
        if not _SPEC.search(document.text_of(path, display_path)):
            rule = f"{display_path} is not a spec, as it has none of a spec's sections, such as parts:"
            raise InvalidSpec(Fault(f"{rule}; name a spec.", mark, "extends"))
        return read(path, display_path)
    except InvalidSpec as error:
        raise InvalidSpec(
            fault
            if fault.mark and fault.mark.line
            else Fault(f"{fault.mark or display_path}: {fault.message}", mark, "extends")
            for fault in error.faults
        ) from error


def without(node: MappingNode, *names: str) -> MappingNode:
    """The mapping without some keys; the same object if it has none of them."""
    if node.entries.keys().isdisjoint(names):
        return node
    entries = {name: inner for name, inner in node.entries.items() if name not in names}
    return MappingNode(entries, {name: node.keys[name] for name in entries}, node.mark, node.swapped)


def without_marked(node: Node, marks: Set[Mark]) -> Node:
    """The node without the entries whose keys are at these places."""
    if isinstance(node, SequenceNode):
        return SequenceNode(tuple(without_marked(item, marks) for item in node.items), node.mark)
    if not isinstance(node, MappingNode):
        return node
    rest = {key: without_marked(inner, marks) for key, inner in node.entries.items() if node.keys[key] not in marks}
    return MappingNode(rest, {key: node.keys[key] for key in rest}, node.mark, node.swapped)


def _words(address: str, origin: str) -> tuple[str, ...]:
    words = tuple(word.strip() for word in address.split("."))
    if not all(words):
        rule = "an address is words with one dot between them"
        raise Usage(f"{origin}: {rule}, such as leg.knee.damping.")
    return words


def _sectioned(spec: MappingNode, words: tuple[str, ...]) -> tuple[str, ...]:
    """The address from the top of the spec, beginning with the section of its first word."""
    first, *rest = words
    if first == "initial" and rest:
        return first, ".".join(rest)
    if first in _SECTIONS or first in spec.entries or first in _SEARCHED:
        return words
    masks, measures = spec.entries.get("parameters"), spec.entries.get("measures")
    if not rest and isinstance(masks, MappingNode) and first in masks.entries:
        return "parameters", first, "default"
    found = isinstance(measures, MappingNode) and first in measures.entries
    return ("measures" if found else "parts", *words)


def _with(
    node: Node | None,
    words: tuple[str, ...],
    walked: tuple[str, ...],
    value: Node,
    mark: Mark,
    faults: Faults,
) -> Node:
    """The node with a value at the end of the words."""
    word, *rest = words
    path = (*walked, word)
    if isinstance(node, SequenceNode):
        last = len(node.items) - 1
        if not (word.isascii() and word.isdigit() and len(word) < 10 and int(word) <= last):
            rule = f"{word} is not an item of this list" if node.items else "this list is empty"
            move = f"number its items from 0 to {last}" if node.items else "set the whole list"
            faults.add(f"{rule}; {move}.", mark, _address(walked))
            return node
        at = int(word)
        item = _with(node.items[at], tuple(rest), path, value, mark, faults) if rest else value
        return SequenceNode((*node.items[:at], item, *node.items[at + 1 :]), node.mark)
    if isinstance(node, ScalarNode) and node.value is not None:
        rule = f"{walked[-1]} is {_value_text(node.value)}, with no {word} inside"
        faults.add(f"{rule}; set {_address(walked)} as a whole.", mark, _address(walked))
        return node
    ground = node if isinstance(node, MappingNode) else MappingNode({}, {}, mark)
    entries, keys = dict(ground.entries), dict(ground.keys)
    if rest:
        entries[word] = _with(entries.get(word), tuple(rest), path, value, mark, faults)
        keys.setdefault(word, mark)
    else:
        _put(entries, keys, word, value, mark)
    return MappingNode(entries, keys, ground.mark, _swapped(ground, MappingNode(entries, keys, mark)))


def _value_text(value: bool | float | str | None) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _address(path: tuple[str, ...]) -> str:
    """The dotted address as users write it: the words `parts` and `measures` may be left out."""
    return ".".join(path[1:] if path[0] in _SEARCHED and len(path) > 1 else path)
