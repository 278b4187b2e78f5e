"""Every component file of the library keeps the contract; a new file is tested once it is saved."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from gaitsim.compiler.kernel import address_of
from gaitsim.component import Input, Metric, Output, Parameter, State
from gaitsim.parts.audit import audit
from gaitsim.parts.composite import Composite
from gaitsim.parts.contract import kind_faults
from gaitsim.parts.primitive import Primitive

from .calls import FILES, FOLDER, component, reference_of, stages

_DOCUMENTED = Parameter | Input | Output | State | Metric
_KEYS = set(re.findall(r"^@\w+\{(\w+),", (FOLDER / "references.bib").read_text(), re.MULTILINE))
_KEY = re.compile(r"(?=[a-z_]*\d)[A-Za-z]\w*")

every_file = pytest.mark.parametrize("path", FILES, ids=reference_of)


def bibliography_keys(source: str) -> list[str]:
    """The words of a source's first clause that look like keys: letters, then digits."""
    return [word for word in re.findall(r"\w+", source.split(":")[0]) if _KEY.fullmatch(word)]


def parameters_of(found: Primitive | Composite) -> dict[str, tuple[str, bool]]:
    """The source of each parameter, and whether it has a default."""
    if isinstance(found, Primitive):
        return {n: (p.source, p.default is not None) for n, p in found.parameters.items()}
    return {n: (p.source, n in found.defaults) for n, p in found.parameters.items()}


def test_the_library_is_found() -> None:
    assert {"muscle/geyer2003", "segment/rod", "measure/apex"} <= {reference_of(f) for f in FILES}
    assert {"geyer2003", "geyer2010"} <= _KEYS


@every_file
def test_it_loads_under_its_own_name(path: Path) -> None:
    found = component(reference_of(path))
    assert found.path == path
    assert found.doc, "the component itself has no doc"
    assert (path.parent / "kind.yaml").is_file(), f"the kind {path.parent.name} has no kind.yaml"


@every_file
def test_everything_has_a_doc(path: Path) -> None:
    found = component(reference_of(path))
    if isinstance(found, Composite):
        bare = [name for name, declared in found.parameters.items() if not declared.doc.strip()]
    else:
        declarations = found.cls.declarations.items()
        bare = [n for n, d in declarations if isinstance(d, _DOCUMENTED) and not d.doc.strip()]
    assert bare == []


@every_file
def test_every_default_has_a_source(path: Path) -> None:
    sources = parameters_of(component(reference_of(path)))
    assert [name for name, (source, default) in sources.items() if default and not source] == []


@every_file
def test_every_source_that_is_a_key_is_in_the_bibliography(path: Path) -> None:
    sources = parameters_of(component(reference_of(path)))
    keys = {key for source, _ in sources.values() for key in bibliography_keys(source)}
    assert keys - _KEYS == set()


@every_file
def test_it_fits_its_kind(path: Path) -> None:
    found = component(reference_of(path))
    assert kind_faults(found, path.parent / "kind.yaml", str(path)) == []


@every_file
def test_its_units_hold_on_every_path(path: Path) -> None:
    if path.suffix != ".py":
        assert isinstance(component(reference_of(path)), Composite)
        return
    report = audit(path.read_text(encoding="utf-8"), str(path))
    assert [str(fault) for fault in report.faults] == []
    assert report.unreached == ()
    assert report.complete


@every_file
def test_it_compiles_to_native_code(path: Path) -> None:
    found = component(reference_of(path))
    if isinstance(found, Composite):
        assert found.parts.entries
        return
    address = address_of(found)
    assert address > 0
    assert address_of(found) == address
    # A part that acts or remembers must have something to call.
    if found.states:
        assert {"start", "update"} & set(stages(found))
