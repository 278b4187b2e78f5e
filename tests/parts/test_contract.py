"""Every component file of the library keeps the contract; a new file is tested once it is saved."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from gaitsim.compiler.kernel import address_of
from gaitsim.component import Input, Metric, Output, Parameter, State
from gaitsim.parts.audit import audit
from gaitsim.parts.bibliography import entries, keys_of
from gaitsim.parts.composite import Composite
from gaitsim.parts.contract import kind_faults
from gaitsim.parts.find import Library
from gaitsim.parts.primitive import Primitive
from gaitsim.parts.review import review
from gaitsim.simulation.curves import graphs, why_no_curves

from .calls import FILES, FOLDER, component, reference_of, stages

_DOCUMENTED = Parameter | Input | Output | State | Metric
_ENTRIES = entries((FOLDER / "references.bib").read_text(encoding="utf-8"))

every_file = pytest.mark.parametrize("path", FILES, ids=reference_of)


def parameters_of(found: Primitive | Composite) -> dict[str, tuple[str, bool]]:
    """The source of each parameter, and whether it has a default."""
    if isinstance(found, Primitive):
        return {n: (p.source, p.default is not None) for n, p in found.parameters.items()}
    return {n: (p.source, n in found.defaults) for n, p in found.parameters.items()}


def test_the_library_is_found() -> None:
    assert {"muscle/geyer2003", "segment/rod", "measure/apex"} <= {reference_of(f) for f in FILES}
    assert {"geyer2003", "geyer2010"} <= set(_ENTRIES)


@pytest.mark.parametrize("key", sorted(_ENTRIES))
def test_an_entry_of_the_bibliography_is_whole(key: str) -> None:
    text = (FOLDER / "references.bib").read_text(encoding="utf-8")
    assert len(re.findall(rf"^@\w+\{{{key},", text, re.MULTILINE)) == 1, "it stands there twice"
    fields = set(re.findall(r"^\s*(\w+)\s*=", _ENTRIES[key], re.MULTILINE))
    assert {"author", "title", "year"} <= fields
    assert _ENTRIES[key].endswith("\n}") and _ENTRIES[key].count("{") == _ENTRIES[key].count("}")


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
    keys = {key for source, _ in sources.values() for key in keys_of(source)}
    assert keys - set(_ENTRIES) == set()


@every_file
def test_every_number_has_bounds_and_its_default_is_within(path: Path) -> None:
    found = component(reference_of(path))
    for name, one in found.parameters.items():
        low, high = one.bounds or ((-math.inf, math.inf) if one.unit == "*" else (math.nan, math.nan))
        assert low < high, f"{name} has no bounds"
        assert one.default is None or low <= one.default <= high, name


@every_file
def test_a_review_finds_nothing(path: Path) -> None:
    assert [str(fault) for fault in review(reference_of(path), Library((FOLDER,)))] == []


@every_file
def test_it_draws_its_curves_or_says_why_it_has_none(path: Path) -> None:
    found = component(reference_of(path))
    drawn = graphs(found)
    if not drawn:
        assert not getattr(found, "curves", None)
        assert why_no_curves(found)
        return
    for graph in drawn:
        assert graph.doc.strip()
        for line in graph.lines:
            assert np.isfinite(line.y).mean() > 0.5, f"{graph.name}: half of it is no number"
    # A flat line tells nothing: some graph must have shape.
    assert any(np.ptp(line.y[np.isfinite(line.y)]) > 0 for graph in drawn for line in graph.lines)


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
