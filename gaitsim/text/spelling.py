"""Misspelt keys: told once, and read as what was meant, so that nothing else is missed for want of them."""

from __future__ import annotations

from collections.abc import Iterable

from gaitsim.errors import Faults, did_you_mean, nearest
from gaitsim.text.document import MappingNode, Node


def respelled(
    node: MappingNode, known: Iterable[str], lack: str, faults: Faults, address: str = "", more: Iterable[str] = ()
) -> MappingNode:
    """The mapping with known keys; an unknown one is a fault and stands in for what it resembles.

    `lack` are the words before the unknown one, such as "a spec has no key"; `more` are known
    keys that hints leave out.
    """
    words = list(known)
    entries: dict[str, Node] = {}
    keys = {}
    for word, value in node.entries.items():
        meant: str | None = word
        if word not in words and word not in more:
            faults.add(f"{lack} {word}. {did_you_mean(word, words)}", node.keys[word], address)
            near = nearest(word, words)
            meant = None if near in node.entries else near
        if meant is not None and meant not in entries:
            entries[meant], keys[meant] = value, node.keys[word]
    return MappingNode(entries, keys, node.mark, node.swapped)
