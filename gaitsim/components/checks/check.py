"""Checks of a component file against its own declarations, before numba or a run uses it."""

from __future__ import annotations

import ast
import builtins
import copy
import math
from collections.abc import Iterator, Mapping, Sequence

from gaitsim.component import (
    Curve,
    Declaration,
    Frame,
    Input,
    Metric,
    Option,
    Output,
    Parameter,
    Points,
    Refused,
    Series,
    State,
)
from gaitsim.components.checks.build import build_faults, placed
from gaitsim.components.checks.curve import curve_faults
from gaitsim.components.checks.declaration import field_faults, like_faults
from gaitsim.components.checks.foreign import FORBIDDEN, foreign
from gaitsim.components.checks.shared import imports_shared, used_functions
from gaitsim.components.checks.start_range import range_faults
from gaitsim.errors import Fault, Faults, InvalidComponent, Mark, did_you_mean, nearest

SIGNATURES: Mapping[str, tuple[str, ...]] = {
    "start": ("p", "u", "x"),
    "output": ("p", "u", "x", "y"),
    "update": ("p", "u", "x", "y", "dt"),
    "reset": ("p", "u", "x", "y", "t"),
    "finish": ("p", "x", "m"),
    "build": ("p", "mj"),
}
GUARD = "guard"  # the output whose rise through 0 is an event
_LETTERS = {"p": Parameter, "u": Input, "x": State, "y": Output, "m": Metric}
_SAID = {Parameter: "a parameter", Input: "an input", State: "a state", Output: "an output"}
_SAID |= {Metric: "a metric", Points: "a list of points", Option: "an option", Series: "a series"}
_READ_ONLY = {"p": "parameters are read only.", "u": "inputs are read only."}
_WRITERS = {"x": ("start", "update", "reset"), "y": ("output",), "m": ("finish",)}
# numba compiles these; breakpoint is for plain Python only.
_BUILTINS = {"abs", "min", "max", "range", "int", "float", "len", "bool", "round", "print"}
_BUILTINS |= {"breakpoint", "ValueError", "ArithmeticError", "OverflowError", "RuntimeError"}


def place(file: str, lines: Sequence[str], line: int, offset: int) -> Mark:
    """The mark of a line and a byte offset, as the Python compiler counts them."""
    text = lines[line - 1] if 0 < line <= len(lines) else ""
    return Mark(file, line, len(text.encode()[:offset].decode(errors="ignore")) + 1, text)


def class_body(tree: ast.Module) -> list[ast.stmt]:
    """The statements in the class of a component file; none for a shared file, which has no class."""
    return next((node.body for node in tree.body if isinstance(node, ast.ClassDef)), [])


def declaration_marks(tree: ast.Module, file: str, lines: Sequence[str]) -> dict[str, Mark]:
    """The place of each declaration of the class; the place of the class itself under the empty name."""
    found: dict[str, Mark] = {}
    for node in class_body(tree):
        if isinstance(node, ast.Assign | ast.AnnAssign):
            mark = place(file, lines, node.lineno, node.col_offset)
            found |= dict.fromkeys(_bound(node), mark)
    top = next(node for node in tree.body if isinstance(node, ast.ClassDef))
    return {"": place(file, lines, top.lineno, top.col_offset), **found}


def class_functions(tree: ast.Module) -> dict[str, ast.FunctionDef]:
    """The functions of the component's class, by name."""
    return {node.name: node for node in class_body(tree) if isinstance(node, ast.FunctionDef)}


def parse(text: str, file: str) -> ast.Module:
    """Parse a component file.

    Args:
        text: The text of the file.
        file: Its name in messages.

    Raises:
        InvalidComponent: It is not Python, or holds something that component files must not hold.
    """
    lines, faults = text.split("\n"), Faults()
    tree = _python(text, file)
    classes = 0
    for node in tree.body:
        mark = place(file, lines, node.lineno, node.col_offset)
        if isinstance(node, ast.ClassDef):
            derives = any(isinstance(b, ast.Name) and b.id == "Component" for b in node.bases)
            classes += derives
            if not derives:
                faults.add(f"{node.name} does not derive from Component.", mark)
            elif classes > 1:
                faults.add(f"{node.name} is a second component; give it a file of its own.", mark)
        elif not isinstance(node, ast.Import | ast.ImportFrom | ast.Assign | ast.AnnAssign | ast.FunctionDef) and not (
            isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        ):
            faults.add("a component file holds imports, constants, functions and one class.", mark)
    if not classes:
        faults.add(
            "a component file holds one class that derives from Component; this has none.",
            Mark(file),
        )
    for message, wrong in foreign(tree):
        faults.add(message, place(file, lines, getattr(wrong, "lineno", 1), getattr(wrong, "col_offset", 0)))
    faults.raise_if_any(InvalidComponent)
    return tree


def parse_shared(text: str, file: str) -> ast.Module:
    """Parse a file that components of a kind import from; the arguments are those of `parse`.

    Raises:
        InvalidComponent: It is not Python, or holds something that shared files must not hold.
    """
    lines, faults = text.split("\n"), Faults()
    tree = _python(text, file)
    for node in tree.body:
        is_text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        allowed = isinstance(node, ast.Import | ast.ImportFrom | ast.Assign | ast.AnnAssign | ast.FunctionDef)
        if imports_shared(node):
            rule = "a shared file imports no other; define the names here, or import both files in the component."
            faults.add(rule, place(file, lines, node.lineno, node.col_offset))
        elif not (is_text or allowed):
            rule = "a shared file holds imports, constants, declarations and functions."
            faults.add(rule, place(file, lines, node.lineno, node.col_offset))
    for message, wrong in foreign(tree):
        faults.add(message, place(file, lines, getattr(wrong, "lineno", 1), getattr(wrong, "col_offset", 0)))
    faults.raise_if_any(InvalidComponent)
    return tree


def _python(text: str, file: str) -> ast.Module:
    """Parse a Python text.

    Raises:
        InvalidComponent: A component file breaks the contract.
    """
    lines = text.split("\n")
    try:
        return ast.parse(text, file)
    except (SyntaxError, ValueError) as error:
        line, column = getattr(error, "lineno", 0) or 0, getattr(error, "offset", 0) or 0
        text = lines[line - 1] if 0 < line <= len(lines) else ""
        reason = getattr(error, "msg", str(error))
        mark = Mark(file, line, max(column, 1) if line else 0, text)
        raise InvalidComponent(Fault(f"this is not Python: {reason}.", mark)) from None


def check_names(
    tree: ast.Module,
    declarations: Mapping[str, Declaration],
    file: str,
    lines: Sequence[str],
    shared: Sequence[ast.Module] = (),
) -> list[Fault]:
    """Find all faults of names, signatures, assignments and declarations in a parsed file.

    Args:
        tree: The syntax tree of the component file.
        declarations: Its declarations by name.
        file: Its name in messages.
        lines: Its lines.
        shared: The syntax trees of the files that it imports from.
    """
    check = _Check(tree, declarations, file, lines, used_functions(tree, shared))
    check.declared()
    for name, function in check.functions.items():
        if not check.signature(name, function):
            continue  # its names are checked once its arguments are correct
        check.attributes(name, function)
        check.names(function, plain=name == "build")
        for message, wrong in build_faults(function, declarations) if name == "build" else ():
            check.add(message, wrong)
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            check.names(node, plain=False)
    check.guarded()
    check.never_assigned()
    return sorted(check.faults.found, key=lambda f: (f.mark.line, f.mark.column) if f.mark else ())


class _Check:
    def __init__(
        self,
        tree: ast.Module,
        known: Mapping[str, Declaration],
        file: str,
        lines: Sequence[str],
        helpers: Mapping[str, ast.FunctionDef],
    ) -> None:
        self.known, self.file, self.lines, self.faults = known, file, lines, Faults()
        self.functions = class_functions(tree)
        self.helpers = helpers
        plain = ast.Import | ast.Assign | ast.AnnAssign
        constants = [n for n in tree.body if isinstance(n, plain) or imports_shared(n)]
        self.globals = {name for node in constants for name in _bound(node)}
        self.globals |= {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
        self.places: dict[str, ast.AST] = {}
        for node in class_body(tree):
            if isinstance(node, ast.Assign | ast.AnnAssign):
                self.places |= dict.fromkeys(_bound(node), node)

    def add(self, message: str, node: ast.AST | None) -> None:
        line, offset = getattr(node, "lineno", 0), getattr(node, "col_offset", 0)
        self.faults.add(message, place(self.file, self.lines, line, offset) if line else None)

    def declared(self) -> None:
        for name, one in self.known.items():
            faults = list(field_faults(name, one))
            if isinstance(one, Curve) and not faults:
                faults = list(curve_faults(name, one, self.known, self.helpers))
            elif isinstance(one, Input | Output | State) and not faults:
                faults = list(range_faults(name, one, self.known))
            if isinstance(one, Metric | Input | Output) and one.like:
                faults += like_faults(name, one, self.known)
            for message in faults:
                self.add(message, self.places.get(name))

    def signature(self, name: str, function: ast.FunctionDef) -> bool:
        """Check the name and the arguments of a function.

        Returns:
            Whether both are correct.
        """
        if name not in SIGNATURES:
            hint = did_you_mean(name, SIGNATURES)
            self.add(f"{name} is not a function of a component. {hint}", function)
            return False
        if [ast.unparse(d) for d in function.decorator_list] != ["staticmethod"]:
            self.add(f"{name} needs @staticmethod above it, and nothing else.", function)
        wanted = f"({', '.join(SIGNATURES[name])})"
        given = f"({ast.unparse(_without_annotations(function.args))})"
        if given != wanted:
            self.add(f"{name} takes {wanted}; here it has {given}.", function)
        return given == wanted

    def attributes(self, name: str, function: ast.FunctionDef) -> None:
        letters = set(SIGNATURES[name]) & set(_LETTERS) & {a.arg for a in function.args.args}
        written = {id(node) for node in _written(function)}
        whole = {id(node) for node in self.whole(function)}
        for node in ast.walk(function):
            if isinstance(node, ast.Name) and node.id in letters:
                if not isinstance(node.ctx, ast.Load):
                    self.add(f"{node.id} is an argument; choose another name.", node)
                elif id(node) not in whole:
                    hint = f"write {node.id}.name, or pass {node.id} to a function of this file."
                    self.add(f"{node.id} is used as a whole; {hint}", node)
            elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                letter = node.value.id
                if letter not in letters or self.undeclared(letter, name, node):
                    continue
                if id(node) in written and name not in _WRITERS.get(letter, ()):
                    rule = _READ_ONLY.get(letter) or (
                        f"{_SAID[_LETTERS[letter]].split()[1]}s are set in {_listed(_WRITERS[letter])} only."
                    )
                    self.add(f"{letter}.{node.attr} is assigned in {name}; {rule}", node)

    def whole(self, function: ast.FunctionDef) -> Iterator[ast.expr]:
        """The places where p, u, x, y or m may stand as a whole: before a dot, and as an argument of a helper."""
        for node in ast.walk(function):
            if isinstance(node, ast.Attribute):
                yield node.value
            elif isinstance(node, ast.Call) and ast.unparse(node.func) in self.globals:
                yield from node.args

    def undeclared(self, letter: str, function: str, node: ast.Attribute) -> bool:
        one, text = self.known.get(node.attr), f"{letter}.{node.attr}"
        kinds = (Parameter, Points, Series, Option) if letter == "p" else (_LETTERS[letter],)
        if one is None:
            names = [name for name, other in self.known.items() if isinstance(other, kinds)]
            hint = _hint(node.attr, names, letter)
            self.add(f"{text} is not declared. {hint}", node)
        elif not isinstance(one, kinds):
            home = next((at for at, kind in _LETTERS.items() if isinstance(one, kind)), "")
            declaration = _SAID.get(type(one), f"declared as {type(one).__name__}")
            hint = f"; write {home}.{node.attr}." if home else "."
            self.add(f"{text} is not {_SAID[_LETTERS[letter]]}: {node.attr} is {declaration}{hint}", node)
        elif isinstance(one, Points | Option) and function != "build":
            self.add(f"{text} is {_SAID[type(one)]}; it is known in build only.", node)
        else:
            return False
        return True

    def names(self, function: ast.FunctionDef, plain: bool) -> None:
        own = (set(_bound(function)) - {function.name}) | self.globals
        allowed = ({*dir(builtins), Refused.__name__} if plain else _BUILTINS) | own
        body = [node for statement in function.body for node in ast.walk(statement)]
        for node in body:
            if isinstance(node, ast.Name) and node.id not in allowed | FORBIDDEN:
                hint = self.meant(node.id) or did_you_mean(node.id, allowed)
                if not hint.startswith("Did you mean "):
                    hint = did_you_mean(node.id, own)
                self.add(f"{node.id} is not defined. {hint}", node)
            elif isinstance(node, ast.Attribute) and ast.unparse(node.value) == "math":
                known = [name for name in dir(math) if not name.startswith("_")]
                if node.attr not in known:
                    hint = _hint(node.attr, known, "math")
                    self.add(f"math.{node.attr} is not defined. {hint}", node)

    def meant(self, word: str) -> str:
        """A hint for a declared name that was written without its letter."""
        one = self.known.get(word)
        letter = next((at for at, kind in _LETTERS.items() if isinstance(one, kind)), "")
        return f"Did you mean {letter}.{word}?" if letter else ""

    def guarded(self) -> None:
        """Check that a component with a function `reset` declares the output whose rise through 0 is the event."""
        if "reset" in self.functions and not isinstance(self.known.get(GUARD), Output):
            rule = f"reset needs an output {GUARD}, whose rise through 0 is the event; declare {GUARD} = Output(...)."
            self.add(rule, self.functions["reset"])

    def never_assigned(self) -> None:
        for kind, letter, name in ((Output, "y", "output"), (Metric, "m", "finish")):
            function = self.functions.get(name)
            names = {n for n, one in self.known.items() if isinstance(one, kind)}
            if kind is Output and "build" in self.functions:
                read = placed(self.functions["build"], Output, self.known)
                names -= names if read is None else read
            if not names:
                continue
            if function is not None:
                if _passed_whole(function, letter):
                    continue
                written = {node.attr for node in _written(function)}
                # A misspelt output was reported already; it is the one that is missing.
                names -= written | {near for word in written - set(self.known) if (near := nearest(word, names))}
            for missing in sorted(names):
                also = ", and build never reads it" if kind is Output and "build" in self.functions else ""
                self.add(f"{name} never assigns {letter}.{missing}{also}.", self.places.get(missing))
        if "build" in self.functions:
            made = placed(self.functions["build"], Frame, self.known)
            frames = {n for n, one in self.known.items() if isinstance(one, Frame)}
            for missing in sorted(frames - (frames if made is None else made)):
                rule = f'build never places {missing}; write mj.frame("{missing}", (x, y, z)).'
                self.add(rule, self.places.get(missing))


def _listed(names: Sequence[str]) -> str:
    """Words as a list in a sentence: start, update and reset."""
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def _hint(word: str, names: list[str], prefix: str) -> str:
    # All have the same prefix, so only the names are compared.
    near = did_you_mean(word, names)
    if near.startswith("Did you mean "):
        return near.replace("Did you mean ", f"Did you mean {prefix}.")
    return did_you_mean("", [f"{prefix}.{name}" for name in names])


def _bound(node: ast.AST) -> Iterator[str]:
    """The names that a statement binds: by assignment, import, definition or as arguments."""
    for inner in ast.walk(node):
        if isinstance(inner, ast.Name) and not isinstance(inner.ctx, ast.Load):
            yield inner.id
        elif isinstance(inner, ast.FunctionDef):
            yield inner.name
        elif isinstance(inner, ast.arg):
            yield inner.arg
        elif isinstance(inner, ast.alias):
            yield inner.asname or inner.name


def _written(function: ast.FunctionDef) -> Iterator[ast.Attribute]:
    """Each attribute that a function assigns, also by an index as in x.samples[i] = 0."""
    for node in ast.walk(function):
        if isinstance(node, ast.Attribute | ast.Subscript) and not isinstance(node.ctx, ast.Load):
            inner: ast.expr = node
            while isinstance(inner, ast.Subscript):
                inner = inner.value
            if isinstance(inner, ast.Attribute):
                yield inner


def _without_annotations(arguments: ast.arguments) -> ast.arguments:
    bare = copy.deepcopy(arguments)
    for node in ast.walk(bare):
        if isinstance(node, ast.arg):
            node.annotation = None
    return bare


def _passed_whole(function: ast.FunctionDef, letter: str) -> bool:
    calls = [node for node in ast.walk(function) if isinstance(node, ast.Call)]
    return any(isinstance(a, ast.Name) and a.id == letter for call in calls for a in call.args)
