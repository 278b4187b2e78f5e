"""The inputs that each output needs at the same instant, read from the text of output()."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping, Sequence

from gaitsim.component import Declaration, Input, Output
from gaitsim.components.checks.check import SIGNATURES, class_functions

Carried = frozenset[str]
_NONE: Carried = frozenset()


def output_dependencies(
    tree: ast.Module, declarations: Mapping[str, Declaration], shared: Sequence[ast.Module] = ()
) -> dict[str, Carried]:
    """Determine the inputs from which output() computes each output.

    An input counts if its value reaches the output through local variables, other outputs, helpers, or a condition that
    decides whether the output is assigned. States and parameters carry no inputs.

    Returns:
        The inputs of each output; too many rather than too few where the text does not decide.
    """
    outputs = [name for name, one in declarations.items() if isinstance(one, Output)]
    function = class_functions(tree).get("output")
    if function is None:
        return dict.fromkeys(outputs, _NONE)
    helpers = [node for file in (tree, *shared) for node in file.body if isinstance(node, ast.FunctionDef)]
    flow = _Flow(function, declarations, helpers)
    return {name: flow.known.get(f"y.{name}", _NONE) for name in outputs}


class _Flow:
    """The inputs that each name carries: the union over all of its assignments, repeated until nothing changes."""

    def __init__(
        self,
        function: ast.FunctionDef,
        declarations: Mapping[str, Declaration],
        helpers: list[ast.FunctionDef],
    ) -> None:
        given = [argument.arg for argument in function.args.args]
        self.letters = dict(zip(given, SIGNATURES["output"], strict=False))
        self.inputs = frozenset(n for n, one in declarations.items() if isinstance(one, Input))
        self.outputs = [n for n, one in declarations.items() if isinstance(one, Output)]
        self.helpers = {node.name for node in helpers}
        inner = [node for helper in helpers for node in ast.walk(helper)]
        self.helpers_raise = any(isinstance(node, ast.Raise | ast.Assert) for node in inner)
        self.indexed = {
            node.value.id
            for node in ast.walk(function)
            if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name)
        }
        self.known: dict[str, Carried] = {}
        before: dict[str, Carried] | None = None
        while self.known != before:
            before = dict(self.known)
            self.left = _NONE  # what decided an earlier return or raise
            self.turned = _NONE  # what decided a break or continue of the loops around
            self.block(function.body, _NONE)

    def read(self, *nodes: ast.AST | None) -> Carried:
        """The inputs that expressions read; u as a whole stands for every input."""
        found: set[str] = set()
        for node in nodes:
            if node is None:
                continue
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                letter = self.letters.get(node.value.id)
                if letter == "u":
                    found |= {node.attr} & self.inputs
                    continue
                if letter == "y":
                    found |= self.known.get(f"y.{node.attr}", _NONE)
                    continue
            if isinstance(node, ast.Name):
                letter = self.letters.get(node.id)
                if letter == "u":
                    found |= self.inputs
                elif letter == "y":
                    found |= self.union(f"y.{name}" for name in self.outputs)
                found |= self.known.get(node.id, _NONE)
            found |= self.read(*ast.iter_child_nodes(node))
        return frozenset(found)

    def union(self, names: Iterable[str]) -> Carried:
        return _NONE.union(*(self.known.get(name, _NONE) for name in names))

    def write(self, target: ast.AST, carried: Carried) -> None:
        """Add inputs to an assignment target: a name, y.name, an element, or several of them."""
        if isinstance(target, ast.Tuple | ast.List):
            for element in target.elts:
                self.write(element, carried)
        elif isinstance(target, ast.Starred):
            self.write(target.value, carried)
        elif isinstance(target, ast.Subscript):
            self.write(target.value, carried | self.read(target.slice))
        elif isinstance(target, ast.Attribute):
            # Any name before the dot may be an alias of y.
            self.grow(f"y.{target.attr}", carried)
        elif isinstance(target, ast.Name):
            self.grow(target.id, carried)

    def grow(self, name: str, carried: Carried) -> None:
        self.known[name] = self.known.get(name, _NONE) | carried

    def block(self, statements: list[ast.stmt], control: Carried) -> None:
        for statement in statements:
            self.statement(statement, control | self.left | self.turned)

    def statement(self, node: ast.stmt, control: Carried) -> None:
        for expression in ast.iter_child_nodes(node):
            if isinstance(expression, ast.expr):
                self.inside(expression, control)
        match node:
            case ast.Assign():
                for target in node.targets:
                    self.assign(target, node.value, control)
            case ast.AnnAssign() if node.value is not None:
                self.assign(node.target, node.value, control)
            case ast.AugAssign():
                self.write(node.target, control | self.read(node.value))
            case ast.If():
                self.branch(control | self.read(node.test), node.body, node.orelse)
            case ast.While():
                self.loop(node, control | self.read(node.test))
            case ast.For():
                carried = control | self.read(node.iter)
                self.write(node.target, carried)
                self.loop(node, carried)
            case ast.Return() | ast.Raise() | ast.Assert():
                test = node.test if isinstance(node, ast.Assert) else None
                self.left |= control | self.read(test)
            case ast.Break() | ast.Continue():
                self.turned |= control
            case ast.FunctionDef():
                self.grow(node.name, control | self.read(*node.body))
                left = self.left
                self.block(node.body, control)
                self.left = left
            case ast.Try() | ast.With() | ast.Match():
                # No component needs these; they count as one condition over all that they contain.
                carried = control | self.read(node)
                for inner in ast.walk(node):
                    if isinstance(inner, ast.stmt) and inner is not node:
                        self.statement(inner, carried)
                    elif isinstance(getattr(inner, "ctx", None), ast.Store):
                        self.write(inner, carried)

    def assign(self, target: ast.expr, value: ast.expr, control: Carried) -> None:
        if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
            starred = any(isinstance(e, ast.Starred) for e in [*target.elts, *value.elts])
            if not starred and len(target.elts) == len(value.elts):
                for one, other in zip(target.elts, value.elts, strict=True):
                    self.assign(one, other, control)
                return
        self.write(target, control | self.read(value))
        names = [node.id for node in (target, value) if isinstance(node, ast.Name)]
        if len(names) == 2 and self.indexed & set(names):  # two names of one list
            self.grow(names[1], self.known[names[0]])

    def branch(self, control: Carried, *blocks: list[ast.stmt]) -> None:
        for statements in blocks:
            self.block(statements, control)

    def loop(self, node: ast.For | ast.While, control: Carried) -> None:
        outer = self.turned
        # Twice, because an exit at the end of the body decides about its next iteration.
        self.block(node.body, control)
        self.block(node.body, control)
        self.block(node.orelse, control)
        self.turned = outer

    def inside(self, expression: ast.expr, control: Carried) -> None:
        """Writes within an expression: assignment expressions, comprehensions, and helpers that may set y."""
        for node in ast.walk(expression):
            if isinstance(node, ast.NamedExpr):
                self.write(node.target, control | self.read(expression))
            elif isinstance(node, ast.comprehension):
                self.write(node.target, control | self.read(node.iter))
            elif isinstance(node, ast.Call):
                carried = control | self.read(expression)
                is_helper = isinstance(node.func, ast.Name) and node.func.id in self.helpers
                if not is_helper:
                    continue
                if self.helpers_raise:
                    self.left |= carried
                for argument in [*node.args, *(k.value for k in node.keywords)]:
                    name = argument.id if isinstance(argument, ast.Name) else ""
                    if self.letters.get(name) == "y":
                        for output in self.outputs:
                            self.grow(f"y.{output}", carried)
                    elif name in self.indexed:
                        self.grow(name, carried)
