"""Misspelt keys: each is reported once, and then read as the key that was meant, so that checking can continue."""

from __future__ import annotations

from collections.abc import Iterable

from gaitsim.errors import Faults, did_you_mean, nearest
from gaitsim.text.document import MappingNode, Node


def respelled(
    node: MappingNode, known: Iterable[str], lack: str, faults: Faults, address: str = "", more: Iterable[str] = ()
) -> MappingNode:
    """The mapping with known keys. An unknown key is a fault, and takes the place of the key that it resembles.

    Args:
        lack: The words before the unknown key in the message, such as "a spec has no key".
        more: Known keys that hints leave out.
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
