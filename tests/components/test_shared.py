"""What the components of a kind share: read with each of them, checked like them, and copied along."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from gaitsim.components.checks.shared import definitions, imported_names
from gaitsim.components.find import Library
from gaitsim.components.primitive import Primitive
from gaitsim.distribution import shipped_folder
from gaitsim.errors import GaitsimError
from gaitsim.results.bundle import Bundle, bundled, read_bundle
from gaitsim.results.trust import Untrusted, check_trust
from gaitsim.simulation.trial import Trial
from gaitsim.text.document import parse

SHARED = '''"""What springs share."""

import math

from gaitsim.component import Input, Parameter

LENGTH = Input("m", "Length of the spring.")
STIFFNESS = Parameter("N/m", "k.", default=100, bounds=(1, 1e6), source="definition: of this test")
LEAST = 0.0


def above(value, least):
    """The value, but not below the least."""
    return max(least, value)


def pull(stiffness, length):
    """A force that never pushes, and nan out of the root's domain."""
    return stiffness * above(length, LEAST) * math.sqrt(1.0)
'''
SPRING = """from gaitsim.component import Component, Output

from ._springs import LENGTH, STIFFNESS, pull


class Spring(Component):
    \"\"\"A spring that pulls.\"\"\"

    length = LENGTH
    stiffness = STIFFNESS
    force = Output("N", "Force.")

    @staticmethod
    def output(p, u, x, y):
        y.force = pull(p.stiffness, u.length)
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A library of one kind: a spring, and what springs share."""
    kind = tmp_path / "spring"
    kind.mkdir()
    (kind / "_springs.py").write_text(SHARED)
    (kind / "plain.py").write_text(SPRING)
    (kind / "kind.yaml").write_text("about: A spring.\n")
    return tmp_path


def found(folder: Path) -> Primitive:
    component = Library((folder,)).find("spring/plain")
    assert isinstance(component, Primitive)
    return component


def refused(folder: Path) -> str:
    with pytest.raises(GaitsimError) as caught:
        found(folder)
    return str(caught.value).replace(f"{folder}/", "")


def swap(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))


@pytest.mark.parametrize("mode", ["normal", "rapid"])
def test_declarations_and_functions_are_used_in_both_modes(folder: Path, mode: str) -> None:
    spring = found(folder)
    assert (list(spring.inputs), list(spring.parameters)) == (["length"], ["stiffness"])
    assert spring.dependencies == {"force": frozenset({"length"})}
    trial = Trial(spring).put({"stiffness": 3.0, "length": 2.0})
    assert not trial.call("output", mode)  # type: ignore[arg-type]
    assert trial.y.force == 6.0
    trial.put({"length": -2.0})
    assert not trial.call("output", mode)  # type: ignore[arg-type]
    assert trial.y.force == 0.0


def test_the_digest_counts_what_is_shared(folder: Path) -> None:
    before = found(folder)
    swap(folder / "spring" / "_springs.py", "sqrt(1.0)", "sqrt(4.0)")
    after = found(folder)
    assert before.text == after.text
    assert before.digest != after.digest
    trial = Trial(after).put({"stiffness": 3.0, "length": 2.0})
    assert not trial.call("output", "rapid")
    assert trial.y.force == 12.0, "no kernel of the text before is taken"


def test_a_shared_file_is_no_component(folder: Path) -> None:
    assert Library((folder,)).references() == ["spring/plain"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "STIFFNESS, pull",
            "STIFFNESS, pulls",
            "spring/plain.py:3:1: _springs.py defines no pulls. Did you mean pull?",
        ),
        (
            "._springs",
            "._spring",
            "spring/plain.py:3:1: this kind has no file _spring.py; write it in the folder of this kind.",
        ),
    ],
)
def test_what_is_not_there_cannot_be_imported(folder: Path, old: str, new: str, said: str) -> None:
    swap(folder / "spring" / "plain.py", old, new)
    assert refused(folder).splitlines()[0] == said


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("* above", "+ above", "spring/_springs.py:19:12: adds a stiffness to a length."),
        ("max(least", "maximum(least", "spring/_springs.py:14:12: maximum is not defined. Did you mean max?"),
        ("LEAST = 0.0", "LEAST = open", "spring/_springs.py:9:9: open may not be used in a component file."),
        (
            "LEAST = 0.0",
            "class Other:\n    pass",
            "spring/_springs.py:9:1: a shared file holds imports, constants, declarations and functions.",
        ),
        (
            "import math",
            "from ._others import LEAST",
            "spring/_springs.py:3:1: a shared file imports no other; "
            "define the names here, or import both files in the component.",
        ),
    ],
)
def test_a_fault_is_told_where_it_stands_in_the_shared_file(folder: Path, old: str, new: str, said: str) -> None:
    swap(folder / "spring" / "_springs.py", old, new)
    assert said in refused(folder).splitlines()


class NothingDropped:
    """All that a bundle asks of a model."""

    dropped: frozenset[str] = frozenset()


def test_a_result_has_its_own_copy_and_asks_for_trust_in_it(folder: Path, tmp_path: Path) -> None:
    library = Library((folder,))
    library.find("spring/plain")
    document = parse("simulate: {}\n", "spec.yaml")
    files = bundled(document, "spec", library, {}, [NothingDropped()]).files  # type: ignore[list-item]
    assert files["components/spring/_springs.py"] == SHARED
    result = tmp_path / "result"
    Bundle("spec", files).write(result)
    swap(folder / "spring" / "_springs.py", "sqrt(1.0)", "sqrt(4.0)")
    copy = read_bundle(result, "spec")
    again = copy.library().find("spring/plain")
    assert again.digest == library.find("spring/plain").digest
    with pytest.raises(Untrusted, match=r"components/spring/_springs\.py"):
        check_trust(copy, trusted=False)


def test_each_shared_name_of_the_library_is_used() -> None:
    shared = [path for path in shipped_folder().glob("*/_*.py") if path.name != "_skeleton.py"]
    assert shared
    for path in shared:
        importing = [p for p in path.parent.glob("*.py") if path.stem in imported_names(p.read_text(encoding="utf-8"))]
        assert len(importing) > 1, f"{path.stem} is imported by one file at most"
        tree = ast.parse(path.read_text(encoding="utf-8"))
        used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)}
        for other in importing:
            nodes = ast.walk(ast.parse(other.read_text(encoding="utf-8")))
            imports = (n for n in nodes if isinstance(n, ast.ImportFrom) and n.module == path.stem)
            used |= {alias.name for node in imports for alias in node.names}
        assert set(definitions(tree)) <= used, path
