"""Templates for new components and their tests."""

from __future__ import annotations

import keyword
import re
from pathlib import Path

from gaitsim.components.composite import Composite
from gaitsim.components.contract import read_contract
from gaitsim.components.find import KIND, SKELETON, Library, display_path
from gaitsim.errors import Usage, did_you_mean, with_article
from gaitsim.text.document import parse, plain

_CLASS = re.compile(r"^class \w+\(", re.MULTILINE)
_TEST = '''"""{reference} on plain numbers, without a model around it."""

from pathlib import Path

import numpy as np
from gaitsim.components.find import Library
from gaitsim.distribution import shipped_folder
from gaitsim.components.review import review
from gaitsim.simulation.curves import graphs
from gaitsim.simulation.trial import Trial

LIBRARY = Library((Path(__file__).parents[1] / "components", shipped_folder()))
COMPONENT = LIBRARY.find("{reference}")


def trial() -> Trial:
    """The component with every number at 0.5. Replace these by the numbers of your paper, and test its results."""
    made = Trial(COMPONENT)
    for numbers in made.arrays:
        numbers[:] = 0.5
    return made


def test_it_keeps_the_contract() -> None:
    assert [str(fault) for fault in review("{reference}", LIBRARY)] == []


def test_native_code_and_python_agree() -> None:
    rapid, normal = trial(), trial()
    for stage in rapid.stages:
        assert not rapid.call(stage, "rapid") and not normal.call(stage, "normal"), stage
        for mine, theirs in zip(rapid.arrays, normal.arrays, strict=True):
            np.testing.assert_allclose(mine, theirs, rtol=1e-12, err_msg=stage)


def test_its_curves_are_numbers() -> None:
    for graph in graphs(COMPONENT):
        assert all(np.isfinite(line.y).any() for line in graph.lines), graph.name
'''


def new_component(kind: str, name: str, library: Library, like: str | None = None) -> tuple[str, str]:
    """Make a new component from another one, from the skeleton of its kind, or from the contract of its kind.

    Args:
        kind: The kind.
        name: The name of the new component.
        library: The components that exist.
        like: The name of the component to copy, if any.

    Returns:
        The name and the text of the file.

    Raises:
        Usage: The name cannot be used, or there is no such kind or component.
    """
    _check_name(kind, name, library)
    class_name = "".join(word.capitalize() for word in name.split("_"))
    if like is not None:
        other = library.find(like)
        if other.kind != kind:
            raise Usage(
                f"--like {like}: this is not {with_article(kind)}; choose one of {', '.join(library.references(kind))}."
            )
        if isinstance(other, Composite):
            return f"{name}.yaml", other.text
        return f"{name}.py", _CLASS.sub(f"class {class_name}(", other.text, count=1)
    skeleton = next((f / kind / SKELETON for f in library.folders if (f / kind / SKELETON).is_file()), None)
    if skeleton is not None:
        return f"{name}.py", _CLASS.sub(f"class {class_name}(", skeleton.read_text(encoding="utf-8"), count=1)
    contract = library.contract(kind)
    assert contract is not None
    return f"{name}.py", _from_contract(class_name, *contract)


def test_of(kind: str, name: str) -> str:
    """The text of a test for a new primitive, for a folder beside components/."""
    return _TEST.format(reference=f"{kind}/{name}")


def _check_name(kind: str, name: str, library: Library) -> None:
    if library.contract(kind) is None:
        move = f"for a kind of your own, write components/{kind}/{KIND} first"
        raise Usage(f"there is no kind {kind}. {did_you_mean(kind, library.kinds())} Or, {move}.")
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name) or keyword.iskeyword(name) or f"{name}.yaml" == KIND:
        raise Usage(f"{name} is not a name for a component; write small letters, digits and _, such as my_{kind}.")
    known = library.path(f"{kind}/{name}")
    if known is not None:
        raise Usage(f"{kind}/{name} exists already ({display_path(known)}); choose another name.")


def _from_contract(class_name: str, contract: Path, text: str) -> str:
    """A component that declares what its kind requires and computes nothing yet."""
    asked = read_contract(text, display_path(contract))
    about = str(plain(parse(text, display_path(contract))).get("about", "Write here what it computes."))
    lines = [
        *(f'    {n} = Parameter("{u}", "{_readable(n)}.", bounds=(0, 1e6))' for n, u in asked["parameters"].items()),
        *(f'    {n} = Input("{u}", "{_readable(n)}.")' for n, u in asked["inputs"].items()),
        *(f'    {n} = Output("{u}", "{_readable(n)}.")' for n, u in asked["outputs"].items()),
        *(f'    {n} = Metric("{u}", "{_readable(n)}.")' for n, u in asked["metrics"].items()),
    ]
    functions = []
    if asked["outputs"] or not lines:
        sets = [f"        y.{n} = 0.0" for n in asked["outputs"]] or ["        y.result = p.factor * u.signal"]
        functions += ["", "    @staticmethod", "    def output(p, u, x, y):", *sets]
    if asked["metrics"]:
        sets = [f"        m.{n} = 0.0" for n in asked["metrics"]]
        functions += ["", "    @staticmethod", "    def finish(p, x, m):", *sets]
    lines = lines or [
        '    factor = Parameter("1", "A factor.", default=1, bounds=(-10, 10), source="definition: unchanged")',
        '    signal = Input("1", "What comes in.")',
        '    result = Output("1", "What goes out.")',
    ]
    imports = sorted({"Component", *re.findall(r"= (\w+)\(", "\n".join(lines))})
    doc = f'    """{about.rstrip(".")}; replace it by your equations, and cite their paper."""'
    head = f"from gaitsim.component import {', '.join(imports)}"
    return "\n".join([head, "", "", f"class {class_name}(Component):", doc, "", *lines, *functions, ""])


def _readable(name: str) -> str:
    return name.replace("_", " ").capitalize()
