"""All faults of a component as a part of a library, with their places."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from gaitsim.component import Attachment, Declaration, Frame, Input, Metric, Option, Output, Parameter, Points, State
from gaitsim.components.bibliography import FILE, keys_of, read_bibliography, unknown_key
from gaitsim.components.checks.audit import audit
from gaitsim.components.checks.check import declaration_marks, parse
from gaitsim.components.composite import Composite
from gaitsim.components.find import Library, display_path, is_component
from gaitsim.components.ieee import ieee_math
from gaitsim.components.load import component_class, execute
from gaitsim.components.primitive import Primitive
from gaitsim.errors import Fault, GaitsimError, Mark
from gaitsim.text.document import MappingNode

_DOCUMENTED = Parameter | Input | Output | State | Metric | Attachment | Frame | Points | Option


def review(reference: str, library: Library) -> list[Fault]:
    """Find every fault of a component: names, units, kind, documentation, sources, bounds, and unreached lines.

    Args:
        reference: Kind and name.
        library: The library that the component belongs to.
    """
    faults = list[Fault]()
    try:
        found = library.find(reference)
    except GaitsimError as error:
        faults += error.faults
        return _sorted([*faults, *_of_broken(reference, library)])
    keys = set(read_bibliography(library.folders))
    if isinstance(found, Composite):
        return _sorted([*faults, *_of_composite(found, keys), *_inner(found, library)])
    return _sorted([*faults, *_of_primitive(found, keys, library)])


def _of_broken(reference: str, library: Library) -> Iterator[Fault]:
    """Faults of documentation and sources of a file that cannot be loaded, as far as its declarations can be read."""
    path = library.path(reference)
    if path is None or path.suffix != ".py":
        return
    file = display_path(path)
    try:
        text = path.read_text(encoding="utf-8")
        tree = parse(text, file)
        cls = component_class(execute(text, file, ieee_math(), library.shared(path.parent.name, text)))
    except (OSError, UnicodeError, GaitsimError):
        return
    marks = declaration_marks(tree, file, text.splitlines())
    yield from _policy(cls.declarations, cls.__doc__ or "", marks, set(read_bibliography(library.folders)))


def _of_primitive(found: Primitive, keys: set[str], library: Library) -> Iterator[Fault]:
    lines = found.text.splitlines()
    marks = declaration_marks(parse(found.text, found.display_path), found.display_path, lines)
    yield from _policy(found.cls.declarations, found.doc, marks, keys)
    for line in audit(found.text, found.display_path, found.shared).unreached:
        place = Mark(found.display_path, line, 1, lines[line - 1])
        yield Fault("no path leads here, so its units were not checked; remove it, or a condition before it.", place)
    if library.contract(found.kind) is None:
        move = f"write {found.path.parent.name}/kind.yaml with about:, or choose a kind that exists"
        yield Fault(f"the kind {found.kind} has no contract; {move}.", marks[""])


def _policy(
    declarations: Mapping[str, Declaration], doc: str, marks: Mapping[str, Mark], keys: set[str]
) -> Iterator[Fault]:
    """Faults of documentation, sources and bounds of declarations."""
    if not doc.strip():
        yield Fault("the component has no doc; write what it computes, and by which equation, below class.", marks[""])
    for name, one in declarations.items():
        mark = marks.get(name)
        if isinstance(one, _DOCUMENTED) and not one.doc.strip():
            yield Fault(f"{name} has no doc; say what it is.", mark)
        if isinstance(one, Parameter):
            yield from _of_parameter(name, one.source, one.default is not None, one, mark, keys)


def _of_parameter(
    name: str, source: str, default: bool, one: Parameter, mark: Mark | None, keys: set[str]
) -> Iterator[Fault]:
    if default and not source:
        rule = f'{name} has a default and no source; write source="a key of {FILE}", or source="definition: why"'
        yield Fault(f"{rule}.", mark)
    if one.bounds is None and one.unit != "*":
        yield Fault(f"{name} has no bounds; write between which values it makes sense.", mark)
    for key in keys_of(source):
        if key not in keys:
            yield Fault(unknown_key(key, keys), mark, name)


def _of_composite(found: Composite, keys: set[str]) -> Iterator[Fault]:
    file = display_path(found.path)
    if not found.doc.strip():
        yield Fault("the component has no doc; write about: and what it is.", Mark(file, 1, 1))
    for name, one in found.parameters.items():
        mark = found.mark("parameters", name)
        if not one.doc.strip():
            yield Fault(f"{name} has no doc; say what it is.", mark)
        yield from _of_parameter(name, one.source, name in found.defaults, one, mark, keys)


def _inner(found: Composite, library: Library) -> Iterator[Fault]:
    """Faults of inner parts with an unknown or broken component."""
    for name, node in found.parts.entries.items():
        entry = node.entries.get("use") if isinstance(node, MappingNode) else None
        reference = str(getattr(entry, "value", ""))
        if not reference:
            yield Fault("an inner part needs use: kind/name.", found.parts.keys[name], name)
            continue
        try:
            library.find(reference)
        except GaitsimError as error:
            mark = entry.mark if entry else found.parts.keys[name]
            yield from (f if f.mark else Fault(f.message, mark, name) for f in error.faults)


def _sorted(faults: list[Fault]) -> list[Fault]:
    """Faults without repetition, in the order of their places."""
    unique = {(str(f.mark), f.message): f for f in faults}.values()
    return sorted(unique, key=lambda f: (f.mark.file, f.mark.line, f.mark.column) if f.mark else ("", 0, 0))


def components_in(path: Path) -> tuple[Path, list[str]]:
    """The components in a file or folder.

    Returns:
        The folder of kinds, and the references of the components below the path.
    """
    if path.is_file():
        return path.parent.parent, [f"{path.parent.name}/{path.stem}"]
    files = [f for f in path.glob("*/*") if is_component(f)]
    root = path if files else path.parent
    files = files or [f for f in path.glob("*") if is_component(f)]
    return root, sorted({f"{f.parent.name}/{f.stem}" for f in files})
