"""Loading component files: a file is checked, executed and audited."""

from __future__ import annotations

import ast
import hashlib
import io
import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from gaitsim.component import Component, Input, Link, Output, Parameter, Part
from gaitsim.components.checks.audited import remember, sound_findings
from gaitsim.components.checks.check import check_names, declaration_marks, parse, parse_shared, place
from gaitsim.components.checks.findings import findings_of
from gaitsim.components.checks.shared import Shared, builtins_with, import_faults, whole
from gaitsim.components.ieee import ieee_math
from gaitsim.components.primitive import Primitive
from gaitsim.errors import Fault, InvalidComponent, Mark, did_you_mean
from gaitsim.text.expression import BadExpression, parse_expression

FUNCTIONS = ("start", "output", "update", "reset", "finish", "build")


def digest_of(text: str) -> str:
    """The digest of a text; for a component it is the version."""
    return hashlib.sha256(text.encode()).hexdigest()


def as_lines(text: str) -> str:
    r"""A text with "\n" at the end of each line, as Python reads files."""
    return io.StringIO(text, newline=None).read()


def load_primitive(
    reference: str, path: Path, display_path: str, text: str, shared: Sequence[Shared] = ()
) -> Primitive:
    """Load the component that a text holds.

    Args:
        reference: Kind and name, such as "muscle/geyer2003".
        path: Where the file lies.
        display_path: How errors name the file.
        text: The content of the file.
        shared: The files of the kind that the text imports from.

    Raises:
        InvalidComponent: The file has faults; the error holds all of them.
    """
    text = as_lines(text)
    everything = whole(text, shared)
    findings = sound_findings(everything)
    if findings is None:
        tree = parse(text, display_path)
        others = _sound_trees(text, tree, display_path, shared)
        cls = component_class(execute(text, display_path, ieee_math(), shared))
        if faults := _faults(text, tree, cls, display_path, shared, others):
            raise InvalidComponent(faults)
        findings = findings_of(tree, cls.declarations, others)
        remember(everything, findings)
    else:
        cls = component_class(execute(text, display_path, ieee_math(), shared))
    functions = frozenset(name for name in FUNCTIONS if name in vars(cls))
    digest = digest_of(everything)
    return Primitive(reference, path, display_path, text, digest, cls, findings, functions, tuple(shared))


def _sound_trees(text: str, tree: ast.Module, display_path: str, shared: Sequence[Shared]) -> list[ast.Module]:
    """The syntax trees of the shared files. All imports of the component must be defined in them.

    Raises:
        InvalidComponent: A component file breaks the contract.
    """
    others = [parse_shared(file.text, file.display_path) for file in shared]
    lines = text.splitlines()
    wrong = import_faults(tree, shared, others)
    faults = [Fault(message, place(display_path, lines, node.lineno, node.col_offset)) for message, node in wrong]
    for file, other in zip(shared, others, strict=True):
        faults += check_names(other, {}, file.display_path, file.text.splitlines())
    if faults:
        raise InvalidComponent(faults)
    return others


def _faults(
    text: str,
    tree: ast.Module,
    cls: type[Component],
    display_path: str,
    shared: Sequence[Shared],
    others: Sequence[ast.Module],
) -> Sequence[Fault]:
    """The faults of a file that Python could execute. Later checks run only if earlier ones found nothing."""
    from gaitsim.components.checks.audit import audit

    lines = text.splitlines()
    return (
        check_names(tree, cls.declarations, display_path, lines, others)
        or _part_faults(cls, declaration_marks(tree, display_path, lines))
        or audit(text, display_path, shared).faults
    )


def execute(text: str, file: str, mathematics: Any, shared: Sequence[Shared] = ()) -> dict[str, Any]:
    """Execute a component file and the shared files that it imports from.

    Args:
        text: The text of the component.
        file: Its name in messages.
        mathematics: The object that replaces `math`.
        shared: The shared files.

    Returns:
        The namespace of the component file.
    """
    spaces = {other.name: execute(other.text, other.display_path, mathematics) for other in shared}
    namespace: dict[str, Any] = {"__name__": "component", "__builtins__": builtins_with(spaces)}
    try:
        exec(compile(text, file, "exec"), namespace)
    except Exception as error:
        raise InvalidComponent(
            Fault(f"Python raises {type(error).__name__}: {error}; correct this line.", _mark_of(error, text, file))
        ) from error
    for name, value in list(namespace.items()):
        if value is math:
            namespace[name] = mathematics
    return namespace


def component_class(namespace: dict[str, Any]) -> type[Component]:
    """The component class in the namespace of a file."""
    found = [
        value
        for value in namespace.values()
        if isinstance(value, type) and issubclass(value, Component) and value is not Component
    ]
    (cls,) = found
    return cls


def function_of(cls: type[Component], name: str) -> Callable[..., Any]:
    """A function of a component, without its class."""
    function: Callable[..., Any] = vars(cls)[name].__func__
    return function


def raised(component: Primitive, function: str, address: str, error: Exception) -> Fault:
    """The fault for an exception that a component's function raised, at the line where it did.

    Args:
        component: The component.
        function: The name of the function.
        address: The address of the part.
        error: The exception.
    """
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    hint = "" if reason.endswith("?") else "; correct this line."
    if isinstance(error, AttributeError) and error.name and error.obj is not None:
        hint = f". {did_you_mean(error.name, [name for name in dir(error.obj) if not name.startswith('_')])}"
    return Fault(f"{function} raised {reason}{hint}", _mark_of(error, component.text, component.display_path), address)


def _mark_of(error: Exception, text: str, file: str) -> Mark:
    trace = error.__traceback__
    line = 0
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == file:
            line = trace.tb_lineno
        trace = trace.tb_next
    lines = text.splitlines()
    text = lines[line - 1] if 0 < line <= len(lines) else ""
    return Mark(file, line, len(text) - len(text.lstrip()) + 1 if text else 0, text)


def _part_faults(cls: type[Component], marks: Mapping[str, Mark]) -> list[Fault]:
    """Faults of reserved names, and of connections with inner parts that name unknown ports."""
    inputs = [name for name, d in cls.declarations.items() if isinstance(d, Input)]
    outputs = [name for name, d in cls.declarations.items() if isinstance(d, Output)]
    parameters = {name: d for name, d in cls.declarations.items() if isinstance(d, Parameter)}
    rule = "is the name of a function of components; choose another word for this declaration."
    faults = [Fault(f"{name} {rule}", marks[name]) for name in cls.declarations if name in FUNCTIONS]
    for name, part in cls.declarations.items():
        if isinstance(part, Part | Link):
            wrong = [mine for mine, _ in part.reads if mine not in inputs]
            wrong += [mine for _, mine in part.sends if mine not in inputs + outputs]
            for word in wrong:
                hint = did_you_mean(word, inputs + outputs)
                faults.append(Fault(f"{name} is wired to {word}, which is not declared. {hint}", marks[name]))
        if isinstance(part, Part):
            for theirs, text in part.gives:
                try:
                    parse_expression(text, "*", {n: (0, p.unit) for n, p in parameters.items()})
                except BadExpression as error:
                    faults.append(Fault(f"{name} is given {theirs}: {error}", marks[name]))
    return faults
